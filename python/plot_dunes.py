#!/usr/bin/env python3
"""Draws a table of desert_dunes: ways of the dunes, heights over time, and speeds by height.

  python/plot_dunes.py PICTURE.png DUNES.csv     (what desert_dunes --plot does)
"""
import csv
import sys


def read(path):
    """Rows by dune, with numbers where there are any."""
    dunes = {}
    with open(path) as file:
        for row in csv.DictReader(file):
            dunes.setdefault(int(row["id"]), []).append(
                {key: float(value) if value else None for key, value in row.items() if key != "event"})
    return dunes


def main(picture, path):
    dunes = read(path)
    try:
        import matplotlib
        matplotlib.use("Agg")
        import matplotlib.pyplot as plt
    except ImportError as error:
        raise ValueError("needs matplotlib (python3-matplotlib): %s" % error)
    figure, (ways, heights, speeds) = plt.subplots(1, 3, figsize=(14, 4.5))
    for number, rows in sorted(dunes.items()):
        line, = heights.plot([r["time_s"] for r in rows], [r["height_m"] for r in rows], marker=".")
        colour = line.get_color()
        ways.plot([r["crest_x_m"] for r in rows], [r["crest_y_m"] for r in rows], ".", color=colour)
        ways.annotate(str(number), (rows[-1]["crest_x_m"], rows[-1]["crest_y_m"]))
        known = [r for r in rows if r["speed_m_s"] is not None]
        speeds.plot([r["height_m"] for r in known], [r["speed_m_s"] for r in known], ".", color=colour)
    ways.set_xlabel("x [m]")
    ways.set_ylabel("y [m]")
    ways.set_aspect("equal", adjustable="datalim")
    ways.set_title("crests, by number of the dune")
    heights.set_xlabel("time [s]")
    heights.set_ylabel("height [m]")
    speeds.set_xlabel("height [m]")
    speeds.set_ylabel("speed [m/s]")
    figure.tight_layout()
    with open(picture, "wb") as file:  # desert_dunes gives a name without an extension
        figure.savefig(file, format="png", dpi=110)


if __name__ == "__main__":
    if len(sys.argv) != 3 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    try:
        main(sys.argv[1], sys.argv[2])
    except (OSError, ValueError, KeyError) as fault:
        sys.exit("plot_dunes.py: %s" % (repr(fault) if isinstance(fault, KeyError) else fault))
