#!/usr/bin/env python3
"""desert_sim.picture: lethal cells are red, water is blue, lethal or not, and north is up."""
import unittest

import numpy
from desert_sim.layer_messages import map_of
from desert_sim.picture import Picture
from messages import keyframe

WIDTH, HEIGHT = 8, 6


class Tints(unittest.TestCase):
    def test_water_is_blue_whether_it_is_lethal_or_not(self):
        ground = map_of(keyframe(1, 1, WIDTH, HEIGHT))
        costs, water = numpy.zeros((HEIGHT, WIDTH), numpy.int8), numpy.zeros((HEIGHT, WIDTH), numpy.float32)
        costs[0:3, 0:4] = 100  # south-west
        water[0:3, 2:6], water[0, 0] = 0.5, numpy.nan
        drawn, dry = Picture(ground, costs, water=water), Picture(ground, costs)
        scale = drawn.image.shape[0] // HEIGHT

        def pixel(picture, column, row):
            """Blue, green, red of a cell, counted from the south-west."""
            return picture.image[(HEIGHT - 1 - row) * scale + scale // 2, column * scale + scale // 2].astype(int)

        blue, _, red = pixel(drawn, 3, 1)
        self.assertGreater(blue, red + 60, "lethal water")
        self.assertLess(numpy.abs(pixel(drawn, 3, 1) - pixel(drawn, 5, 1)).max(), 30, "and water that is not")
        for column, row in ((0, 0), (1, 1), (7, 1), (3, 4)):
            self.assertTrue((pixel(drawn, column, row) == pixel(dry, column, row)).all(), "dry ground (%d, %d)" % (column, row))
        self.assertGreater(pixel(drawn, 1, 1)[2] - pixel(drawn, 1, 1)[0], pixel(drawn, 7, 1)[2] - pixel(drawn, 7, 1)[0] + 30, "red")


if __name__ == "__main__":
    unittest.main()
