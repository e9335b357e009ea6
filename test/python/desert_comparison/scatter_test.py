#!/usr/bin/env python3
"""Means and deviations over seeds, of numbers whose answers are known, and units."""
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../python"))

from desert_comparison import catalogue, scatter  # noqa: E402


class Scatter(unittest.TestCase):
    def test_numbers(self):
        mean, deviation = scatter.linear([2, 4, 4, 4, 5, 5, 7, 9])
        self.assertEqual(mean, 5)
        self.assertAlmostEqual(deviation, (32 / 7) ** 0.5)
        self.assertEqual(scatter.linear([3]), (3, None))

    def test_directions_go_on_over_north_and_east(self):
        mean, deviation = scatter.circular([350, 10])
        self.assertAlmostEqual((mean + 180) % 360, 180)
        self.assertAlmostEqual(deviation, 10.03, delta=0.01)  # sqrt(-2 ln cos 10 deg)
        self.assertAlmostEqual(scatter.circular([180, 270])[0], 225)
        self.assertEqual(scatter.circular([0, 180]), (None, None))

    def test_crests_have_no_ends(self):
        mean, deviation = scatter.axial([175, 5])
        self.assertAlmostEqual((mean + 90) % 180, 90)
        self.assertAlmostEqual(deviation, 5.01, delta=0.01)
        self.assertAlmostEqual(scatter.axial([80, 100])[0], 90)

    def test_text(self):
        self.assertEqual(scatter.text([1.0, 2.0]), "1.50 ± 0.71")
        self.assertEqual(scatter.text([120.0, 180.0]), "150 ± 42")
        self.assertEqual(scatter.text([1.23456]), "1.23")
        self.assertEqual(scatter.text([5.0, 5.0]), "5.00 ± 0.00")
        self.assertEqual(scatter.text([0.0, 0.0]), "0.00 ± 0.00")
        self.assertEqual(scatter.text([None, None]), "–")
        self.assertEqual(scatter.text([1.0, None, 2.0]), "1.50 ± 0.71 (2 of 3 runs)")
        self.assertEqual(scatter.text([0.2202840, 0.2202841]), "0.2203 ± 0.0000")
        self.assertEqual(scatter.text([12340.0, 12352.0]), "12346 ± 8")
        self.assertEqual(scatter.text([1e-6, 2e-6]), "1.50e-06 ± 7.07e-07")
        self.assertEqual(scatter.text([359.96, 0.02], scatter.circular), "0.0 ± 0.0")
        self.assertEqual(scatter.text([84.0, 96.0], scatter.axial), "90.0 ± 6.0")

    def test_motion_is_the_mean_of_the_last_half(self):
        def snapshots(*values):
            return [{"time_s": t, "flux_m2_s": a, "flux_direction_deg": d} for t, a, d in values]
        start, early = (0, None, None), (10, 99, 180)
        for key, value in (("flux_m2_s", 5), ("flux_direction_deg", 53.13)):
            self.assertAlmostEqual(catalogue.value_of(snapshots(start, early, (15, 6, 0), (20, 8, 90)), key), value, 2)
        # Three quarters of the time count three times as much.
        self.assertAlmostEqual(catalogue.value_of(snapshots(start, early, (12.5, 4, 0), (20, 8, 0)), "flux_m2_s"), 7)
        self.assertEqual(catalogue.value_of(snapshots(start, early, (15, None, None), (20, 8, 90)), "flux_m2_s"), 8)
        self.assertIsNone(catalogue.value_of(snapshots(start, early, (16, None, None), (20, 8, 90)), "flux_m2_s"))

    def test_years_of_dunes_are_in_metres_a_year(self):
        def units(time):
            return {m.key: (m.unit, m.scale) for m in catalogue.metrics_for(time)}
        self.assertEqual(units(900)["migration_speed_m_s"], ("m/s", 1))
        self.assertEqual(units(24 * 31557600)["migration_speed_m_s"], ("m/a", 31557600))
        self.assertEqual(units(24 * 31557600)["wavelength_m"], units(900)["wavelength_m"])
        self.assertEqual([catalogue.time_unit(days * 86400)[0] for days in (0.01, 60, 2000)], ["s", "d", "a"])


if __name__ == "__main__":
    unittest.main()
