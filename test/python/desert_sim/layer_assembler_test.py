#!/usr/bin/env python3
"""What desert_sim.TerrainClient makes of a stream of keyframes and updates that is whole, reordered, torn or broken: the
cases of test/src/client/elevation_assembler_test.cpp, and tiles in all their forms."""
import math
import unittest

import numpy
import rospy
from desert_sim.layer_assembler import EXPECTED, LOST, NONE, RESTARTED, LayerAssembler
from desert_sim.msg import LayerTile
from messages import HEIGHT, WIDTH, keyframe, tile, update


class Assembler(unittest.TestCase):
    def setUp(self):
        self.assembler = LayerAssembler()

    @property
    def counts(self):
        return self.assembler.counts

    def corner(self):
        return self.assembler.map.values[0, 0]

    def take(self, *messages):
        """The change that the last one makes."""
        for message in messages:
            take = self.assembler.take_update if hasattr(message, "tiles") else self.assembler.take_keyframe
            change = take(message)
        return change

    def expect_gap(self, why, gaps=1, need=LOST):
        self.assertEqual((self.assembler.need(), self.counts.gaps), (need, gaps))
        self.assertIn(why, self.counts.last_gap)

    def expect_whole(self):
        self.assertEqual(self.assembler.need(), NONE)


class Whole(Assembler):
    def test_begins_with_nothing_and_expects_a_keyframe(self):
        self.assertIsNone(self.assembler.map)
        self.assertEqual(self.assembler.need(), EXPECTED)

    def test_updates_are_written_over_the_keyframe(self):
        first = self.take(keyframe(4, 10))
        self.assertTrue(first.replaced)
        self.assertEqual(first.cells, (0, 0, WIDTH, HEIGHT))
        second = self.take(update(4, 1, 11, 5))
        self.assertEqual((second.replaced, second.cells), (False, (0, 0, 2, 3)))
        self.assertIs(second.map, self.assembler.map)
        self.take(update(4, 2, 12, 6))
        self.assertEqual((self.corner(), self.assembler.map.step, self.assembler.map.sequence), (6, 12, 2))
        self.assertEqual(second.map.values[0, 0], 5, "a map never changes")
        with self.assertRaises(ValueError):
            second.map.values[0, 0] = 7
        self.expect_whole()
        counts = self.counts
        self.assertEqual((counts.keyframes, counts.updates), (1, 2))
        self.assertEqual(counts.gaps + counts.late + counts.unusable + counts.refused, 0)

    def test_an_update_without_tiles_moves_time_only(self):
        self.take(keyframe(1, 1, elevation=3))
        nothing = update(1, 1, 9)
        nothing.tiles = []
        self.assertTrue(self.take(nothing).cells.empty)
        self.assertEqual((self.assembler.map.step, self.corner()), (9, 3))

    def test_a_keyframe_tells_what_it_changes(self):
        self.take(keyframe(1, 1))
        change = self.take(keyframe(2, 5))
        self.assertTrue(change.cells.empty and not change.replaced)
        other = keyframe(3, 6)
        other.elevation[WIDTH * 7 + 9] = math.nan
        other.elevation[WIDTH * 8 + 4] = 1
        self.assertEqual(self.take(other).cells, (4, 7, 6, 2))
        self.assertTrue(self.take(keyframe(4, 7, 20, 33)).replaced)


class Reordered(Assembler):
    def test_updates_wait_for_their_keyframe(self):
        self.take(update(1, 1, 2, 8), update(1, 2, 3, 9))
        self.assertIsNone(self.assembler.map)
        self.assertEqual(self.take(keyframe(1, 1)).map.sequence, 2)
        self.assertEqual(self.corner(), 9)
        self.expect_whole()

    def test_updates_that_overtake_a_later_keyframe_are_no_gap(self):
        self.take(keyframe(1, 1), update(2, 1, 3, 7))
        self.assertEqual((self.assembler.need(), self.corner()), (EXPECTED, 0))
        self.assertEqual(self.take(keyframe(2, 2)).cells, (0, 0, 2, 3))
        self.assertEqual((self.corner(), self.counts.gaps), (7, 0))
        self.expect_whole()

    def test_the_last_update_of_the_old_keyframe_may_come_late(self):
        self.take(keyframe(1, 1), keyframe(2, 3, elevation=4), update(1, 1, 3, 8))
        self.assertEqual((self.corner(), self.counts.late), (4, 1))
        self.expect_whole()

    def test_a_latched_keyframe_that_is_sent_again_does_not_turn_time_back(self):
        self.take(keyframe(1, 1), update(1, 1, 2, 8), keyframe(1, 1))
        self.assertEqual((self.corner(), self.counts.restarts), (8, 0))
        self.take(update(1, 2, 3, 9))
        self.assertEqual(self.corner(), 9)


