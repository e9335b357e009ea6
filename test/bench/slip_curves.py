#!/usr/bin/env python3
"""Plots slip, drift and sinkage of the rover classes, as the program slip_curves computes them from the kernels' laws.

  test/bench/slip_curves.py PROGRAM PICTURE.png
  test/bench/slip_curves.py --table PAGE PROGRAM   writes the table of doc/robotics/wheel_soil.md anew
  test/bench/slip_curves.py --check PAGE PROGRAM   exit status 1 if that table is stale
"""
import csv
import pathlib
import re
import subprocess
import sys


def curves(program):
    """{rover: {looseness: rows}}; each row has the program's columns as numbers."""
    found = {}
    text = subprocess.run([program], check=True, capture_output=True, text=True).stdout
    for row in csv.DictReader(text.splitlines()):
        rover = row.pop("rover")
        values = {key: float(value) for key, value in row.items()}
        found.setdefault(rover, {}).setdefault(values["looseness"], []).append(values)
    return found


def table(found):
    slopes, shown = (0, 10, 20), (0, 0.3, 1)
    lines = ["| rover | looseness |" + "".join(" %d° |" % s for s in slopes), "|---|---|" + "---|" * len(slopes)]
    for rover, by_looseness in found.items():
        for looseness, rows in by_looseness.items():
            if looseness not in shown:
                continue
            at = {row["slope_deg"]: row for row in rows}
            cells = ["%d %%, %.0f mm" % (round(100 * at[s]["slip"]), 1000 * at[s]["sinkage_m"]) for s in slopes]
            lines.append("| `%s` | %g | %s |" % (rover, looseness, " | ".join(cells)))
    return "\n".join(lines) + "\n"


def write_table(page, text, check):
    """Puts the table between its marks in the page."""
    file = pathlib.Path(page)
    before = file.read_text()
    after = re.sub(r"(?s)(?<=<!-- slip table -->\n).*(?=<!-- end of slip table -->)", lambda _: text, before)
    if check and after != before:
        sys.exit("%s is stale: test/bench/slip_curves.py --table %s slip_curves" % (page, page))
    if not check:
        file.write_text(after)


def plot(found, picture):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    rows = (("slip", 1, "slip"), ("drift", 1, "drift on a slope across, tan β"), ("sinkage_m", 1000, "sinkage [mm]"))
    figure, axes = plt.subplots(len(rows), len(found), figsize=(3.2 * len(found), 8), sharex=True, sharey="row")
    for column, (rover, by_looseness) in enumerate(found.items()):
        axes[0][column].set_title(rover)
        axes[-1][column].set_xlabel("slope [deg], < 0 downhill")
        for line, (key, scale, label) in enumerate(rows):
            axis = axes[line][column]
            for number, (looseness, points) in enumerate(by_looseness.items()):
                axis.plot([p["slope_deg"] for p in points], [scale * p[key] for p in points],
                          color=plt.cm.copper(number / 3), label="looseness %g" % looseness)
            axis.grid(alpha=0.3)
            if column == 0:
                axis.set_ylabel(label)
    axes[0][0].legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(picture, dpi=90)


if __name__ == "__main__":
    if len(sys.argv) == 4 and sys.argv[1] in ("--table", "--check"):
        write_table(sys.argv[2], table(curves(sys.argv[3])), sys.argv[1] == "--check")
    elif len(sys.argv) == 3:
        plot(curves(sys.argv[1]), sys.argv[2])
    else:
        sys.exit(__doc__)
