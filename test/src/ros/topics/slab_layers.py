#!/usr/bin/env python3
"""The layers of plants and snow of the slab models: topics, submaps and grid maps of the shipped scenarios."""
import contextlib
import math
import unittest

import desert_sim
import rostest
from desert_sim.testing import PATIENCE, Desert
from map_client import Listener, cells

PLANTS, UNITS = ("grass", "mesquite", "shrub"), {"burial": "m", "snow_density": "kg/m^3"}
FRESH = 67.92 + 51.25 * math.exp(-20 / 2.59)  # kg/m^3, of snow that fell at -20 degC
SIDE = 32


class SlabLayers(unittest.TestCase):
    def desert(self, scenario, layers, *settings, **parameters):
        """A desert, and a client that is shown these layers of it."""
        desert = self.stack.enter_context(Desert(
            scenario, settings=["grid.width=%d" % SIDE, "grid.height=%d" % SIDE, *settings],
            parameters={"layer_thresholds": dict.fromkeys(layers, 0), **parameters}))
        self.middle = SIDE * desert.terrain.map.cell_size / 2
        self.client = desert_sim.TerrainClient(layers=layers)
        self.stack.callback(self.client.close)
        self.assertTrue(self.client.wait_for_terrain(60 * PATIENCE))
        return desert

    def setUp(self):
        self.stack = contextlib.ExitStack()
        self.addCleanup(self.stack.close)

    def values(self, desert, layer):
        """What the topic shows, which is what the service answers."""
        self.assertTrue(self.client.wait_for_step(desert.terrain.map.step, 60 * PATIENCE), layer)
        shown = self.client[layer]
        asked = desert.simulation.submap((self.middle, self.middle), (2 * self.middle, 2 * self.middle), [layer])[layer]
        self.assertEqual((shown.unit, asked.unit), (UNITS.get(layer, "1"),) * 2)
        self.assertTrue((shown.values == asked.values).all(), layer)
        return shown.values

    def test_plants_grow_by_burial(self):
        desert = self.desert("nield_nebkha", (*PLANTS, "burial", "snow_density"), "slab_plants.growth_time=20")
        desert.step(19)
        for layer in PLANTS:
            self.assertFalse(self.values(desert, layer).any(), layer + " has not grown yet")
        burial = self.values(desert, "burial")
        self.assertLess(burial.min(), -0.05)
        self.assertGreater(burial.max(), 0.05)
        self.assertLess(abs(burial.sum(dtype=float)), 1e-3, "what one cell has gained another has lost")
        desert.step(1)
        self.assertFalse(self.values(desert, "burial").any(), "plants have grown, and count anew")
        grown = {layer: self.values(desert, layer) for layer in PLANTS}
        self.assertTrue(any(values.any() for values in grown.values()))
        for layer, (lowest, highest) in zip(PLANTS, ((0, 1), (-1, 3), (-0.5, 1.5))):
            self.assertTrue((grown[layer] >= lowest).all() and (grown[layer] <= highest).all(), layer)
        self.assertFalse(self.values(desert, "snow_density").any(), "this terrain has no snow")

    def test_snow_settles(self):
        desert = self.desert("snow_barchan", ["snow_density"],
                             grid_map_layers=["snow_density", "elevation", "grass"], grid_map_rate=0)
        self.assertAlmostEqual(self.values(desert, "snow_density").mean(), FRESH, 2)
        desert.step(24)
        with Listener("/desert_sim/grid_map") as listener:
            grid_map = listener.first("a grid map")
        density = cells(grid_map, "snow_density").values()
        self.assertTrue(FRESH + 0.5 < min(density) <= max(density) < 250.7, (min(density), max(density)))
        self.assertEqual(set(cells(grid_map, "grass").values()), {0}, "this terrain has no plants")


if __name__ == "__main__":
    desert_sim.testing.init_ros("slab_layers_test")
    rostest.rosrun("desert_sim", "slab_layers", SlabLayers)