class Torn(Assembler):
    def test_a_missing_update_is_a_gap_until_the_next_keyframe(self):
        self.take(keyframe(1, 1), update(1, 1, 2, 5), update(1, 3, 4, 7))
        self.expect_gap("update 2 of keyframe 1 is missing: update 3 arrived instead")
        self.take(update(1, 4, 5, 8))
        self.assertEqual((self.corner(), self.counts.unusable), (5, 2), "the last good map")
        self.take(update(2, 1, 7, 9), keyframe(2, 6, elevation=8))
        self.assertEqual((self.corner(), self.counts.gaps), (9, 1))
        self.expect_whole()

    def test_a_first_update_that_is_missing_is_a_gap_too(self):
        self.take(update(1, 2, 3), keyframe(1, 1))
        self.expect_gap("update 1 of keyframe 1 is missing")

    def test_a_keyframe_that_does_not_come_is_a_gap_once_it_is_overdue(self):
        self.take(keyframe(1, 1))
        self.assembler.keyframe_overdue()
        self.expect_whole()
        self.take(update(2, 1, 3))
        self.assembler.keyframe_overdue()
        self.expect_gap("keyframe 2")
        self.take(keyframe(3, 4))
        self.expect_whole()

    def test_a_restart_is_noticed_by_updates_and_healed_by_the_keyframe(self):
        self.take(keyframe(7, 100), update(7, 1, 101, 5), update(1, 1, 201, 2))
        self.expect_gap("has restarted", need=RESTARTED)
        self.assertEqual(self.corner(), 5)
        self.take(keyframe(1, 200))
        self.assertEqual((self.corner(), self.counts.restarts), (2, 1))
        self.expect_whole()

    def test_a_restart_with_the_same_numbers_is_noticed(self):
        self.take(keyframe(1, 100), *[update(1, n, 100 + n, 5) for n in range(1, 9)], update(1, 3, 203, 6))
        self.expect_gap("update 3 of keyframe 1 arrived after update 8")
        self.take(keyframe(1, 202, elevation=4))
        self.expect_gap("update 1 of keyframe 1 is missing", gaps=2)
        self.assertEqual(self.corner(), 4)

    def test_another_run_whose_numbers_happen_to_follow_is_noticed(self):
        fresh = update(1, 2, 3, 6)
        fresh.header.stamp = rospy.Time(200)
        self.take(keyframe(1, 100), update(1, 1, 101, 5), fresh)
        self.expect_gap("has restarted")
        self.assertEqual(self.corner(), 5)

    def test_a_step_back_of_the_scenario_is_not_a_restart(self):
        reset = keyframe(2, 101)
        reset.step = 0
        self.take(keyframe(1, 100), reset)
        self.assertEqual((self.assembler.map.step, self.counts.restarts), (0, 0))
        self.expect_whole()

    def test_no_more_waiting_updates_are_kept_than_should_be(self):
        self.take(*[update(1, n, n + 1) for n in range(1, 1001)])
        self.assertEqual(self.counts.unusable, 1000 - 256)
        for n in range(1, 7):
            large = update(2, n, 2000 + n)
            large.tiles[0] = LayerTile(width=2048, height=2048, data=numpy.ones(2048 * 2048, numpy.float32))
            self.take(large)
        self.assertEqual(self.counts.unusable, 1002, "four of 2048 x 2048 cells are kept")


