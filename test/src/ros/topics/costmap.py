#!/usr/bin/env python3
"""~costmap, ~costmap_updates and ~image; and that nothing is copied for nobody."""
import time

import rospy
import rostest
from desert_sim.msg import SimulationStatus
from desert_sim.srv import EditTerrain, EditTerrainRequest, Step
from desert_sim.testing import PATIENCE
from dynamic_reconfigure.client import Client
from map_client import Listener, MapTest, Trigger, call
from map_msgs.msg import OccupancyGridUpdate
from nav_msgs.msg import OccupancyGrid
from sensor_msgs.msg import Image


class Costmap(MapTest):
    # ---- costmap

    def edit(self, x, y, value=3.0):
        request = EditTerrainRequest(layer="sand", shape="circle", merge="add", radius=5, inner=1, value=value)
        request.center.x, request.center.y = x, y
        answer = call("edit_terrain", EditTerrain, request)
        self.assertTrue(answer.success, answer.message)

    def keyframe(self):
        with Listener("/desert_sim/costmap", OccupancyGrid) as listener:
            return listener.first("a late joiner gets the whole map")

    @staticmethod
    def assemble(grid, updates):
        data = list(grid.data)
        for u in updates:
            assert u.x >= 0 and u.y >= 0 and u.width > 0 and u.height > 0
            assert u.x + u.width <= grid.info.width and u.y + u.height <= grid.info.height, "out of bounds"
            assert len(u.data) == u.width * u.height
            for y in range(u.height):
                at = (u.y + y) * grid.info.width + u.x
                data[at:at + u.width] = u.data[y * u.width:(y + 1) * u.width]
        return data

    def test_costmap_lies_right(self):
        grid = self.keyframe()
        self.expect_header(grid.header)
        self.assertEqual((grid.info.width, grid.info.height, grid.info.resolution), (64, 48, 2))
        self.assertEqual((grid.info.origin.position.x, grid.info.origin.position.y), (10, -20))
        self.assertEqual(grid.info.origin.orientation.w, 1)
        for x in range(64):
            for y in range(48):
                near = 55 <= x < 61 and 3 <= y < 8
                top = x in (57, 58) and y == 5  # flat, and all round it
                self.assertEqual(grid.data[y * 64 + x], 20 if top or not near else 100, (x, y))

    def test_costmap_updates_lead_from_one_keyframe_to_the_next(self):
        with Listener("/desert_sim/costmap", OccupancyGrid) as keyframes, \
                Listener("/desert_sim/costmap_updates", OccupancyGridUpdate) as updates:
            keyframes.first()
            time.sleep(0.7)
            base, skipped = keyframes.messages[-1], len(updates.messages)
            self.edit(40, 10)
            self.edit(120, 60)
            updates.wait_for(lambda u: u.x <= 14 and u.x + u.width >= 56, "one rectangle with both edits")
            self.expect_header(updates.messages[-1].header)
            call("resume", Trigger)
            time.sleep(2)
            call("pause", Trigger)
            time.sleep(0.5)
            got = updates.messages[skipped:]
            self.assertTrue(6 <= len(got) <= 16, "5 Hz: %d" % len(got))
            self.assertEqual(len(keyframes.messages), keyframes.messages.index(base) + 1, "no keyframe in between")
        self.assertEqual(self.assemble(base, got), list(self.keyframe().data))
        with Listener("/desert_sim/costmap", OccupancyGrid) as keyframes:
            keyframes.first()
            call("reset", Trigger)
            keyframes.wait_for(lambda k: k.header.stamp > got[-1].header.stamp and min(k.data) == 20,
                               "a replaced terrain begins with a keyframe")

    def test_an_update_repeats_what_a_client_may_not_have_looked_at(self):
        with Listener("/desert_sim/costmap", OccupancyGrid) as keyframes, \
                Listener("/desert_sim/costmap_updates", OccupancyGridUpdate) as updates:
            keyframes.first()
            time.sleep(1)
            self.edit(30, 0)
            rospy.ServiceProxy("/desert_sim/step", Step)(0)
            self.edit(110, 50)
            rospy.ServiceProxy("/desert_sim/step", Step)(0)
            last = updates.wait_for(lambda u: u.x + u.width > 50 and u.y + u.height > 34, "of the second edit")
            self.assertLessEqual(last.x, 12)
            self.assertLessEqual(last.y, 12)

    def test_a_second_subscriber_of_a_process_gets_the_map_too(self):
        with Listener("/desert_sim/costmap", OccupancyGrid) as first:
            first.first()
            with Listener("/desert_sim/costmap", OccupancyGrid) as second:  # by the same connection
                self.assertEqual(second.first("a map for the second").data, first.messages[-1].data)

    def test_soon_after_the_terrain_was_replaced_changes_come_as_whole_maps(self):
        with Listener("/desert_sim/costmap", OccupancyGrid) as keyframes, \
                Listener("/desert_sim/costmap_updates", OccupancyGridUpdate) as updates:
            keyframes.first()
            call("reset", Trigger)
            self.edit(40, 10)
            rospy.ServiceProxy("/desert_sim/step", Step)(0)
            keyframes.wait_for(lambda k: max(k.data[15 * 64:16 * 64]) == 100, "the edit, in row 15")
            self.assertEqual(updates.messages, [])
            time.sleep(0.7)
            self.edit(90, 10)
            updates.wait_for(lambda u: u.x <= 40 < u.x + u.width, "later as an update")

    def test_a_threshold_keeps_small_changes_back(self):
        node = Client("/desert_sim", timeout=60 * PATIENCE)
        node.update_configuration({"costmap_update_threshold": 5})
        self.addCleanup(node.update_configuration, {"costmap_update_threshold": 0})
        with Listener("/desert_sim/costmap", OccupancyGrid) as keyframes, \
                Listener("/desert_sim/costmap_updates", OccupancyGridUpdate) as updates:
            keyframes.first()
            time.sleep(0.7)
            base, skipped = keyframes.messages[-1], len(updates.messages)
            self.edit(40, 10)
            call("resume", Trigger)
            time.sleep(2)
            call("pause", Trigger)
            time.sleep(0.5)
            held = self.assemble(base, updates.messages[skipped:])
        now = list(self.keyframe().data)
        self.assertGreater(len(updates.messages), skipped)
        for a, b in zip(held, now):
            self.assertTrue(abs(a - b) <= 5 and (a == 100) == (b == 100), (a, b))

    def test_rectangles_in_turn_lead_from_one_keyframe_to_the_next(self):
        node = Client("/desert_sim", timeout=60 * PATIENCE)
        node.update_configuration({"costmap_update_rectangles": 4, "costmap_update_spacing": 0.2})
        self.addCleanup(node.update_configuration, {"costmap_update_rectangles": 1})
        with Listener("/desert_sim/costmap", OccupancyGrid) as keyframes, \
                Listener("/desert_sim/costmap_updates", OccupancyGridUpdate) as updates:
            keyframes.first()
            time.sleep(0.7)
            base, skipped = keyframes.messages[-1], len(updates.messages)
            self.edit(25, -5)
            self.edit(125, 65)
            call("resume", Trigger)
            time.sleep(2)
            call("pause", Trigger)
            time.sleep(1)
            got = updates.messages[skipped:]
            self.assertGreaterEqual(len(got), 4)
            self.assertEqual(len(keyframes.messages), keyframes.messages.index(base) + 1, "no keyframe in between")
        self.assertEqual(self.assemble(base, got), list(self.keyframe().data))

    # ---- image

    def test_image_has_the_marker_in_the_south_east(self):
        with Listener("/desert_sim/image", Image) as listener:
            image = listener.first()
        self.expect_header(image.header)
        self.assertEqual(image.encoding, "bgr8")
        self.assertEqual(image.step, 3 * image.width)
        self.assertEqual(len(image.data), image.step * image.height)
        self.assertAlmostEqual(image.width / image.height, 64 / 48, 6)
        scale = image.width // 64
        pixels = bytes(image.data)

        def contrast(x0, x1, y0, y1):
            """Of green over columns x0..x1 and rows y0..y1 of cells, row 0 in the south."""
            greens = [pixels[row * image.step + 3 * column + 1] for row in range((48 - y1) * scale, (48 - y0) * scale)
                      for column in range(x0 * scale, x1 * scale)]
            return max(greens) - min(greens)

        self.assertGreater(contrast(54, 62, 2, 9), 40)
        self.assertLess(contrast(40, 62, 30, 46), 10, "north-east")
        self.assertLess(contrast(2, 30, 30, 46), 10, "north-west")

    # ---- costs

    def test_nobody_listens_nothing_is_copied(self):
        call("resume", Trigger)
        with Listener("/desert_sim/status", SimulationStatus) as statuses:
            deadline = time.monotonic() + 15 * PATIENCE
            copied = None
            while copied != 0 and time.monotonic() < deadline:  # the subscribers of other tests go
                first = statuses.first()
                before, step = first.snapshots, first.step
                time.sleep(1)
                copied = statuses.messages[-1].snapshots - before
            self.assertEqual(copied, 0)
            self.assertGreater(statuses.messages[-1].step, step, "it runs meanwhile")


if __name__ == "__main__":
    rospy.init_node("costmap_test", disable_signals=True)
    rostest.rosrun("desert_sim", "costmap", Costmap)
