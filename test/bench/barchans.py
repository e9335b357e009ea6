#!/usr/bin/env python3
"""Barchans of continuum transport beside those of the field: height, width, length and speed of several sizes.

    test/bench/barchans.py [--program desert_run] [--heaps 4,5,7,9] [--days 160] [--wind 9] [--influx 0.1]
                           [--cell 1] [--at-most 20] [--set KEY=VALUE]...

A heap of sand on rock, in a steady wind that brings `influx` times the saturated flux, becomes a barchan. Of its shape at
the end the table has the deviation from the regressions over barchans of southern Morocco (Sauermann et al. 2000, Hesse's
and Finkel's dunes alike): width from horn to horn W = 8.6 H + 8.8 m, length from the toe to the foot of the slip face
L = 5.5 H + 10.8 m; and of all sizes the fit of the speed c = Q/(H + H0). A heap that does not keep half of its sand is
no dune: it is listed as blown away. The exit status is 1 if a width or length deviates by more than --at-most percent.
Needs python3 with numpy and OpenCV.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

import cv2
import numpy as np

YEAR = 365.25 * 86400


def saturated_flux(wind):
    """Of the default parameters [m^2/s], as kernels/sand/saturated_flux.hpp has it."""
    grain, air, diameter, gravity = 2650.0, 1.225, 0.00025, 9.81
    shear = 0.41 * wind / np.log(10 / 0.001)
    shields = shear**2 / ((grain / air - 1) * gravity * diameter)
    return 7.8 * 0.1 * max(shields - 0.01, 0) * diameter * np.sqrt((grain / air - 1) * gravity * diameter) / 0.6


def scenario(height, options):
    """A heap that is about as wide as the barchan that it becomes, in a field that this does not leave."""
    cells = [int(np.ceil((20 * height + 240) / options.cell)), int(np.ceil((16 * height + 60) / options.cell))]
    return f"""
grid: {{width: {cells[0]}, height: {cells[1]}, cell_size: {options.cell}, boundary: open}}
terrain: [cone: {{layer: sand, shape: gaussian, x: {6 * height + 20}, y: {cells[1] * options.cell / 2},
                 radius: {2 * height}, height: {height}}}]
wind: {{speed: {options.wind}}}
sand: {{model: continuum}}
saltation: {{influx: {options.influx * saturated_flux(options.wind):.4g}}}
run: {{time_step: 1 h, duration: {options.days} d}}
"""


def sand_of(folder, cell):
    """The depth of the largest connected dune [m], row 0 in the south."""
    sand = cv2.imread(os.path.join(folder, "sand.tif"), cv2.IMREAD_UNCHANGED)[::-1].astype(float)
    _, labels = cv2.connectedComponents((sand > 0.1).astype(np.uint8), connectivity=4)
    top = labels[np.unravel_index(sand.argmax(), sand.shape)]
    return np.where(labels == top, sand, 0) if top else np.zeros_like(sand)


def measure(folder, cell):
    sand = sand_of(folder, cell)
    if not sand.any():
        return None
    rows, columns = np.nonzero(sand)
    crest = np.unravel_index(sand.argmax(), sand.shape)
    return {"height": sand.max(), "width": (rows.max() - rows.min() + 1) * cell,
            "length": np.count_nonzero(sand[crest[0]]) * cell, "volume": sand.sum() * cell**2,
            "x": (sand.sum(axis=0) * np.arange(sand.shape[1])).sum() / sand.sum() * cell}


def run(height, options):
    """Shape at the end, and the speed over the last third."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "heap.yaml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(scenario(height, options))
        every = options.days * 24 // 3
        settings = [part for setting in options.set for part in ("--set", setting)]
        out = os.path.join(folder, "out")
        subprocess.run([options.program, path, "--quiet", "--out", out, "--every", str(every), *settings], check=True)
        before, after = (measure(os.path.join(out, f"step_{n * every:08d}"), options.cell) for n in (2, 3))
        with open(os.path.join(out, "summary.json"), encoding="utf-8") as file:
            residual = json.load(file)["mass_residual"]["sand"]
    volume = 2 * np.pi * (2 * height) ** 2 * height
    if before is None or after is None or after["volume"] < 0.5 * volume:
        return None, residual
    after["speed"] = (after["x"] - before["x"]) / (every * 3600) * YEAR
    return after, residual


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="desert_run")
    parser.add_argument("--heaps", default="4,5,7,9", help="heights of the heaps [m]")
    parser.add_argument("--days", type=int, default=160)
    parser.add_argument("--wind", type=float, default=9.0, help="at 10 m [m/s]")
    parser.add_argument("--influx", type=float, default=0.1, help="over the saturated flux")
    parser.add_argument("--cell", type=float, default=1.0, help="width of the cells [m]")
    parser.add_argument("--at-most", type=float, default=20.0, help="largest deviation [percent]")
    parser.add_argument("--set", action="append", default=[], help="a setting of the scenario")
    options = parser.parse_args()

    print("| heap | H | W | off 8.6 H + 8.8 | L | off 5.5 H + 10.8 | H/W | speed | kept | residual |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    dunes, worst = [], 0.0
    for height in (float(word) for word in options.heaps.split(",")):
        dune, residual = run(height, options)
        if dune is None:
            print(f"| {height:g} m | blown away | | | | | | | | {residual} |", flush=True)
            continue
        h = dune["height"]
        off = [100 * (dune["width"] / (8.6 * h + 8.8) - 1), 100 * (dune["length"] / (5.5 * h + 10.8) - 1)]
        worst = max(worst, *map(abs, off))
        dunes.append((h, dune["speed"]))
        kept = dune["volume"] / (2 * np.pi * (2 * height) ** 2 * height)
        print(f"| {height:g} m | {h:.2f} m | {dune['width']:.1f} m | {off[0]:+.0f} % | {dune['length']:.1f} m | "
              f"{off[1]:+.0f} % | {h / dune['width']:.3f} | {dune['speed']:.0f} m/a | {kept:.2f} | {residual} |",
              flush=True)
    if len(dunes) > 1:  # 1/c = (H + H0)/Q
        heights, speeds = map(np.array, zip(*dunes))
        slope, offset = np.polyfit(heights, 1 / speeds, 1)
        told = 1 / (slope * heights + offset)
        print(f"\nspeed = {1 / slope:.0f} m^2/a / (H + {offset / slope:.2f} m), "
              f"off by at most {100 * np.abs(speeds / told - 1).max():.0f} %")
    print(f"largest deviation from the regressions: {worst:.0f} % (allowed: {options.at_most:g} %)")
    return 1 if worst > options.at_most or not dunes else 0


if __name__ == "__main__":
    sys.exit(main())
