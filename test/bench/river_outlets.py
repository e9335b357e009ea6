#!/usr/bin/env python3
"""Whether rivers run where they should: the share of all discharge over the edges of a terrain that leaves through the
cells which GRASS (r.watershed) marks as channel. Needs grass-core; desert_run from PATH or --program.

    test/bench/river_outlets.py DEM [--threshold CELLS] [--rain M_PER_S] [--seconds S] [--program desert_run]

Steady rain on the bare surface of DEM (any raster that GDAL reads), without evaporation, erosion or seepage, until what
leaves is what falls. A cell of the edge is channel if, in GRASS's count of the cells that drain through it or one of its
neighbours on the edge, there are THRESHOLD or more. Prints both discharges and the share; the exit status is 1 if it is
below 0.9, or if the flow is not steady.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

import numpy as np

SCENARIO = """
grid: {{from_raster: {dem}, boundary: open}}
terrain: [raster: {{layer: bedrock, fill_nodata: true}}]
wind: {{speed: 0}}
saltation: {{enabled: false}}
avalanching: {{enabled: false}}
rain: {{rate: {rain}}}
water: {{evaporation: 0, friction: 0.3, most_substeps: 200}}
run: {{steps: {seconds}}}
"""


def grass(commands, folder):
    script = os.path.join(folder, "commands.sh")
    with open(script, "w") as f:
        f.write("set -e\n" + commands)
    environment = dict(os.environ, HOME=folder)
    subprocess.run(["grass", "--tmp-location", "XY", "--exec", "sh", script], check=True, env=environment,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def read_ascii(path):
    """A GRASS ASCII grid, row 0 in the south."""
    with open(path) as f:
        lines = f.read().splitlines()
    rows = [line.split() for line in lines if line and not line[0].isalpha()]
    return np.array(rows, dtype=float)[::-1]


def layers(folder, names, into):
    """Layers that desert_run wrote, row 0 in the south."""
    return [read_ascii(path) for path in convert(folder, names, into)]


def convert(folder, names, into):
    commands = ""
    for name in names:
        commands += (f"r.in.gdal -o input={folder}/{name}.tif output={name} --quiet\ng.region raster={name}\n"
                     f"r.out.ascii input={name} output={into}/{name}.txt precision=12 --quiet\n")
    grass(commands, into)
    return [f"{into}/{name}.txt" for name in names]


def edge_of(shape):
    edge = np.zeros(shape, bool)
    edge[0, :] = edge[-1, :] = edge[:, 0] = edge[:, -1] = True
    return edge


def widened(marked, edge):
    """Marked cells of the edge, and those beside them on it."""
    wide = marked.copy()
    for dy in (-1, 0, 1):
        for dx in (-1, 0, 1):
            shifted = np.zeros_like(marked)
            h, w = marked.shape
            shifted[max(dy, 0):h + min(dy, 0), max(dx, 0):w + min(dx, 0)] = \
                marked[max(-dy, 0):h + min(-dy, 0), max(-dx, 0):w + min(-dx, 0)]
            wide |= shifted
    return wide & edge


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("dem")
    parser.add_argument("--threshold", type=int, default=15)
    parser.add_argument("--rain", type=float, default=1e-5)
    parser.add_argument("--seconds", type=int, default=6000)
    parser.add_argument("--program", default="desert_run")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        dem = os.path.abspath(options.dem)
        scenario = os.path.join(folder, "rivers.yaml")
        with open(scenario, "w") as f:
            f.write(SCENARIO.format(dem=dem, rain=options.rain, seconds=options.seconds))
        out = os.path.join(folder, "out")
        subprocess.run([options.program, scenario, "--out", out, "--quiet"], check=True)
        with open(os.path.join(out, "summary.json")) as f:
            summary = json.load(f)
        cell = summary["cell_size_m"]
        flux_x, flux_y, _ = layers(out, ["water_flux_x", "water_flux_y", "bedrock"], folder)
        grass(f"r.in.gdal -o input={out}/bedrock.tif output=dem --quiet\ng.region raster=dem\n"
              f"r.watershed elevation=dem accumulation=acc --quiet\n"
              f"r.out.ascii input=acc output={folder}/acc.txt --quiet\n", folder)
        drained = np.abs(read_ascii(f"{folder}/acc.txt"))

    # What leaves a cell of the edge: what comes through its inner faces, and its own rain.
    net = np.full(flux_x.shape, options.rain * cell * cell)
    net[:, 1:] += flux_x[:, :-1]
    net[:, :-1] -= flux_x[:, :-1]
    net[1:, :] += flux_y[:-1, :]
    net[:-1, :] -= flux_y[:-1, :]
    edge = edge_of(net.shape)
    leaving = np.where(edge, np.maximum(net, 0), 0)
    falling = options.rain * cell * cell * net.size
    channel = widened((drained >= options.threshold) & edge, edge)
    share = leaving[channel].sum() / leaving.sum()
    print(f"falls {falling:.4f} m3/s, leaves {leaving.sum():.4f} m3/s, of that through channel cells "
          f"({channel.sum()} of {edge.sum()} cells of the edge) {share:.1%}")
    steady = abs(leaving.sum() / falling - 1) < 0.02
    if not steady:
        print("the flow is not steady: ask for more --seconds")
    return 0 if steady and share >= 0.9 else 1


if __name__ == "__main__":
    sys.exit(main())
