#!/usr/bin/env python3
"""Orientation of crests under two winds, against the bedform instability. Needs numpy and OpenCV; desert_run from
PATH or --program.

    test/bench/two_winds.py [--angles 45 60 ...] [--seeds N] [--steps N] [--size CELLS] [--jobs N]
                            [--model hops|continuum|werner|momiji|bishop] [--first DEG] [--set path=value]...

The first wind blows to DEG (0, the east) twice as long as the second, which blows to DEG + THETA, both in turn; there
is plenty of sand. A model that knows no directions of the grid has the same crests for every DEG. Directions of crests
are counter-clockwise from the first wind, from the structure tensor of the elevation smoothed by 4 m. Expected is the
direction of fastest growth: the maximum of sum Q_i (|s_i| + 1.6 s_i^2), s_i = sin(theta_i - crest), by Rubin & Hunter
1987, Courrech du Pont 2014 and Gao 2015. Prints a row for each angle (the mean of all seeds, the worst seed, and the
coherence: 1 if all slopes are parallel) and the rms of the rows. The exit status is 1 if a row is more than 10 degrees
off, or the rms more than 5 degrees.
"""
import argparse
import concurrent.futures
import json
import os
import subprocess
import sys
import tempfile

import cv2
import numpy as np

HOPS = """
grid: {{width: {size}, height: {size}, cell_size: 1}}
terrain: [noise: {{layer: sand, low: 3, high: 5}}]
wind:
  regime: timeline
  segments:
    - {{direction_deg: {first}, speed: 3, duration: 6}}
    - {{direction_deg: {second}, speed: 3, duration: 3}}
reptation: {{strength: 0.1}}
seed: {seed}
run: {{steps: {steps}}}
"""
CONTINUUM = """
grid: {{width: {size}, height: {size}, cell_size: 1}}
terrain: [noise: {{layer: sand, low: 4.9, high: 5.1, scale: 4}}]
wind:
  regime: timeline
  segments:
    - {{direction_deg: {first}, speed: 9, duration: 2 d}}
    - {{direction_deg: {second}, speed: 9, duration: 1 d}}
sand: {{model: continuum}}
seed: {seed}
run: {{time_step: 1 h, steps: {steps}}}
"""
# Seasons are short beside the time in which a dune turns; ones of 20 and 10 s make no difference.
SLABS = """
grid: {{width: {size}, height: {size}, cell_size: 1}}
terrain: [uniform: {{layer: sand, value: 3.3333333}}]
wind:
  regime: timeline
  segments:
    - {{direction_deg: {first}, speed: 5, duration: 4}}
    - {{direction_deg: {second}, speed: 5, duration: 2}}
sand: {{model: {model}}}
seed: {seed}
run: {{steps: {steps}}}
"""
TEMPLATES = {"hops": HOPS, "continuum": CONTINUUM, "werner": SLABS, "momiji": SLABS, "bishop": SLABS}
GAMMA = 1.6
SIGMA = 4.0  # of the smoothing [m]


def crest_orientation(elevation):
    """Direction along the crests [deg, 0 ... 180] and coherence."""
    ky, kx = (2 * np.pi * np.fft.fftfreq(n) for n in elevation.shape)
    gauss = np.exp(-0.5 * SIGMA ** 2 * (kx[None, :] ** 2 + ky[:, None] ** 2))
    modes = np.fft.fft2(elevation) * gauss
    gx, gy = (np.fft.ifft2(1j * k * modes).real for k in (kx[None, :], ky[:, None]))
    xx, xy, yy = (gx * gx).sum(), (gx * gy).sum(), (gy * gy).sum()
    across = 0.5 * np.degrees(np.arctan2(2 * xy, xx - yy))
    return (across + 90) % 180, np.hypot(xx - yy, 2 * xy) / (xx + yy)


def expected(theta):
    crest = np.radians(np.arange(0, 180, 0.01))
    growth = 0
    for wind, transport in ((0, 2), (theta, 1)):
        s = np.sin(np.radians(wind) - crest)
        growth = growth + transport * (abs(s) + GAMMA * s * s)
    return np.degrees(crest[np.argmax(growth)])


def apart(a, b):
    """Signed angle between two lines [deg, -90 ... 90]."""
    return (a - b + 90) % 180 - 90


def run(options, theta, seed):
    with tempfile.TemporaryDirectory() as folder:
        scenario, out = os.path.join(folder, "two_winds.yaml"), os.path.join(folder, "out")
        with open(scenario, "w") as file:
            file.write(TEMPLATES[options.model].format(
                size=options.size, first=options.first, second=options.first + theta, seed=seed, steps=options.steps,
                model=options.model))
        command = [options.program, scenario, "--backend", "cpu", "--threads", "1", "--quiet", "--out", out]
        for setting in options.set:
            command += ["--set", setting]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        if done.returncode != 0:
            raise ValueError("desert_run: " + done.stdout.strip())
        elevation = cv2.imread(os.path.join(out, "elevation.tif"), cv2.IMREAD_UNCHANGED)
        crest, coherence = crest_orientation(elevation[::-1].astype(np.float64))  # row 0 is the south
        return crest - options.first, coherence


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--angles", type=float, nargs="+", default=[45, 60, 75, 105, 120, 135, 150])
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--steps", type=int, default=1000)
    parser.add_argument("--size", type=int, default=256)
    parser.add_argument("--model", choices=sorted(TEMPLATES), default="hops")
    parser.add_argument("--first", type=float, default=0, help="direction of the first wind on the grid [deg]")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--set", action="append", default=[], help="a setting of the scenario, path=value")
    parser.add_argument("--program", default="desert_run")
    parser.add_argument("--json", help="a file to write the rows to")
    options = parser.parse_args()
    rows = []
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        runs = {theta: [pool.submit(run, options, theta, seed + 1) for seed in range(options.seeds)]
                for theta in options.angles}
        print("theta  expected  crests   off  worst seed  coherence")
        for theta in options.angles:
            goal = expected(theta)
            results = [future.result() for future in runs[theta]]
            offs = [apart(crest, goal) for crest, _ in results]
            rows.append({"theta": theta, "expected": goal, "off": float(np.mean(offs)),
                         "worst": max(offs, key=abs), "coherence": float(np.mean([c for _, c in results]))})
            print("%5g  %8.1f  %6.1f  %4.1f  %10.1f  %9.2f" % (
                theta, goal, (goal + rows[-1]["off"]) % 180, rows[-1]["off"], rows[-1]["worst"],
                rows[-1]["coherence"]), flush=True)
    rms = float(np.sqrt(np.mean([row["off"] ** 2 for row in rows])))
    print("rms %.1f degrees" % rms)
    if options.json:
        with open(options.json, "w") as file:
            json.dump({"rows": rows, "rms": rms, "options": vars(options)}, file, indent=2)
    return 1 if rms > 5 or any(abs(row["off"]) > 10 for row in rows) else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (OSError, ValueError) as fault:
        sys.exit("two_winds.py: %s" % fault)