class Played(Assembler):
    """A recording that is played again: the same numbers and stamps from their beginning."""

    def play(self, number, step, count):
        self.take(keyframe(number, step, elevation=step), *self.updates(number, step, count))

    @staticmethod
    def updates(number, step, count):
        return [update(number, n, step + n, step + n) for n in range(1, count + 1)]

    def expect_at(self, step):
        self.assertEqual((self.assembler.map.step, self.corner()), (step, step))
        self.expect_whole()

    def test_of_one_keyframe(self):
        for _ in range(3):
            self.play(1, 10, 4)
            self.expect_at(14)
            self.assertEqual(self.assembler.map.values[5, 5], 10)
        self.assertEqual((self.counts.updates, self.counts.restarts, self.counts.gaps), (12, 2, 0))

    def test_of_one_keyframe_whose_first_update_overtakes_it(self):
        self.play(1, 10, 4)
        self.take(*self.updates(1, 10, 2))
        self.expect_gap("has restarted", need=RESTARTED)
        self.assertEqual(self.corner(), 14, "the last good map stays")
        self.take(keyframe(1, 10, elevation=10))
        self.expect_at(12)

    def test_of_several_keyframes(self):
        for _ in range(3):
            for number in (3, 4, 5):
                self.play(number, 10 * number, 4)
                self.expect_at(10 * number + 4)
        self.assertEqual((self.counts.gaps, self.counts.restarts), (0, 2))

    def test_of_several_keyframes_in_any_order_of_the_two_connections(self):
        self.play(1, 10, 2)
        self.play(2, 20, 2)
        self.take(*self.updates(1, 10, 1))  # before its keyframe
        self.assertEqual(self.assembler.need(), RESTARTED)
        self.take(keyframe(1, 10, elevation=10))
        self.expect_at(11)
        # Keyframe 1 comes before the last update of the turn before.
        self.take(keyframe(2, 20, elevation=20), keyframe(1, 10, elevation=10), *self.updates(2, 20, 1),
                  *self.updates(1, 10, 2))
        self.expect_at(12)
        self.assertEqual(self.counts.gaps, 1)

    def test_in_a_loop_by_who_joined_late(self):
        for joined in (1, 3, 8):  # before which update of the second keyframe
            self.assembler = LayerAssembler()
            self.take(*self.updates(2, 20, 9)[joined - 1:])
            for _ in range(3):
                self.take(keyframe(1, 10, elevation=10), keyframe(2, 20, elevation=20))
                for n, message in enumerate(self.updates(2, 20, 9), 1):
                    self.take(message)
                    self.expect_at(20 + n)

    def test_a_restart_after_updates_that_waited_is_no_recording(self):
        self.take(update(1, 1, 11, 5), keyframe(1, 10, elevation=4), update(1, 1, 101, 6))
        self.expect_gap("has restarted", need=RESTARTED)
        self.assertEqual(self.corner(), 5)


class Tiles(Assembler):
    """The forms of a tile: z = float32(float64(z) + change * resolution)."""

    def write(self, **fields):
        self.take(keyframe(1, 1, 4, 3, elevation=0.3))
        message = update(1, 1, 2)
        message.tiles = [LayerTile(x=1, y=1, **fields)]
        self.take(message)
        self.assertEqual(self.counts.refused, 0, self.counts.last_refusal)
        return self.assembler.map.values

    @staticmethod
    def moved(steps, resolution):
        start = numpy.full(len(steps), 0.3, numpy.float32).astype(float)
        return (start + numpy.array(steps) * float(numpy.float32(resolution))).astype(numpy.float32)

    def test_steps_of_eight_bits(self):
        values = self.write(width=3, height=2, bits=8, resolution=0.01, changes=[1, -128, 127, 0, -1, 5])
        numpy.testing.assert_array_equal(values[1:, 1:].ravel(), self.moved([1, -128, 127, 0, -1, 5], 0.01))
        self.assertTrue((values[0] == numpy.float32(0.3)).all() and (values[:, 0] == numpy.float32(0.3)).all())

    def test_steps_of_four_bits_of_masked_cells(self):
        # Cells 0, 2 and 5 of the tile; changes 7, -8 and -1, and half a byte that is not used.
        values = self.write(width=3, height=2, bits=4, resolution=0.25, changed=bytes([0b10100100]), changes=[0x78, -16])
        expected = numpy.full((3, 4), 0.3, numpy.float32)
        expected[1, 1], expected[1, 3], expected[2, 3] = self.moved([7, -8, -1], 0.25)
        numpy.testing.assert_array_equal(values, expected)

    def test_absolute_values_of_masked_cells(self):
        values = self.write(width=3, height=2, changed=[0b10000100], data=[math.nan, 9.5])
        expected = numpy.full((3, 4), 0.3, numpy.float32)
        expected[1, 1], expected[2, 3] = math.nan, 9.5
        numpy.testing.assert_array_equal(values, expected)

    def test_absolute_values_of_all_cells(self):
        numpy.testing.assert_array_equal(self.write(width=2, height=1, data=[4, 5])[1], numpy.float32([0.3, 4, 5, 0.3]))


