#!/usr/bin/env python3
"""~costmap, ~costmap_updates and ~image; and that nothing is copied for nobody."""
import itertools
import time
import unittest

import desert_sim
import rospy
import rostest
from desert_sim.testing import PATIENCE, wait_until
from map_client import Listener, MapTest, Trigger, call, wait_until_known
from map_msgs.msg import OccupancyGridUpdate
from nav_msgs.msg import OccupancyGrid
from sensor_msgs.msg import Image

MIDDLE, SIZE = (74, 28), (128, 96)  # of the terrain [m]
SPACING = 0.001  # s, costmap_update_spacing
LATELY = 0.0015  # s, how long it was sent or replaced lately: the spacing, or 1.5 periods of 1000 Hz


def pour(desert, x, y, merge="add"):
    desert.edit("sand", "circle", merge, 3, center=(x, y), radius=5, inner=1)


def shows(update, x, y):
    """Whether an update has the cell at a point [m]."""
    column, row = (x - 10) // 2, (y + 20) // 2
    return update.x <= column < update.x + update.width and update.y <= row < update.y + update.height


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


class Costmap(MapTest):
    """One subscription of each topic for all tests, which the node knows: changes come to it as updates alone. A test begins
    with the whole map of the start, `base`."""

    @classmethod
    def setUpClass(cls):
        cls.desert = desert_sim.Simulation(timeout=60 * PATIENCE)
        cls.keyframes = Listener("/desert_sim/costmap", OccupancyGrid)
        cls.keyframes.first()
        cls.updates = Listener("/desert_sim/costmap_updates", OccupancyGridUpdate)
        merges = itertools.cycle(("add", "sub"))

        def change():
            pour(cls.desert, 20, 60, next(merges))
            cls.desert.step(0)

        wait_until_known(cls.keyframes, cls.updates, change, cls.publications)

    @classmethod
    def tearDownClass(cls):
        cls.keyframes.close()
        cls.updates.close()

    @classmethod
    def publications(cls):
        return cls.desert.status().publications

    def setUp(self):
        super().setUp()
        stamp = self.desert.status().header.stamp
        self.base = self.keyframes.wait_for(lambda k: k.header.stamp == stamp, "a replaced terrain begins with a keyframe")
        self.let_it_be_longer_ago()
        self.published = self.publications()

    @staticmethod
    def let_it_be_longer_ago(seconds=LATELY):
        """What was sent or replaced until now was not so lately then, by the clock that the node looks at."""
        end = time.monotonic() + seconds
        wait_until(lambda: time.monotonic() > end, "the clock goes on")

    def set_for_this_test(self, **parameters):
        before = self.desert.set_parameters(parameters)
        present = {"costmap_update_rate": 0, "costmap_update_rectangles": 2, "costmap_update_spacing": SPACING,
                   "costmap_update_threshold": 0}
        self.addCleanup(self.desert.set_parameters, {name: present[name] for name in parameters})
        self.assertLessEqual(parameters.items(), before.items())

    def edit(self, x, y):
        pour(self.desert, x, y)

    def since_base(self):
        return [u for u in self.updates.messages if u.header.stamp > self.base.header.stamp]

    def updates_to_now(self, what="an update of the present state"):
        """All updates since the base, once that of the present state is there."""
        stamp = self.desert.status().header.stamp
        self.updates.wait_for(lambda u: u.header.stamp == stamp, what)
        return self.since_base()

    def messages(self):
        """How many there were of all topics since the test began."""
        return self.publications() - self.published

    def expect_messages(self, count):
        self.assertEqual(self.messages(), count, "of all topics: updates, and no keyframe in between")

    def whole(self):
        """The map that a new subscriber gets."""
        self.keyframes.close()
        type(self).keyframes = Listener("/desert_sim/costmap", OccupancyGrid)
        return self.keyframes.first("a late joiner gets the whole map")

    def costs(self):
        """Those of the terrain, of which ~costmap tells."""
        return self.desert.submap(MIDDLE, SIZE, ["traversability"])["traversability"].cost().ravel().tolist()

    def test_costmap_lies_right(self):
        grid = self.base
        self.expect_header(grid.header)
        self.assertEqual((grid.info.width, grid.info.height, grid.info.resolution), (64, 48, 2))
        self.assertEqual((grid.info.origin.position.x, grid.info.origin.position.y), (10, -20))
        self.assertEqual(grid.info.origin.orientation.w, 1)
        for x in range(64):
            for y in range(48):
                near = 55 <= x < 61 and 3 <= y < 8
                top = x in (57, 58) and y == 5  # flat, and all round it
                self.assertEqual(grid.data[y * 64 + x], 20 if top or not near else 100, (x, y))
        self.assertEqual(list(grid.data), self.costs())
        self.assertEqual(self.whole().data, grid.data)

    def test_updates_lead_from_one_keyframe_to_the_next(self):
        self.edit(40, 10)
        self.edit(120, 60)
        self.desert.step(0)
        update, = self.updates_to_now("one rectangle with both edits")
        self.assertTrue(shows(update, 40, 10) and shows(update, 120, 60))
        self.expect_header(update.header)
        for turn in range(8):
            self.edit(20 + 14 * turn, 30)
            self.desert.step(2)
            self.assertEqual(len(self.updates_to_now()), turn + 2, "one for each ~step")
        self.expect_messages(9)
        got = self.since_base()
        assembled = assemble(self.base, got)
        self.assertEqual(assembled, list(self.whole().data))
        self.assertEqual(assembled, self.costs())
        call("reset", Trigger)
        self.keyframes.wait_for(lambda k: k.header.stamp > got[-1].header.stamp and min(k.data) == 20,
                                "a replaced terrain begins with a keyframe")

    def test_an_update_has_nothing_that_was_sent_longer_ago(self):
        self.edit(30, 0)
        self.desert.step(0)
        self.updates_to_now()
        self.let_it_be_longer_ago()
        self.edit(110, 50)
        self.desert.step(0)
        first, second = self.updates_to_now()
        self.assertEqual([shows(first, 30, 0), shows(first, 110, 50)], [True, False])
        self.assertEqual([shows(second, 30, 0), shows(second, 110, 50)], [False, True])

    def test_a_second_subscriber_of_a_process_gets_the_map_too(self):
        with Listener("/desert_sim/costmap", OccupancyGrid) as second:  # by the same connection
            self.assertEqual(second.first("a map for the second").data, self.base.data)

    def test_soon_after_the_terrain_was_replaced_changes_come_as_whole_maps(self):
        self.set_for_this_test(costmap_update_spacing=1000.0)
        call("reset", Trigger)
        self.edit(40, 10)
        self.desert.step(0)
        self.keyframes.wait_for(lambda k: max(k.data[15 * 64:16 * 64]) == 100, "the edit, in row 15")
        self.desert.set_parameters({"costmap_update_spacing": SPACING})
        self.let_it_be_longer_ago()
        self.edit(90, 10)
        self.desert.step(0)
        later, = self.updates_to_now("later as an update, and that is the first one")
        self.assertTrue(shows(later, 90, 10))
        self.expect_messages(3)  # and before it the two maps

    def test_a_threshold_keeps_small_changes_back(self):
        self.set_for_this_test(costmap_update_threshold=5)
        self.desert.edit("sand", "circle", "add", 0.13, center=(40, 10), radius=8, inner=1)  # costs up to 4 more
        self.desert.step(0)
        self.edit(120, 60)
        self.desert.step(0)
        update, = self.updates_to_now("an update of the large change alone")
        self.assertTrue(shows(update, 120, 60))
        self.assertEqual(self.expect_near_costs(5), 4)
        for _ in range(8):
            self.desert.step(1)
        self.edit(110, 30)
        self.desert.step(0)
        self.updates_to_now()
        self.expect_near_costs(5)

    def expect_near_costs(self, threshold):
        """What updates tell is the present costs to within the threshold. The largest difference."""
        held, now = assemble(self.base, self.since_base()), self.costs()
        for a, b in zip(held, now):
            self.assertTrue(abs(a - b) <= threshold and (a == 100) == (b == 100), (a, b))
        return max(abs(a - b) for a, b in zip(held, now))

    def test_rectangles_in_turn_are_one_for_each_edit(self):
        # No change is told while the rate is 0: both edits wait when it rises.
        self.edit(25, -5)
        self.edit(125, 65)
        self.set_for_this_test(costmap_update_rectangles=4, costmap_update_rate=1000.0)
        self.updates.wait_for(lambda _: len(self.since_base()) >= 2, "two rectangles")
        self.edit(75, 30)
        wait_until(lambda: assemble(self.base, self.since_base()) == self.costs(), "the present costs, by a third one")
        got = self.since_base()
        # One edit in each. The second repeats the first where that was sent less than the spacing before, which the clock
        # decides: publisher_schedule moves it, and shows that it does not otherwise.
        self.assertNotEqual(shows(got[0], 25, -5), shows(got[0], 125, 65))
        self.assertTrue(any(shows(u, 25, -5) for u in got[:2]) and any(shows(u, 125, 65) for u in got[:2]))
        self.assertEqual(len(got), 3)
        self.expect_messages(3)

    def test_updates_at_a_rate_lead_to_the_present_costs(self):
        self.expect_updates_while_it_runs(rectangles=1)

    def test_rectangles_in_turn_lead_to_the_present_costs(self):
        self.expect_updates_while_it_runs(rectangles=4)

    def expect_updates_while_it_runs(self, rectangles):
        # Updates lead to the costs only if none is lost, and the node's queue holds ten: at one a step, 200 a second, it
        # would be full when the thread that sends them waits for 50 ms.
        rate = 20.0
        self.set_for_this_test(costmap_update_rectangles=rectangles, costmap_update_rate=rate)
        self.let_it_be_longer_ago(1.5 / rate)
        self.edit(25, -5)
        self.edit(125, 65)
        call("resume", Trigger)
        wait_until(lambda: self.desert.status().step > 50 and len(self.since_base()) >= 3, "updates while it runs")
        call("pause", Trigger)
        self.wait_for_present_costs()
        self.expect_messages(len(self.since_base()))
        self.assertEqual(assemble(self.base, self.since_base()), list(self.whole().data))

    def wait_for_present_costs(self):
        """Until updates have led to them; else AssertionError says how many messages did not come, and which did."""
        try:
            wait_until(lambda: assemble(self.base, self.since_base()) == self.costs(), "the present costs")
        except AssertionError as error:
            raise AssertionError("not the present costs; of %d messages since %s came %s" % (
                self.messages(), self.base.header.stamp,
                [u.header.stamp.to_sec() for u in self.updates.messages[-70:]])) from error

    def test_a_rate_holds_changes_back(self):
        """Its period is so long that all of the test is soon after the terrain was replaced: changes come as whole maps."""
        self.set_for_this_test(costmap_update_rate=0.001, costmap_update_rectangles=1)
        call("resume", Trigger)
        wait_until(lambda: self.desert.status().step > 20, "steps")
        self.edit(40, 10)
        call("pause", Trigger)
        stamp = self.desert.status().header.stamp
        last = self.keyframes.wait_for(lambda k: k.header.stamp == stamp, "a pause publishes what was held back")
        self.assertEqual(list(last.data), self.costs())
        self.assertLessEqual(self.messages(), 2, "at most the first one was due by the rate")

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


