"""Charts of metrics over time, as SVG of matplotlib."""
import io
import re

import matplotlib
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure

COLOURS = ["#b5541c", "#1f6f8b", "#5b7f2b", "#7a4b94", "#c08a00", "#444444"]
CHARTED = ("mean_height_m", "wavelength_m", "rms_relief_m", "terminations_per_m")


def chart(plan, results, metric, time_unit):
    """A line for each seed of each scenario, and a thick one for their mean."""
    unit, seconds = time_unit
    figure = Figure(figsize=(5.2, 2.7))
    FigureCanvasSVG(figure)
    axes = figure.add_axes((0.13, 0.17, 0.84, 0.76))
    for n, scenario in enumerate(plan["scenarios"]):
        colour, courses = COLOURS[n % len(COLOURS)], []
        for key, run in plan["runs"].items():
            if run["name"] == scenario["name"]:
                snapshots = results[key]["metrics"]["snapshots"]
                courses.append([(s["time_s"] / seconds, s[metric.key]) for s in snapshots])
                draw(axes, courses[-1], metric.scale, color=colour, linewidth=0.6, alpha=0.45)
        means = [(times[0][0], sum(v for _, v in times) / len(times)) for times in zip(*courses)
                 if all(v is not None for _, v in times)]
        draw(axes, means, metric.scale, color=colour, linewidth=2, label=scenario["label"].replace("$", r"\$"))
    axes.set_xlabel("simulated time [%s]" % unit)
    axes.set_ylabel("[%s]" % metric.unit if metric.unit else "")
    axes.set_ylim(bottom=0)
    axes.grid(alpha=0.25)
    axes.legend(frameon=False, fontsize="small")
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    return svg_of(figure, metric.key)


def draw(axes, course, scale, **style):
    known = [(t, v * scale) for t, v in course if v is not None]
    axes.plot([t for t, _ in known], [v for _, v in known], **style)


def svg_of(figure, salt):
    """The picture as an element of HTML, the same text each time."""
    with matplotlib.rc_context({"svg.hashsalt": salt, "svg.fonttype": "none", "font.family": "sans-serif"}):
        out = io.StringIO()
        figure.savefig(out, format="svg", metadata={"Date": None, "Creator": None}, transparent=True)
    return re.sub(r"^.*?(?=<svg)", "", out.getvalue(), flags=re.DOTALL)