class Broken(Assembler):
    def test_bad_keyframes_are_refused_with_the_reason(self):
        def spoil(name, value):
            def change(k):
                *path, last = name.split(".")
                for part in path:
                    k = getattr(k, part)
                setattr(k, last, value)
            return change

        def value_17(k):
            k.elevation[17] = -math.inf

        bad = (("9099 values for 130 x 70", spoil("elevation", numpy.zeros(9099, numpy.float32))),
               ("9100 values for 0 x 70", spoil("width", 0)), ("4294967295", spoil("width", 4294967295)),
               ("cell_size is 0", spoil("cell_size", 0)), ("cell_size is nan", spoil("cell_size", math.nan)),
               ("origin is (inf", spoil("origin.position.x", math.inf)), ("z = 0", spoil("origin.position.z", 1)),
               ("orientation", spoil("origin.orientation.w", 0)), ("sim_time", spoil("sim_time", math.inf)),
               ("cell_size is 1e+300: must be 0.001 to", spoil("cell_size", 1e300)),
               ("1e+300, 0): must be within", spoil("origin.position.y", 1e300)),
               ("value 0 is 3e+38: must be within", spoil("elevation", numpy.full(9100, 3e38, numpy.float32))),
               ("value 17 is -inf", value_17))
        for refused, (reason, change) in enumerate(bad, 1):
            message = keyframe(1, 1)
            change(message)
            self.assertIsNone(self.take(message).map)
            self.assertEqual(self.counts.refused, refused, reason)
            self.assertIn(reason, self.counts.last_refusal)
            self.assertIn("keyframe 1", self.counts.last_refusal)
        self.assertIsNone(self.assembler.map)

    def test_bad_updates_are_refused_whole_and_need_a_keyframe_then(self):
        steps = {"data": [], "changes": [0] * 6}
        bad = (("tile 1: 5 values for 2 x 3", {"data": [1.0] * 5}), ("tile 1: 0 values for 2 x 0", {"height": 0, "data": []}),
               ("tile 1: value 2 is inf", {"data": [1, 1, math.inf, 1, 1, 1]}),
               ("tile 1: value 0 is -3e+38", {"data": [-3e38, 1, 1, 1, 1, 1]}),
               ("tile 1: 1 values for 2 cells that changed", {"changed": [0b10000100], "data": [1]}),
               ("tile 1: 0 values for 0 cells that changed", {"changed": [0], "data": []}),
               ("tile 1: 2 bytes of mask for 2 x 3", {"changed": [0xfc, 0]}),
               ("tile 1: bit 6 of its mask is set", {"changed": [0xfe]}),
               ("tile 1: has changes and absolute values", {"changes": [0] * 6}),
               ("tile 1: resolution is 0", {"bits": 8, **steps}), ("tile 1: has changes of 0 bits", steps),
               ("tile 1: resolution is nan", {"bits": 8, "resolution": math.nan, **steps}),
               ("tile 1: 12 values for 2 x 3", {"bits": 4, "resolution": 1, **steps}),
               ("tile 1 reaches to cell (131, 3)", {"x": 129}), ("tile 1 reaches to cell (2, 4294967298)", {"y": 4294967295}))
        for number, (reason, fields) in enumerate(bad, 1):
            self.take(keyframe(number, 10 * number))
            message = update(number, 1, 10 * number + 1)
            message.tiles.append(tile(0, 0, 2, 3, 1.0))
            for name, value in fields.items():
                setattr(message.tiles[1], name, value)
            self.expect_refused(message, number, reason)
        number += 1
        for reason, spoil in (("sequence", lambda u: setattr(u, "sequence", 0)),
                              ("sim_time", lambda u: setattr(u, "sim_time", math.inf)),
                              ("frame is 'odom'", lambda u: setattr(u.header, "frame_id", "odom"))):
            self.take(keyframe(number, 10 * number))
            message = update(number, 1, 10 * number + 1)
            spoil(message)
            self.expect_refused(message, number, reason)
            number += 1
        self.assertEqual(self.counts.gaps, number - 1)

    def expect_refused(self, message, refused, reason):
        self.assertIsNone(self.take(message).map)
        self.assertEqual(self.counts.refused, refused, reason)
        self.assertIn(reason, self.counts.last_refusal)
        self.assertEqual(self.corner(), 0, "its first tile is sound, and must not be written")
        self.assertEqual(self.assembler.need(), LOST)

    def test_an_update_that_waited_is_checked_against_its_keyframe(self):
        self.take(update(1, 1, 2), keyframe(1, 1, 1, 70))
        self.assertEqual(self.counts.refused, 1)
        self.expect_gap("tile 0 reaches to cell (2, 3) of a grid of 1 x 70")


if __name__ == "__main__":
    unittest.main()
