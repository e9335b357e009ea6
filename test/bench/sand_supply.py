#!/usr/bin/env python3
"""Dunes by sand supply and angle between two winds, without and with strong reptation: figure 3 of Nilles et al. 2024.

    test/bench/sand_supply.py --out FOLDER [--supplies 0.07 0.22 0.45] [--angles 45 105 165] [--steps N]
                              [--size CELLS] [--cores N]

The first wind blows twice as long as the second (strength ratio R = 2), and their resultant to the east. Discs of sand
lie on bare rock, which cover the share that is the supply. desert_compare makes the runs and FOLDER/page.html with
their metrics; FOLDER/table.jpg has a picture for each supply (row) and angle (column): elevations, whose left half is of
a run without reptation and whose right half of one with strong reptation. Needs what desert_compare needs, which is
looked for in $PATH.
"""
import argparse
import json
import math
import pathlib
import subprocess
import sys

from PIL import Image, ImageDraw

SCENARIO = """\
# {share:.0f} % of the ground under sand, winds {angle:g} degrees apart, {reptation} reptation.
grid: {{width: {size}, height: {size}, cell_size: 1.0, boundary: periodic}}
terrain:
  - uniform: {{layer: bedrock, value: 0}}
  - discs: {{layer: sand, coverage: {supply}, radius_low: 5, radius_high: 7, height: 3}}
wind:
  regime: timeline
  segments:
    - {{direction_deg: {first}, speed: 3, duration: 10}}
    - {{direction_deg: {second}, speed: 3, duration: 5}}
reptation: {law}
run: {{steps: {steps}}}
"""
LAWS = {"no": "{method: off}", "strong": "{strength: 0.3, smoothing_strength: 0.1}"}
CELL, MARGIN = 200, 24  # of the table [px]


def directions(angle):
    """Of the two winds, such that 2 w1 + w2 points to the east [deg]."""
    turn = math.degrees(math.atan2(math.sin(math.radians(angle)), 2 + math.cos(math.radians(angle))))
    return -turn, angle - turn


def name_of(supply, angle, reptation):
    return "supply_%g_angle_%g_%s_reptation" % (100 * supply, angle, reptation)


def write_scenarios(folder, o):
    paths = []
    for supply in o.supplies:
        for angle in o.angles:
            first, second = ("%.2f" % d for d in directions(angle))
            for reptation, law in LAWS.items():
                path = folder / (name_of(supply, angle, reptation) + ".yaml")
                path.write_text(SCENARIO.format(share=100 * supply, supply=supply, angle=angle, reptation=reptation, law=law,
                                                first=first, second=second, size=o.size, steps=o.steps), encoding="utf-8")
                paths.append(str(path))
    return paths


def pictures(work):
    """The picture at the end of each run, by the scenario's name."""
    plan = json.loads((work / "plan.json").read_text(encoding="utf-8"))
    return {run["label"]: work / "runs" / key / "end.png" for key, run in plan["runs"].items()}


def table(ends, o):
    """One picture: supplies from top to bottom, angles from left to right."""
    sheet = Image.new("RGB", (MARGIN + len(o.angles) * (CELL + 4), MARGIN + len(o.supplies) * (CELL + 4)), "white")
    draw = ImageDraw.Draw(sheet)
    for column, angle in enumerate(o.angles):
        draw.text((MARGIN + column * (CELL + 4) + CELL // 2 - 20, 6), "%g deg" % angle, fill="black")
    for row, supply in enumerate(o.supplies):
        draw.text((0, MARGIN + row * (CELL + 4) + CELL // 2), "%.0f %%" % (100 * supply), fill="black")
        for column, angle in enumerate(o.angles):
            cell = Image.new("RGB", (CELL, CELL))
            for side, reptation in enumerate(LAWS):
                end = Image.open(ends[name_of(supply, angle, reptation)]).convert("RGB").resize((CELL, CELL), Image.LANCZOS)
                half = (side * CELL // 2, 0, (side + 1) * CELL // 2, CELL)
                cell.paste(end.crop(half), half)
            ImageDraw.Draw(cell).line((CELL // 2, 0, CELL // 2, CELL), fill="white")
            sheet.paste(cell, (MARGIN + column * (CELL + 4), MARGIN + row * (CELL + 4)))
    return sheet


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=pathlib.Path, required=True, metavar="FOLDER", help="of the page and the table")
    parser.add_argument("--supplies", nargs="+", type=float, default=[0.07, 0.22, 0.45], help="shares of the ground under sand")
    parser.add_argument("--angles", nargs="+", type=float, default=[45, 105, 165], help="between the winds [deg]")
    parser.add_argument("--steps", type=int, default=1000)
    parser.add_argument("--size", type=int, default=160, help="of the square grid [cells of a metre]")
    parser.add_argument("--cores", type=int, default=2)
    o = parser.parse_args()
    o.out.mkdir(parents=True, exist_ok=True)
    page = o.out / "page.html"
    words = ["desert_compare"] + write_scenarios(o.out, o)
    words += ["--seeds", "1", "--out", str(page), "--work", str(o.out / "runs"), "--backend", "cpu",
              "--threads", "1", "--cores", str(o.cores)]
    status = subprocess.call(words)
    if status:
        return status
    table(pictures(o.out / "runs"), o).save(o.out / "table.jpg", quality=80)
    return 0


if __name__ == "__main__":
    sys.exit(main())
