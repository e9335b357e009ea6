#!/usr/bin/env python3
"""Two things that happen to a barchan of continuum transport: the wind turns, and it is starved.

    test/bench/barchan_life.py [--program desert_run] [--heap 7] [--turns 45,90] [--starved 3] [--cell 0.25]

Turned: a heap becomes a barchan in a steady wind of 9 m/s for 80 days. Then the wind turns. The table has the direction in
which its slip face looks, beside that of the wind, every quarter of its turnover time T = length/speed. Expected is that
it is aligned after T: at most 10 degrees off.

Starved: a heap gets no sand, and shrinks. The smallest barchan is the last state with a steep lee (a square metre that
falls by 28 degrees or more). Expected is a height of 0.5 to 2 m: barchans of the field are not smaller (Sauermann et al.
2000, Kroy et al. 2002), because the air needs the saturation length to load itself.

The exit status is 1 if one of these is not so. Needs python3 with numpy and OpenCV.
"""
import argparse
import os
import subprocess
import sys
import tempfile

import numpy as np

from barchans import saturated_flux, measure, sand_of

WIND = 9.0
STEEP = np.tan(np.radians(28))


def heap(cells, cell, height, at, wind, influx):
    return f"""
grid: {{width: {cells[0]}, height: {cells[1]}, cell_size: {cell}, boundary: open}}
terrain: [cone: {{layer: sand, shape: gaussian, x: {at[0]}, y: {at[1]}, radius: {2 * height}, height: {height}}}]
wind: {wind}
sand: {{model: continuum}}
saltation: {{influx: {influx * saturated_flux(WIND):.4g}}}
run: {{time_step: 1 h}}
"""


def states(program, yaml, folder, days, every):
    """Runs the scenario; the folders of its states, one every so many days."""
    path = os.path.join(folder, "scenario.yaml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(yaml)
    out, steps = os.path.join(folder, "out"), int(round(every * 24))
    subprocess.run([program, path, "--quiet", "--duration", f"{days}d", "--out", out, "--every", str(steps)], check=True)
    return [os.path.join(out, f"step_{n * steps:08d}") for n in range(1, int(days / every) + 1)]


def slip_face(folder, cell):
    """Area that is as steep as a slip face [m^2], the direction in which it looks [deg], and the steepest slope [deg]."""
    fall_y, fall_x = (-slope for slope in np.gradient(sand_of(folder, cell), cell))
    fall = np.hypot(fall_x, fall_y)
    steep = fall > STEEP
    return (np.count_nonzero(steep) * cell**2, np.degrees(np.arctan2(fall_y[steep].sum(), fall_x[steep].sum())),
            np.degrees(np.arctan(fall.max())))


def turned(angle, options, folder):
    """Prints how the barchan follows the wind; whether it has after its turnover time."""
    height = options.heap
    h, c = height - 0.5, 1769 / (height + 1.1)  # of the barchan that comes of it: doc/science/continuum.md
    turnover = (5.5 * h + 10.8) / c * 365.25
    quarter = round(turnover / 4)
    quarters_before, quarters_after = -(-80 // quarter), 5
    days = quarter * (quarters_before + quarters_after)
    size = int(90 + 12 * height + 1.2 * c * days / 365.25)
    way = c * quarter * quarters_after / 365.25
    wind = (f"{{regime: timeline, segments: [{{direction_deg: 0, speed: {WIND}, duration: {quarter * quarters_before} d}}, "
            f"{{direction_deg: {angle}, speed: {WIND}, duration: {days} d}}]}}")
    yaml = heap((size, size), 1.0, height, (30 + 4 * height, size / 2 - 0.5 * way * np.sin(np.radians(angle))), wind, 0.1)
    at = states(options.program, yaml, folder, days, quarter)[quarters_before - 1:]
    off = [(slip_face(state, 1.0)[1] - angle + 180) % 360 - 180 for state in at]
    dune = measure(at[4], 1.0)
    print(f"| {angle} | {turnover:.0f} d | " + " | ".join(f"{o:+.0f}" for o in off) + f" | {dune['height']:.1f} m |", flush=True)
    return abs(off[4]) <= 10


def starved(options, folder):
    """Height of the last state with a steep lee [m]."""
    cells = (int(110 / options.cell), int((12 * options.starved + 16) / options.cell))
    yaml = heap(cells, options.cell, options.starved, (3 * options.starved + 10, cells[1] * options.cell / 2),
                f"{{speed: {WIND}}}", 0.0)
    rows, smallest = [], None
    for n, state in enumerate(states(options.program, yaml, folder, 48, 4)):
        dune, (area, _, steepest) = measure(state, options.cell), slip_face(state, options.cell)
        if dune is None or dune["height"] < 0.2:
            break
        rows.append(f"| {4 * (n + 1)} d | {dune['height']:.2f} m | {dune['width']:.1f} m | {dune['length']:.1f} m | "
                    f"{area:.1f} m2 | {steepest:.0f} deg |")
        if area >= 1:
            smallest = dune["height"]
    print("\n| starved for | H | W | L | steep lee | steepest |\n|---|---|---|---|---|---|\n" + "\n".join(rows))
    return smallest


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="desert_run")
    parser.add_argument("--heap", type=float, default=7.0, help="height of the heap that is turned [m]")
    parser.add_argument("--turns", default="45,90", help="by which the wind turns [deg]")
    parser.add_argument("--starved", type=float, default=3.0, help="height of the heap that is starved [m]")
    parser.add_argument("--cell", type=float, default=0.25, help="width of its cells [m]")
    options = parser.parse_args()
    passed = True
    print("| wind turns by | T | off at 0 | T/4 | T/2 | 3T/4 | T | 5T/4 | H |\n|---|---|---|---|---|---|---|---|---|")
    for angle in (int(word) for word in options.turns.split(",")):
        with tempfile.TemporaryDirectory() as folder:
            passed = turned(angle, options, folder) and passed
    with tempfile.TemporaryDirectory() as folder:
        smallest = starved(options, folder)
    print("\nsmallest barchan: " + ("none" if smallest is None else f"{smallest:.2f} m"))
    return 0 if passed and smallest is not None and 0.5 <= smallest <= 2 else 1


if __name__ == "__main__":
    sys.exit(main())
