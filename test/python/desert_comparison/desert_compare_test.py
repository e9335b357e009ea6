#!/usr/bin/env python3
"""desert_compare as a user runs it, on two scenarios of 64 x 64 cells.

  desert_compare_test.py DESERT_COMPARE [TEST]...
"""
import base64
import glob
import html.parser
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = ""  # path of desert_compare
PATIENCE = float(os.environ.get("DESERT_PATIENCE", "1"))
RIDGES = """# Ridges of plenty of sand.
grid: {width: 64, height: 64, cell_size: 1, boundary: periodic}
terrain: [noise: {layer: sand, low: 2, high: 4}]
wind: {speed: 3, direction_deg: 0}
run: {steps: 30}
"""
HEAPS = """# Little sand on rock & a <tag>.
grid: {width: 64, height: 64, cell_size: 1, boundary: periodic}
terrain: [cone: {layer: sand, x: 20, y: 30, height: 4, radius: 12}]
wind: {speed: 4, direction_deg: 30}
run: {steps: 20}
"""
# A module that Python imports as it starts: in the job of one run, desert_run has no end.
ENDLESS = """
import subprocess

with open("/proc/self/cmdline") as file:
    words = file.read().split("\\0")
if "%s" in words and any(word.endswith("run_one.py") for word in words):
    def call(words, *arguments, call=subprocess.call, **options):
        return call(words + (["--steps", "%d"] if words[0].endswith("desert_run") else []), *arguments, **options)
    subprocess.call = call
"""
STEPS_WITHOUT_END = 10 ** 12


def wait_until(happened, what, seconds=100):
    """At most so long (times PATIENCE)."""
    end = time.monotonic() + seconds * PATIENCE
    while not happened():
        assert time.monotonic() < end, what
        time.sleep(0.02)


class Page(html.parser.HTMLParser):
    """The texts of the tables by id, as lists of rows, and what else the tests look at."""

    def __init__(self, text):
        super().__init__()
        self.tables, self.pictures, self.films, self.links = {}, [], [], []
        self._table = self._cell = None
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        if tag == "table":
            self._table = self.tables.setdefault(attributes["id"], [])
        elif tag == "tr":
            self._table.append([])
        elif tag in ("td", "th"):
            self._table[-1].append("")
            self._cell = True
        for name in ("src", "href"):
            if name in attributes and tag != "a":
                {"img": self.pictures, "video": self.films}.get(tag, self.links).append(attributes[name])

    def handle_endtag(self, tag):
        if tag in ("td", "th"):
            self._cell = None

    def handle_data(self, data):
        if self._cell:
            self._table[-1][-1] += data


class DesertCompareCase(unittest.TestCase):
    """Two scenarios in a folder, what two workers make of them (two.html), and how desert_compare is called."""

    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory(prefix="desert_compare_")
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = temporary.name
        cls.ridges, cls.heaps = cls.write("ridges.yaml", RIDGES), cls.write("heaps.yaml", HEAPS)
        cls.compare("two.html", "--cores", "2")

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder, name)

    @classmethod
    def write(cls, name, text):
        with open(cls.path(name), "w") as file:
            file.write(text)
        return cls.path(name)

    @classmethod
    def command(cls, out, *options, scenarios=None):
        return [PROGRAM, *(scenarios or [cls.ridges, cls.heaps]), "--out", cls.path(out), "--seeds", "2",
                "--snapshots", "4", "--backend", "cpu", *options]

    @classmethod
    def compare(cls, out, *options, status=0, scenarios=None):
        done = subprocess.run(cls.command(out, *options, scenarios=scenarios), stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, universal_newlines=True, timeout=200 * PATIENCE)
        assert done.returncode == status, "status %d: %s" % (done.returncode, done.stderr)
        return done.stderr

    def text(self, out):
        with open(self.path(out), encoding="utf-8") as file:
            return file.read()

    def page(self, out):
        return Page(self.text(out))

    def refusal(self, *options, scenarios=None):
        reason = self.compare("refused.html", *options, status=2, scenarios=scenarios)
        self.assertFalse(os.path.exists(self.path("refused.html")))
        return reason

    def results(self, out):
        return sorted(glob.glob(os.path.join(self.path(out), "runs", "*", "result.json")))

    def attempts(self, out):
        """Names of the runs of which there are halves."""
        found = glob.glob(os.path.join(self.path(out), "runs", "*", "attempt-*"))
        return [os.path.basename(os.path.dirname(path)) for path in found]


