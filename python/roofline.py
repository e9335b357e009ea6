#!/usr/bin/env python3
"""Draws results of desert_bench as a roofline: milliseconds a step against the fewest bytes a cell, by process.

  python/roofline.py PICTURE.png RESULT.json...

One panel a device and grid. On the line, a process takes as long as copying that many bytes does; the number beside
a point is its share of copy speed. What lies far above the line is bound by something else than memory.
"""
import json
import math
import sys

COLOURS = ["tab:blue", "tab:orange", "tab:green", "tab:red", "tab:purple", "tab:brown", "tab:pink", "tab:olive"]
MARKERS = "osD^vP*X"


def read(path):
    with open(path) as file:
        result = json.load(file)
    if result.get("format") != "desert_bench 1":
        raise ValueError("%s: is no result of desert_bench (format 'desert_bench 1')" % path)
    return result


def panels(results):
    """Results by device and grid, in the order in which they came."""
    by_panel = {}
    for r in results:
        by_panel.setdefault((r["device"], r["width"], r["height"]), []).append(r)
    return by_panel


def run_name(r):
    return "%s, %s" % (r["scene"], r["quality"])


def draw(axes, title, results, colours, markers, plain):
    copy_ms = lambda r, size: size * r["width"] * r["height"] / r["copy_bytes_per_s"] * 1e3
    points = [(name, p) for r in results for name, p in r["processes"].items() if p["bytes_per_cell"] > 0]
    if not points:
        raise ValueError("%s: none of its processes is in the cost model" % title)
    least = 0.7 * min(p["bytes_per_cell"] for _, p in points)
    most = 1.4 * max([p["bytes_per_cell"] for _, p in points] + [r["bytes_per_cell"] for r in results])
    for n, r in enumerate(results):  # each run measured the copy itself
        axes.plot([least, most], [copy_ms(r, least), copy_ms(r, most)], color="black", linewidth=1,
                  label="at copy speed", alpha=1 if n == 0 else 0.25)
        steps = {"whole step": {"ms": r["ms_per_step"], "bytes_per_cell": r["bytes_per_cell"],
                                "share_of_copy": r["share_of_copy"]}}
        for name, p in list(r["processes"].items()) + list(steps.items()):
            if p["bytes_per_cell"] <= 0:
                continue
            axes.plot(p["bytes_per_cell"], p["ms"], markers[run_name(r)], color=colours[name], markersize=7)
            axes.annotate("%.0f %%" % (100 * p["share_of_copy"]), (p["bytes_per_cell"], p["ms"]), fontsize=7,
                          textcoords="offset points", xytext=(6, 3))
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(least, most)
    ticks = [t for t in (10, 15, 20, 30, 50, 70, 100, 150, 200, 300, 500, 1000) if least <= t <= most]
    axes.set_xticks([], minor=True)
    axes.set_xticks(ticks)
    axes.set_xticklabels([str(t) for t in ticks])
    axes.yaxis.set_major_formatter(plain)
    axes.set_title(title, fontsize=9)
    axes.set_xlabel("fewest bytes a cell and step")
    axes.set_ylabel("ms a step")
    axes.grid(True, which="both", alpha=0.25)


def legend(figure, axes, colours, markers, Line2D):
    entries = [Line2D([], [], marker="o", color=c, linestyle="", label=name) for name, c in colours.items()]
    entries += [Line2D([], [], marker=m, color="grey", linestyle="", label=name) for name, m in markers.items()]
    entries += axes.get_legend_handles_labels()[0][:1]
    figure.legend(handles=entries, loc="lower center", ncol=min(6, len(entries)), fontsize=8, frameon=False)


def main(picture, paths):
    results = [read(path) for path in paths]
    try:
        import matplotlib
        matplotlib.use("Agg")
        import matplotlib.pyplot as plt
        from matplotlib.lines import Line2D
        from matplotlib.ticker import FuncFormatter
    except ImportError as error:
        raise ValueError("needs matplotlib (python3-matplotlib): %s" % error)
    by_panel = panels(results)
    names = list(dict.fromkeys(name for r in results for name, p in r["processes"].items() if p["bytes_per_cell"]))
    colours = {name: COLOURS[n % len(COLOURS)] for n, name in enumerate(names)}
    colours["whole step"] = "black"
    markers = {name: MARKERS[n % len(MARKERS)] for n, name in enumerate(dict.fromkeys(map(run_name, results)))}
    columns = min(3, len(by_panel))
    rows = math.ceil(len(by_panel) / columns)
    figure, grid = plt.subplots(rows, columns, figsize=(max(7, 5 * columns), 4.2 * rows + 0.75), squeeze=False)
    for axes in grid.flat[len(by_panel):]:
        axes.axis("off")
    for axes, ((device, width, height), runs) in zip(grid.flat, by_panel.items()):
        title = "%s\n%d x %d cells, copies %.0f GB/s" % (device, width, height, runs[0]["copy_bytes_per_s"] * 1e-9)
        draw(axes, title, runs, colours, markers, FuncFormatter(lambda ms, _: "%g" % ms))
    bottom = 0.75 / figure.get_figheight()
    figure.tight_layout(rect=(0, bottom, 1, 1))
    legend(figure, grid.flat[0], colours, markers, Line2D)
    with open(picture, "wb") as file:  # desert_bench gives a name without an extension
        figure.savefig(file, format="png", dpi=110)


if __name__ == "__main__":
    if len(sys.argv) < 3 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    try:
        main(sys.argv[1], sys.argv[2:])
    except (OSError, ValueError, KeyError) as fault:
        sys.exit("roofline.py: %s" % (repr(fault) if isinstance(fault, KeyError) else fault))
