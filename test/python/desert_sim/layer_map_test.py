#!/usr/bin/env python3
"""desert_sim.LayerMap answers as LayerMap of C++ does: the surface of a keyframe whose values are known."""
import math
import unittest

import numpy
from desert_sim.layer_map import NO_CELLS, Rectangle
from desert_sim.layer_messages import map_of
from messages import keyframe

WIDTH, HEIGHT = 13, 7


def plane(change=None):
    """z = 3 + 0.5 x - 0.25 y on cells of 2 m with the corner at (10, -20)."""
    grid = keyframe(1, 1, WIDTH, HEIGHT)
    rows, columns = numpy.mgrid[0:HEIGHT, 0:WIDTH]
    z = 3 + 0.5 * (10 + 2 * (columns + 0.5)) - 0.25 * (-20 + 2 * (rows + 0.5))
    if change:
        change(z)
    grid.elevation = z.astype(numpy.float32).ravel()
    return map_of(grid)


class Queries(unittest.TestCase):
    def test_what_it_is(self):
        m = plane()
        self.assertEqual((m.layer, m.unit, m.frame, m.step, m.width, m.height), ("elevation", "m", "terrain", 1, WIDTH, HEIGHT))
        self.assertEqual(m.extent, (10, 36, -20, -6))
        self.assertEqual(m.values.dtype, numpy.float32)
        with self.assertRaises(ValueError):
            m.values[0, 0] = 1
        with self.assertRaises(AttributeError):
            m.step = 2

    def test_value_is_bilinear_and_constant_beyond_the_outer_centres(self):
        m = plane()
        for x, y in ((11, -19), (12.3, -11.7), (35, -7)):
            self.assertAlmostEqual(m.value(x, y), 3 + 0.5 * x - 0.25 * y, places=5)
        self.assertEqual(m.value(10, -20), m.value(11, -19))
        self.assertEqual(m.value(36, -6), m.value(35, -7))
        self.assertTrue(math.isnan(m.value(9.99, -10)) and math.isnan(m.value(20, -5.99)) and math.isnan(m.value(math.nan, -10)))

    def test_arrays_are_answered_with_arrays(self):
        m = plane()
        x, y = numpy.array([12.0, 20.0, 50.0]), -10.0
        expected = [m.value(each, y) for each in x]
        numpy.testing.assert_array_equal(m.value(x, y), expected)
        self.assertEqual(m.value(x[:2, None], numpy.array([[-10.0, -12.0, -8.0]])).shape, (2, 3))
        self.assertEqual(m.normal(x, y).shape, (3, 3))
        self.assertEqual(m.normal(12.0, y).shape, (3,))

    def test_normal_and_slope_are_those_of_the_surface(self):
        m = plane()
        length = math.sqrt(1 + 0.5 ** 2 + 0.25 ** 2)
        numpy.testing.assert_allclose(m.normal(20, -12), [-0.5 / length, 0.25 / length, 1 / length], atol=1e-6)
        self.assertAlmostEqual(m.slope(20, -12), math.atan(math.hypot(0.5, 0.25)), places=6)
        self.assertTrue(math.isnan(m.slope(0, 0)))

    def test_unknown_cells_of_weight_0_do_not_matter(self):
        def hole(z):
            z[3, 4] = math.nan
        m = plane(hole)
        x, y = m.cell_to_world(5, 3)
        self.assertAlmostEqual(m.value(x, y), 3 + 0.5 * x - 0.25 * y, places=5)
        self.assertTrue(math.isnan(m.value(x - 0.1, y)))
        self.assertTrue(math.isnan(m.cell_value(*m.cell_to_world(4, 3))))

    def test_cells_and_points(self):
        m = plane()
        self.assertEqual(m.cell_to_world(0, 0), (11, -19))
        self.assertEqual(m.world_to_cell(11.9, -18.1), (0, 0))
        self.assertEqual(m.world_to_cell(12, -18), (1, 1))
        self.assertEqual(m.world_to_cell(36, -6), (WIDTH - 1, HEIGHT - 1), "the outer edges belong to the grid")
        column, row = m.world_to_cell(numpy.array([11.0, 35.0]), -19.0)
        self.assertEqual((column.tolist(), row.tolist()), ([0, 12], [0, 0]))
        for x, y in ((9.9, -10), (20, -5), (math.nan, -10)):
            self.assertFalse(m.contains(x, y))
            with self.assertRaisesRegex(IndexError, r"from \(10, -20\) to \(36, -6\) m in terrain"):
                m.world_to_cell(x, y)
        self.assertEqual(m.cell_value(11.9, -18.1), m.values[0, 0])
        self.assertTrue(math.isnan(m.cell_value(0, 0)))

    def test_a_single_cell(self):
        m = map_of(keyframe(1, 1, 1, 1, elevation=4))
        self.assertEqual((m.value(10.1, -18.1), m.slope(11, -19)), (4, 0))

    def test_costs(self):
        grid = keyframe(1, 1, 6, 1)
        grid.elevation = numpy.float32([0, 1, 0.5, 0.011, math.nan, -0.1])
        m = map_of(grid)
        with self.assertRaisesRegex(ValueError, "elevation"):
            m.cost()
        object.__setattr__(m, "layer", "traversability")
        self.assertEqual(m.cost().tolist(), [[100, 0, 50, 98, -1, 100]])


class Rectangles(unittest.TestCase):
    def test_union_and_slices(self):
        self.assertEqual(NO_CELLS.union(Rectangle(2, 3, 4, 5)), (2, 3, 4, 5))
        self.assertEqual(Rectangle(2, 3, 1, 1).union(Rectangle(5, 1, 2, 2)), (2, 1, 5, 3))
        values = numpy.arange(20).reshape(4, 5)
        self.assertEqual(values[Rectangle(3, 1, 2, 1).slices].tolist(), [[8, 9]])


if __name__ == "__main__":
    unittest.main()
