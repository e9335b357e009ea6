#!/usr/bin/env python3
"""Whether thin sand oscillates from cell to cell: runs scenarios by desert_run and measures their elevation.

    test/bench/grid_oscillation.py SCENARIO.yaml... [--program desert_run] [--steps N] [--set PATH=VALUE]...

The deviation of a cell is its elevation less the mean of its two neighbours along a row (column). A cell oscillates if
this has the opposite sign of both neighbours' deviations, and thin sand is 1 cm to 1 m deep. Prints for each scenario
the share of the thin cells that oscillate by more than 2 cm, and the root mean square over all thin cells of the
oscillating deviations, each for the worse of rows and columns; these are the measures of test/support/oscillation.hpp.
The exit status is 1 if a share is over 3 %, or a root mean square over 3 cm.
"""
import argparse
import os
import subprocess
import sys
import tempfile

import cv2
import numpy as np


def oscillation(elevation, sand, periodic):
    """Share of thin cells and root mean square [m], for the worse of the two axes."""
    thin = (sand > 0.01) & (sand < 1)
    worst_share = worst_rms = 0.0
    for axis in (0, 1):
        def shifted(field, by):
            if periodic:
                return np.roll(field, by, axis)
            index = np.clip(np.arange(field.shape[axis]) - by, 0, field.shape[axis] - 1)
            return np.take(field, index, axis)
        deviation = elevation - 0.5 * (shifted(elevation, 1) + shifted(elevation, -1))
        alternates = (deviation * shifted(deviation, 1) < 0) & (deviation * shifted(deviation, -1) < 0)
        cells = max(np.count_nonzero(thin), 1)
        worst_share = max(worst_share, np.count_nonzero(thin & alternates & (np.abs(deviation) > 0.02)) / cells)
        worst_rms = max(worst_rms, float(np.sqrt(np.sum(deviation[thin & alternates] ** 2) / cells)))
    return worst_share, worst_rms


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("scenarios", nargs="+")
    parser.add_argument("--program", default="desert_run")
    parser.add_argument("--steps", type=int)
    parser.add_argument("--set", action="append", default=[])
    arguments = parser.parse_args()
    failed = False
    for scenario in arguments.scenarios:
        with tempfile.TemporaryDirectory() as folder:
            command = [arguments.program, scenario, "--quiet", "--out", folder]
            command += ["--steps", str(arguments.steps)] if arguments.steps else []
            for setting in arguments.set:
                command += ["--set", setting]
            subprocess.run(command, check=True)
            read = lambda name: cv2.imread(os.path.join(folder, name), cv2.IMREAD_UNCHANGED).astype(np.float64)
            with open(scenario) as text:
                periodic = "boundary: periodic" in text.read()
            share, rms = oscillation(read("elevation.tif"), read("sand.tif"), periodic)
        failed = failed or share > 0.03 or rms > 0.03
        print(f"{os.path.basename(scenario):24s} {100 * share:5.1f} % {rms:6.3f} m", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
