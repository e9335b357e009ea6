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
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = ""  # path of desert_compare
PATIENCE = int(os.environ.get("DESERT_PATIENCE", "1"))
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
    """Two scenarios in a folder, and how desert_compare is called."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="desert_compare_")
        self.addCleanup(temporary.cleanup)
        self.folder = temporary.name
        self.ridges, self.heaps = self.write("ridges.yaml", RIDGES), self.write("heaps.yaml", HEAPS)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w") as file:
            file.write(text)
        return self.path(name)

    def command(self, out, *options, scenarios=None):
        return [PROGRAM, *(scenarios or [self.ridges, self.heaps]), "--out", self.path(out), "--seeds", "2",
                "--snapshots", "4", "--backend", "cpu", *options]

    def compare(self, out, *options, status=0, scenarios=None):
        done = subprocess.run(self.command(out, *options, scenarios=scenarios), stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE, universal_newlines=True, timeout=200 * PATIENCE)
        self.assertEqual(done.returncode, status, done.stderr)
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


class DesertCompare(DesertCompareCase):
    def test_page_has_pictures_and_the_same_table_with_one_worker_or_two(self):
        self.compare("one.html", "--cores", "1")
        self.compare("two.html", "--cores", "2")
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
        """doc/comparing.md has each member of what desert_metrics prints."""
        with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../doc/comparing.md")) as file:
            defined = set(re.findall(r"`(\w+)`", file.read()))
        with open(self.results("one.runs")[0]) as file:
            members = set(json.load(file)["metrics"]["snapshots"][0])
        self.assertEqual(members - defined, set())
        sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../python"))
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
        """The first run is killed when one result is there; another run's folder holds half of one."""
        options = ("--cores", "1", "--steps", "200")
        process = subprocess.Popen(self.command("killed.html", *options), stderr=subprocess.DEVNULL)
        deadline = time.monotonic() + 100 * PATIENCE
        while not self.results("killed.runs") and time.monotonic() < deadline:
            time.sleep(0.02)
        process.send_signal(signal.SIGKILL)
        process.wait()
        time.sleep(1)  # what it started ends with it
        kept = self.results("killed.runs")
        self.assertGreaterEqual(len(kept), 1)
        self.assertLess(len(kept), 4)
        before = {path: os.stat(path).st_mtime_ns for path in kept}
        self.assertFalse(os.path.exists(self.path("killed.html")))
        self.assertEqual(self.processes_in(self.path("killed.runs")), [])
        self.compare("killed.html", *options)
        self.assertEqual({path: os.stat(path).st_mtime_ns for path in kept}, before, "finished runs are kept")
        self.compare("whole.html", *options)
        self.assertEqual(self.page("killed.html").tables["metrics"], self.page("whole.html").tables["metrics"])
        self.assertEqual(glob.glob(os.path.join(self.path("killed.runs"), "runs", "*", "attempt-*")), [])

    @staticmethod
    def processes_in(folder):
        """Command lines of processes that name the folder."""
        found = []
        for path in glob.glob("/proc/[0-9]*/cmdline"):
            try:
                with open(path, "rb") as file:
                    words = file.read().decode(errors="replace").split("\0")
            except OSError:
                continue  # it has ended
            if any(folder in word for word in words):
                found.append(words)
        return found

    def test_a_request_to_end_says_how_to_go_on(self):
        process = subprocess.Popen(self.command("ended.html", "--steps", "100000"), stderr=subprocess.PIPE,
                                   universal_newlines=True)
        deadline = time.monotonic() + 60 * PATIENCE
        logs = os.path.join(self.path("ended.runs"), "runs", "*", "log.txt")
        while not glob.glob(logs) and time.monotonic() < deadline:
            time.sleep(0.05)
        process.terminate()
        _, told = process.communicate(timeout=30 * PATIENCE)
        self.assertEqual(process.returncode, 130, told)
        self.assertIn("goes on with what is left", told)
        time.sleep(0.5)
        self.assertEqual(self.processes_in(self.path("ended.runs")), [])
        self.assertEqual(self.results("ended.runs"), [])

    def test_only_changed_runs_are_made_anew_and_one_that_fails_is_named(self):
        self.compare("again.html")
        before = {path: os.stat(path).st_mtime_ns for path in self.results("again.runs")}
        self.assertEqual(len(before), 4)
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

    def test_what_is_wrong_with_a_scenario_is_told_before_any_run(self):
        bad = self.write("bad.yaml", HEAPS.replace("height: 64", "height: -3"))
        reason = self.refusal(scenarios=[self.ridges, bad])
        for words in ("bad.yaml", "grid.height", "-3"):
            self.assertIn(words, reason)
        self.assertIn("no_such", self.refusal(scenarios=[self.ridges, "no_such"]))
        self.assertIn("called ridges", self.refusal(scenarios=[self.ridges, self.ridges]))
        self.assertIn("two or more", self.refusal(scenarios=[self.ridges]))
        self.assertIn("no: unknown key", self.refusal("--set", "no.such.key=1"))
        self.assertIn("from 1 to 1000", self.refusal("--seeds", "0"))
        self.assertEqual(self.results("refused.runs"), [])


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()
