#!/usr/bin/env python3
"""Which name may have been meant: the same as in C++ (test/src/core/did_you_mean_test.cpp)."""
import unittest

from desert_sim.did_you_mean import did_you_mean, not_one_of


class DidYouMean(unittest.TestCase):
    def test_a_typing_error_away(self):
        known = ["width", "height", "cell_size", "boundary", "origin_x"]
        for typed in ("widht", "wdth", "wwidth", "Width", "width ", "withd"):
            self.assertEqual(did_you_mean(typed, known), "; did you mean 'width'?", typed)
        self.assertEqual(did_you_mean("cel_size", known), "; did you mean 'cell_size'?")
        self.assertEqual(did_you_mean("origin", known), "; did you mean 'origin_x'?")

    def test_nothing_that_is_farther_away(self):
        known = ["width", "sand", "x", "wadi"]
        for typed in ("", "depth", "water", "y", "length", "sn", "width"):
            self.assertEqual(did_you_mean(typed, known), "", typed)
        self.assertEqual(did_you_mean("sandd", known), "; did you mean 'sand'?")
        self.assertEqual(did_you_mean("wady", known), "; did you mean 'wadi'?")
        self.assertEqual(did_you_mean("w" * 1000, known), "")
        self.assertEqual(did_you_mean("width", []), "")

    def test_the_text_names_what_is_known(self):
        self.assertEqual(not_one_of("widht", ["width", "height"]),
                         "'widht' is not one of: width, height; did you mean 'width'?")
        self.assertEqual(not_one_of("depth", ["width", "height"]), "'depth' is not one of: width, height")


if __name__ == "__main__":
    unittest.main()
