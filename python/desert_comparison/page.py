"""The page of a comparison: one file of HTML, with everything in it."""
import base64
import io
import math
import os

import jinja2
from PIL import Image

from . import scatter
from .catalogue import metrics_for, time_unit, value_of
from .charts import CHARTED, COLOURS, chart

MOST_PIXELS = {"large": 640, "small": 220}  # of the long side of pictures


def data_url(kind, data):
    return "data:%s;base64,%s" % (kind, base64.b64encode(data).decode("ascii"))


def picture(path, size):
    """A PNG file as a data URL, made smaller if it is larger than that."""
    with Image.open(path) as image:
        scale = MOST_PIXELS[size] / max(image.size)
        if scale >= 1:
            with open(path, "rb") as file:
                return data_url("image/png", file.read())
        out = io.BytesIO()
        size = tuple(max(1, round(n * scale)) for n in image.size)
        image.convert("RGB").resize(size, Image.LANCZOS).save(out, "PNG", optimize=True)
        return data_url("image/png", out.getvalue())


def film(path):
    with open(path, "rb") as file:
        return data_url("video/mp4", file.read())


def length_of_time(seconds):
    for unit, name in ((31557600.0, "years"), (86400.0, "days"), (3600.0, "hours")):
        if seconds >= 2 * unit:
            return "%.4g %s" % (seconds / unit, name)
    return "%.6g s" % seconds


class Page:
    def __init__(self, plan, results):
        self.plan, self.results = plan, results
        longest = max(r["summary"]["sim_time_s"] for r in results.values())
        self.metrics, self.time_unit = metrics_for(longest), time_unit(longest)

    def runs(self, scenario):
        """The results of a scenario by seed."""
        return [self.results[key] for key, run in self.plan["runs"].items() if run["name"] == scenario["name"]]

    def home(self, result, name):
        return os.path.join(self.plan["work"], "runs", result["key"], name)

    def scenario(self, n, s):
        runs, start = self.runs(s), s["start"]
        first = runs[0]
        return {
            "label": s["label"], "comment": s["comment"], "colour": COLOURS[n % len(COLOURS)],
            "width": start["width"] * start["cell_size_m"], "height": start["height"] * start["cell_size_m"],
            "cell": start["cell_size_m"], "boundary": start["boundary"], "steps": first["summary"]["steps"],
            "time": length_of_time(first["summary"]["sim_time_s"]), "seed": first["seed"],
            "start": picture(start["picture"], "large"), "end": picture(self.home(first, "end.png"), "large"),
            "others": [(r["seed"], picture(self.home(r, "end.png"), "small")) for r in runs[1:]],
            "film": film(self.home(first, "film.mp4")) if os.path.exists(self.home(first, "film.mp4")) else None,
        }

    def table(self):
        """Rows of the metrics that at least one run has, at the end of the runs."""
        rows = []
        for m in self.metrics:
            cells = []
            for s in self.plan["scenarios"]:
                last = [value_of(r["metrics"]["snapshots"], m.key) for r in self.runs(s)]
                cells.append([None if v is None else v * m.scale for v in last])
            if any(v is not None for cell in cells for v in cell):
                rows.append((m, [scatter.text(cell, m.kind) for cell in cells]))
        return rows

    def balance(self):
        """For each scenario and material that it has: mean volumes, and the greatest residual of all runs."""
        rows = []
        for s in self.plan["scenarios"]:
            runs = self.runs(s)
            for material, volumes in runs[0]["summary"]["volume_m3"].items():
                if not any(volumes.values()):
                    continue
                mean = {name: scatter.linear([r["summary"]["volume_m3"][material][name] for r in runs])[0]
                        for name in ("initial", "final", "in", "out")}
                residual = max((r["summary"]["mass_residual"][material] for r in runs), key=abs)
                rows.append((s["label"], material.replace("_", " "), mean, residual, len(runs)))
        return rows

    def speed(self):
        """Wall time per step, which differs from run to run and machine to machine."""
        rows = []
        for s in self.plan["scenarios"]:
            runs = [r["summary"] for r in self.runs(s)]
            cells = runs[0]["width"] * runs[0]["height"]
            times = [r["ms_per_step"]["total"] for r in runs]
            devices = sorted({"%s: %s" % (r["backend"], r["device"]) for r in runs})
            rate = cells / max(scatter.linear(times)[0], 1e-9) / 1e3
            rows.append((s["label"], scatter.text(times), "%.*f" % (max(0, 1 - math.floor(math.log10(rate))), rate),
                         runs[0]["threads"], "; ".join(devices)))
        return rows

    def charts(self):
        return [(m, chart(self.plan, self.results, m, self.time_unit)) for m in self.metrics
                if m.key in CHARTED and any(s[m.key] is not None for r in self.results.values()
                                            for s in r["metrics"]["snapshots"])]

    def differences(self):
        """In which respects the scenarios of this page are not alike."""
        starts = [s["start"] for s in self.plan["scenarios"]]
        times = {r["summary"]["sim_time_s"] for r in self.results.values()}
        grids = {(s["width"], s["height"], s["cell_size_m"]) for s in starts}
        return {"grids": len(grids) > 1, "times": len(times) > 1}

    def text(self):
        environment = jinja2.Environment(loader=jinja2.FileSystemLoader(os.path.dirname(os.path.realpath(__file__))),
                                         autoescape=True, trim_blocks=True, lstrip_blocks=True,
                                         undefined=jinja2.StrictUndefined)
        return environment.get_template("page.html").render(
            scenarios=[self.scenario(n, s) for n, s in enumerate(self.plan["scenarios"])], plan=self.plan,
            table=self.table(), balance=self.balance(), speed=self.speed(), charts=self.charts(),
            differences=self.differences(), runs=list(self.results.values()))


def page_of(plan, results):
    """The text of the page. `results`: by key, as run_one makes them."""
    return Page(plan, results).text()