class DesertCompare(DesertCompareCase):
    def test_page_has_pictures_and_the_same_table_with_one_worker_or_two(self):
        self.compare("one.html", "--cores", "1")
        self.assertEqual(*[re.sub(r'<table id="speed">.*?</table>', "", self.text(name), flags=re.DOTALL)
                           for name in ("one.html", "two.html")])
        one = self.page("one.html")
        self.assertEqual(set(one.tables), {"metrics", "balance", "speed", "runs"})
        # Two starts, two ends of the first seed, two of the second.
        self.assertEqual(len(one.pictures), 6)
        for picture in one.pictures:
            self.assertEqual(base64.b64decode(picture.split(",", 1)[1])[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(len(set(one.pictures[:3])), 3)
        self.assertEqual(one.links, [], "the page needs no other file")
        self.check_tables(one.tables)
        self.check_definitions()

    def check_definitions(self):
        """doc/science/comparing.md has each member of what desert_metrics prints."""
        with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../doc/science/comparing.md")) as file:
            defined = set(re.findall(r"`(\w+)`", file.read()))
        with open(self.results("one.runs")[0]) as file:
            members = set(json.load(file)["metrics"]["snapshots"][0])
        self.assertEqual(members - defined, set())
        sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../python"))
        from desert_comparison.catalogue import METRICS
        self.assertEqual({metric.key for metric in METRICS} - members, set())

    def check_tables(self, tables):
        head, *rows = tables["metrics"]
        self.assertEqual(head, ["metric", "ridges", "heaps"])
        cells = {re.split(r" \[|\n", row[0])[0].strip(): row[1:] for row in rows}
        mean, deviation = cells["Mean height of dunes"][0].split(" ± ")
        self.assertGreater(float(mean), 0.5)
        self.assertGreater(float(deviation), 0)
        # The cone is the same for each seed, and hardly differs at the end.
        mean, deviation = cells["Deepest sand"][1].split(" ± ")
        self.assertLess(float(mean), 4)
        self.assertLess(float(deviation), 0.1)
        # 4 m on a radius of 12 m on bare rock: at least the corners of the grid stay bare.
        self.assertGreater(float(cells["Bare ground"][1].split(" ± ")[0]), 30)
        for row in tables["balance"][1:]:
            self.assertIn("exactly nothing in all", row[-1])
            self.assertAlmostEqual(float(row[2]), float(row[3]), delta=1e-4 * float(row[2]))
        self.assertEqual([row[:3] for row in tables["runs"][1:]],
                         [["ridges", "1", "30"], ["ridges", "2", "30"], ["heaps", "1", "20"], ["heaps", "2", "20"]])
        hashes = [row[4] for row in tables["runs"][1:]]
        self.assertNotEqual(hashes[0], hashes[1])

    def test_goes_on_after_a_kill_with_what_is_left(self):
        """It is killed when all results but one are there; of the last run, its folder holds half."""
        endless = os.path.basename(os.path.dirname(self.results("two.runs")[0]))
        os.mkdir(self.path("modules"))
        self.write("modules/sitecustomize.py", ENDLESS % (endless, STEPS_WITHOUT_END))
        process = subprocess.Popen(self.command("killed.html", "--cores", "2"), stderr=subprocess.DEVNULL,
                                   env={**os.environ, "PYTHONPATH": self.path("modules")})
        wait_until(lambda: len(self.results("killed.runs")) == 3 and self.attempts("killed.runs") == [endless] and
                   self.desert_runs_in("killed.runs"), "three results, and the run without an end")
        process.send_signal(signal.SIGKILL)
        process.wait()
        wait_until(lambda: not self.processes_in("killed.runs"), "what it started ends with it")
        kept = self.results("killed.runs")
        self.assertEqual(len(kept), 3)
        before = {path: os.stat(path).st_mtime_ns for path in kept}
        self.assertEqual(self.attempts("killed.runs"), [endless])
        self.assertFalse(os.path.exists(self.path("killed.html")))
        self.compare("killed.html", "--cores", "2")
        self.assertEqual({path: os.stat(path).st_mtime_ns for path in kept}, before, "finished runs are kept")
        self.assertEqual(self.page("killed.html").tables["metrics"], self.page("two.html").tables["metrics"])
        self.assertEqual(self.attempts("killed.runs"), [])

    def processes_in(self, name):
        """Command lines of processes that name the folder."""
        found, folder = [], self.path(name)
        for path in glob.glob("/proc/[0-9]*/cmdline"):
            try:
                with open(path, "rb") as file:
                    words = file.read().decode(errors="replace").split("\0")
            except OSError:
                continue  # it has ended
            if any(folder in word for word in words):
                found.append(words)
        return found

    def desert_runs_in(self, name):
        """Those of runs, not of the pictures of starts."""
        return self.processes_in(os.path.join(name, "runs"))

    def test_a_request_to_end_says_how_to_go_on(self):
        process = subprocess.Popen(self.command("ended.html", "--steps", str(STEPS_WITHOUT_END)), stderr=subprocess.PIPE,
                                   universal_newlines=True)
        wait_until(lambda: self.desert_runs_in("ended.runs"), "a run")
        process.terminate()
        _, told = process.communicate(timeout=100 * PATIENCE)
        self.assertEqual(process.returncode, 130, told)
        self.assertIn("goes on with what is left", told)
        wait_until(lambda: not self.processes_in("ended.runs"), "what it started ends with it")
        self.assertEqual(self.results("ended.runs"), [])

    def test_only_changed_runs_are_made_anew_and_one_that_fails_is_named(self):
        shutil.copy(self.path("two.html"), self.path("again.html"))
        shutil.copytree(self.path("two.runs"), self.path("again.runs"))
        before = {path: os.stat(path).st_mtime_ns for path in self.results("again.runs")}
        self.assertEqual(len(before), 4)
        self.addCleanup(self.write, "heaps.yaml", HEAPS)
        self.write("heaps.yaml", HEAPS.replace("height: 4", "height: 5"))
        broken = os.path.dirname(next(path for path in before if "ridges-2" in path))
        os.remove(os.path.join(broken, "result.json"))
        os.remove(os.path.join(broken, "end.png"))
        os.mkdir(os.path.join(broken, "end.png"))  # is in the way of the picture
        page = self.text("again.html")
        told = self.compare("again.html", status=3)
        self.assertIn("1 of 4 runs failed", told)
        self.assertRegex(told, "%s: IsADirectoryError: .*end.png" % os.path.basename(broken))
        after = {path: os.stat(path).st_mtime_ns for path in self.results("again.runs")}
        kept = {path: time for path, time in before.items() if broken not in path}
        self.assertEqual(len(after), 5, "three are kept, and those of the changed scenario are new")
        self.assertEqual({path: after[path] for path in kept}, kept)
        self.assertEqual(self.text("again.html"), page, "a page is written of whole comparisons only")

    def test_same_start(self):
        self.compare("same.html", "--same-start", "--seeds", "1")
        pictures = self.page("same.html").pictures
        self.assertEqual(pictures[0], pictures[2], "both begin alike")
        self.assertNotEqual(pictures[1], pictures[3], "and end differently")
        coarse = self.write("coarse.yaml", HEAPS.replace("cell_size: 1", "cell_size: 2"))
        reason = self.refusal("--same-start", scenarios=[self.ridges, coarse])
        for words in ("coarse.yaml", "cells of 2 m", "cells of 1 m", "allowed"):
            self.assertIn(words, reason)

    def test_names_that_snakemake_and_utf_8_do_not_know(self):
        folder = os.path.join(self.folder, "a {folder} \\ 'of' it")
        os.makedirs(folder)
        names = ["braces {x} \\ $^$", os.fsdecode(b"no \xff utf-8")]
        scenarios = []
        for name in names:
            scenarios.append(os.path.join(folder, name + ".yaml"))
            with open(scenarios[-1], "w", encoding="utf-8") as file:
                file.write(HEAPS)
        out = os.path.join(folder, "page {y}.html")
        self.compare(out, "--seeds", "1", "--steps", "4", scenarios=scenarios)
        text = self.text(out)
        for name in ("braces {x} \\ $^$", "no \ufffd utf-8"):
            self.assertIn("<h3>%s</h3>" % name, text)

    def test_a_duration_is_refused_before_any_run(self):
        for text in ["3 fortnights", "", "0", "0.0a"]:
            self.assertIn("--duration", self.refusal("--duration", text))
        changes = self.write("changes.yaml", HEAPS.replace("{steps: 20}",
                                                           "{steps: 20, timeline: [{time: 5, set: {run.time_step: 2}}]}"))
        reason = self.refusal("--duration", "20", scenarios=[self.ridges, changes])
        for words in ("changes.yaml", "run.time_step", "allowed: --steps"):
            self.assertIn(words, reason)
        self.assertEqual(self.results("refused.runs"), [])

    def test_what_is_wrong_with_a_scenario_is_told_before_any_run(self):
        bad = self.write("bad.yaml", HEAPS.replace("height: 64", "height: -3"))
        reason = self.refusal(scenarios=[self.ridges, bad])
        for words in ("bad.yaml", "grid.height", "-3"):
            self.assertIn(words, reason)
        self.assertIn("no_such", self.refusal(scenarios=[self.ridges, "no_such"]))
        self.assertIn("called ridges", self.refusal(scenarios=[self.ridges, self.ridges]))
        self.assertIn("two or more", self.refusal(scenarios=[self.ridges]))
        os.mkfifo(self.path("pipe"))
        os.symlink(self.ridges, self.path("link"))
        for name in ("pipe", "link", "."):
            self.assertIn("a file that is new", self.compare(name, status=2))
        self.assertIn("no: unknown key", self.refusal("--set", "no.such.key=1"))
        self.assertIn("from 1 to 1000", self.refusal("--seeds", "0"))
        self.assertEqual(self.results("refused.runs"), [])


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()