class Repeats(unittest.TestCase):
    def test_an_update_repeats_what_a_client_may_not_have_looked_at(self):
        """Of a node whose clients look rarely. It has no keyframes to send, which would replace updates for a while."""
        desert = desert_sim.Simulation("desert_slow", timeout=60 * PATIENCE)
        merges = itertools.cycle(("add", "sub"))
        with Listener("/desert_slow/costmap_updates", OccupancyGridUpdate) as updates:
            def told():
                pour(desert, 30, 0, next(merges))
                desert.step(0)
                return len(updates.messages) > 0

            wait_until(told, "an update of the first edit")
            pour(desert, 110, 50)
            desert.step(0)
            last = updates.wait_for(lambda u: shows(u, 110, 50), "an update of the second edit")
            self.assertTrue(shows(last, 30, 0))
            self.assertLessEqual(last.x, 12)
            self.assertLessEqual(last.y, 12)


class Nobody(MapTest):
    def test_nobody_listens_nothing_is_copied(self):
        desert = desert_sim.Simulation(timeout=60 * PATIENCE)

        def copies_of(steps):
            before = desert.status().snapshots
            for _ in range(steps):
                desert.step(1)
            return desert.status().snapshots - before

        wait_until(lambda: copies_of(1) == 0, "the subscribers of other tests go")
        self.assertEqual(copies_of(10), 0)
        before = desert.status()
        call("resume", Trigger)
        wait_until(lambda: desert.status().step > before.step + 20, "it runs")
        self.assertEqual(desert.status().snapshots, before.snapshots)


if __name__ == "__main__":
    rospy.init_node("costmap_test", disable_signals=True)
    rostest.rosrun("desert_sim", "costmap", "costmap")
