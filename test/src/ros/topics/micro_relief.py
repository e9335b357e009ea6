#!/usr/bin/env python3
"""~local_map of a fine resolution: ripples on its elevation, and nothing of them in the state."""
import math
import unittest

import rospy
import rostest
from desert_sim.msg import Plants
from desert_sim.srv import GetSubmap, GetSubmapRequest, Step
from desert_sim.testing import PATIENCE
from map_client import Listener, Trigger, cells

WAVELENGTH, HEIGHT = 0.293, 0.0467 * 0.293  # m, of a wind of 15 m/s


def service(node, name, kind):
    rospy.wait_for_service("/%s/%s" % (node, name), 60 * PATIENCE)
    return rospy.ServiceProxy("/%s/%s" % (node, name), kind)


def local_map(node):
    with Listener("/%s/local_map" % node) as listener:
        return listener.first("a local map of " + node)


def row_of(heights, y):
    return [z for (x, row), z in sorted(heights.items()) if row == y and x < 3]


class MicroRelief(unittest.TestCase):
    def setUp(self):
        for node in ("desert_sim", "desert_wide", "desert_plain"):
            self.assertTrue(service(node, "reset", Trigger)().success)

    def test_the_local_map_has_ripples(self):
        local = local_map("desert_sim")
        info = local.info
        self.assertEqual((info.resolution, info.length_x, info.length_y), (0.05, 10, 4))
        self.assertEqual((info.pose.position.x, info.pose.position.y), (0, 0))
        self.assertEqual(local.basic_layers, ["elevation"])
        heights, sand = cells(local, "elevation"), cells(local, "sand_depth")
        self.assertEqual(len(heights), 200 * 80)
        on_sand = [z for (x, _), z in heights.items() if x < 3]
        self.assertTrue(0.8 * HEIGHT < max(on_sand) - min(on_sand) <= 1.02 * HEIGHT)
        rows = [row_of(heights, round(0.05 * n + 0.025, 6)) for n in range(-40, 40)]
        crests = sum(a < 3 <= b for row in rows for a, b in zip(row, row[1:]))
        length = sum(len(row) for row in rows) * 0.05
        self.assertAlmostEqual(length / crests / WAVELENGTH, 1, delta=0.1)
        for (x, y), depth in sand.items():
            self.assertEqual(depth, 1 if x < 4 else 0, "the layer has no micro-relief")
            if x > 4.51:
                self.assertEqual(heights[x, y], 2, "rock has no ripples")

    def test_windows_agree_to_the_bit(self):
        narrow, wide = cells(local_map("desert_sim"), "elevation"), cells(local_map("desert_wide"), "elevation")
        self.assertEqual(len(wide), 280 * 160)
        for at, height in narrow.items():
            self.assertEqual(height, wide[at], at)

    def test_a_submap_with_a_resolution_is_the_local_map(self):
        request = GetSubmapRequest()
        request.length_x, request.length_y, request.resolution = 10, 4, 0.05
        request.layers = ["elevation", "sand_depth"]
        get_submap = service("desert_sim", "get_submap", GetSubmap)
        answer = get_submap(request)
        self.assertTrue(answer.success, answer.message)
        fine, local = answer.map, local_map("desert_sim")
        self.assertEqual((fine.width, fine.height, fine.cell_size), (200, 80, 0.05))
        self.assertEqual((fine.origin.position.x, fine.origin.position.y), (-5, -2))
        for layer in fine.layers:
            for (x, y), value in cells(local, layer.name).items():
                column, row = round((x + 5) / 0.05 - 0.5), round((y + 2) / 0.05 - 0.5)
                self.assertEqual(layer.data[row * 200 + column], value, (layer.name, x, y))
        for resolution, reason in ((2, "resolution: 2 m is neither 0 nor in [0.001, 1]"), (-1, "resolution: -1 m"),
                                   (1e-4, "resolution: 0.0001 m"), (float("nan"), "resolution: nan m"),
                                   (0.001, "region: 10000 x 4000")):
            request.resolution = resolution
            refused = get_submap(request)
            self.assertFalse(refused.success)
            self.assertIn(reason, refused.message)

    def test_without_a_resolution_the_map_has_the_terrains_cells(self):
        local = local_map("desert_plain")
        self.assertEqual(local.info.resolution, 1)
        for (x, _), height in cells(local, "elevation").items():
            self.assertEqual(height, 3 if x < 4 else 2)

    def test_heaps_are_at_the_plants_that_live(self):
        self.assertTrue(service("desert_bushes", "reset", Trigger)().success)
        self.assertTrue(service("desert_bushes", "step", Step)(3).success)
        with Listener("/desert_bushes/plants", Plants) as listener:
            m = listener.first("plants")
        plants = [(m.origin.position.x + x, m.origin.position.y + y) for x, y in zip(m.x, m.y)]
        self.assertGreater(len(plants), 5)
        heights = cells(local_map("desert_bushes"), "elevation")
        self.assertEqual(len(heights), 400 * 80)
        heaps = [at for at, height in heights.items() if height > 3 + 2 * HEIGHT]
        self.assertGreater(len(heaps), 200)
        for x, y in heaps:
            self.assertLess(min(math.hypot(x - a, y - b) for a, b in plants), 0.64)

    def test_the_state_has_none(self):
        local_map("desert_sim")
        steps = [service(node, "step", Step)(3) for node in ("desert_sim", "desert_plain")]
        self.assertTrue(steps[0].success and steps[1].success)
        self.assertEqual(steps[0].state_hash, steps[1].state_hash)
        request = GetSubmapRequest()
        request.length_x, request.length_y, request.layers = 20, 8, ["elevation", "sand_depth", "wind_x"]
        detailed, plain = (service(node, "get_submap", GetSubmap)(request).map.layers
                           for node in ("desert_sim", "desert_plain"))
        self.assertEqual(len(detailed), 3)
        for with_micro_relief, without in zip(detailed, plain):
            self.assertEqual(with_micro_relief.data, without.data, without.name)


if __name__ == "__main__":
    rospy.init_node("test_micro_relief")
    rostest.rosrun("desert_sim", "micro_relief", MicroRelief)
