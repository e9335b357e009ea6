#!/usr/bin/env python3
"""Speed of barchans by their height, in any model of sand. Needs numpy and OpenCV; desert_run from PATH or --program.

    test/bench/migration.py [--model hops|continuum|werner|momiji|bishop] [--heaps 8 10 13 17] [--seeds N]
                            [--steps N] [--jobs N] [--set path=value]...

A heap of sand on rock, alone on a torus, becomes a barchan in a steady wind to the east. What leaves its
horns comes back from the west, so that it keeps its size. Its place is that of the first Fourier mode of the
squared depth along the wind, which counts the dune and not the thin sand around it. Over the second half of
the run its speed is the slope of place over time, and its height the mean of the greatest depth. Prints a row
for each heap (mean of the seeds) and the exponent of speed ~ height^exponent, fitted to all dunes on
logarithmic axes, with its standard error. The exit status is 1 if the exponent is not -1 +- 0.25, which sand
flux over height gives (Bagnold 1941).
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
wind: {speed: 3}
wind_shadow: {start_deg: 8, full_deg: 13}
saltation: {lift: 0.6, bare_depth: 0.1}
reptation: {strength: 0.28, smoothing_strength: 0.15}
"""  # as the scenario barchan
CONTINUUM = "wind: {speed: 9}\nsand: {model: continuum}\n"
SLABS = "wind: {speed: 5}\nsand: {model: %s}\n"
# Physics of a model, its time step [s], and the steps of a run for each metre of the heap: larger dunes are slower.
MODELS = {"hops": (HOPS, 1, 60), "continuum": (CONTINUUM, 3600, 250), "werner": (SLABS % "werner", 1, 60),
          "momiji": (SLABS % "momiji", 1, 60), "bishop": (SLABS % "bishop", 1, 60)}
SNAPSHOTS = 40  # a dune goes less than half round the torus between two
GATE = (-1.25, -0.75)


def scenario(height, seed, options):
    physics, time_step, _ = MODELS[options.model]
    length, width = int(14 * height + 60), int(12 * height + 40)  # cells of a metre
    return f"""
grid: {{width: {length}, height: {width}, cell_size: 1, boundary: periodic}}
terrain: [cone: {{layer: sand, shape: gaussian, x: {length // 2}, y: {width // 2}, radius: {2 * height},
                 height: {height}}}]
seed: {seed}
run: {{time_step: {time_step}}}
{physics}"""


def place(sand):
    """Along the wind, as an angle round the torus [rad]."""
    mode = np.fft.fft((sand ** 2).sum(axis=0))[1]
    return -np.angle(mode)


def run(height, seed, options):
    """Height [m] and speed [m/s] of the dune."""
    _, time_step, per_metre = MODELS[options.model]
    steps = options.steps or int(per_metre * height)
    every = max(1, steps // SNAPSHOTS)
    with tempfile.TemporaryDirectory() as folder:
        path, out = os.path.join(folder, "heap.yaml"), os.path.join(folder, "out")
        with open(path, "w", encoding="utf-8") as file:
            file.write(scenario(height, seed, options))
        words = [options.program, path, "--backend", "cpu", "--threads", "1", "--quiet", "--out", out,
                 "--steps", str(SNAPSHOTS * every), "--every", str(every)]
        for setting in options.set:
            words += ["--set", setting]
        done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        if done.returncode != 0:
            raise ValueError("desert_run: " + done.stdout.strip())
        depths = [cv2.imread(os.path.join(out, f"step_{n * every:08d}", "sand.tif"), cv2.IMREAD_UNCHANGED)
                  .astype(np.float64) for n in range(SNAPSHOTS // 2, SNAPSHOTS + 1)]
    places = np.unwrap([place(sand) for sand in depths]) * depths[0].shape[1] / (2 * np.pi)
    times = np.arange(len(places)) * every * time_step
    return np.mean([sand.max() for sand in depths]), np.polyfit(times, places, 1)[0]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--model", choices=sorted(MODELS), default="hops")
    parser.add_argument("--heaps", type=float, nargs="+", default=[8, 10, 13, 17], help="heights of the heaps [m]")
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--steps", type=int, help="of each run (default: by model and heap)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--set", action="append", default=[], help="a setting of the scenario, path=value")
    parser.add_argument("--program", default="desert_run")
    parser.add_argument("--json", help="a file to write the dunes to")
    options = parser.parse_args()
    if len(set(options.heaps)) < 3:
        raise ValueError("--heaps: an exponent needs at least three heights, not %d" % len(set(options.heaps)))
    dunes = []
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        runs = {heap: [pool.submit(run, heap, seed + 1, options) for seed in range(options.seeds)]
                for heap in options.heaps}
        print("heap  height  speed [m/s]")
        for heap, futures in runs.items():
            found = [future.result() for future in futures]
            dunes += found
            print("%4g  %6.2f  %.4g" % (heap, *np.mean(found, axis=0)), flush=True)
    heights, speeds = np.array(dunes).T
    if (speeds <= 0).any():
        raise ValueError("a dune does not move downwind: %s m/s" % speeds)
    (exponent, _), covariance = np.polyfit(np.log(heights), np.log(speeds), 1, cov=True)
    print("speed ~ height^%.2f +- %.2f" % (exponent, np.sqrt(covariance[0, 0])))
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump({"dunes": dunes, "exponent": exponent, "options": vars(options)}, file, indent=2)
    return 0 if GATE[0] <= exponent <= GATE[1] else 1


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (OSError, ValueError) as fault:
        sys.exit("migration.py: %s" % fault)
