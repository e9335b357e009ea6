#!/usr/bin/env python3
"""Changes one law at a time and shows which test notices; a change that none notices is a gap in the tests.

    test/mutations/run.py [--only NAME...] [--scratch DIR] [--workers N]    writes test/mutations/table.md
    test/mutations/run.py --list
    test/mutations/run.py --check      each text of the table is found exactly once in the tree; nothing is built

mutations.py has the table. Each mutation is applied to a copy of the tree, which is built for the CPU without ROS; each
of N workers (as many as processors) has one. The tests that are expected to notice run first, then all of the programs in
PROGRAMS, up to the first failure. Tests have to pass without any mutation first. --only runs the named ones, and leaves the
other rows of table.md as they are. --scratch keeps copies and builds for the next call. A mutation that is noticed as
expected takes half a minute; one in a header of many sources takes many, and so does one that survives.
Exit status: 0; 1 if a mutation survives; 2 for a table that does not fit the tree, or a tree that does not build or
whose tests fail without a mutation.
"""
import argparse
import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import threading

from mutations import MUTATIONS

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
TABLE = HERE / "table.md"
# In this order: the quickest first.
PROGRAMS = ("kernels_unit", "core_unit", "metrics_unit", "rover_unit", "core_analytic", "io_unit", "export_unit", "render_unit",
            "kernels_analytic", "kernels_property", "core_property")
SURVIVED = "**SURVIVED**"
NOT_RUN = "not run"
LIMIT = 900  # s for a test program: a mutation may make a loop endless


class Failure(Exception):
    """What ends the run: the table or the tree is at fault, not a test."""


def faults_of_the_table():
    faults = []
    names = [m.name for m in MUTATIONS]
    faults += ["%s: two mutations have this name" % n for n in sorted(set(names)) if names.count(n) > 1]
    for m in MUTATIONS:
        path = ROOT / m.file
        found = path.read_text().count(m.before) if path.is_file() else None
        if found is None:
            faults.append("%s: there is no file %s" % (m.name, m.file))
        elif found != 1:
            faults.append("%s: its text is found %d times in %s, not once: %s" % (m.name, found, m.file, m.before))
        if m.before == m.after:
            faults.append("%s: it changes nothing" % m.name)
        if not re.fullmatch("(%s) [^ ]+" % "|".join(PROGRAMS), m.killer):
            faults.append("%s: its killer is not 'PROGRAM FILTER': %s" % (m.name, m.killer))
    return faults


class Copy:
    """A copy of the tree and its build."""

    def __init__(self, scratch):
        self.tree, self.build, self.jobs = scratch / "tree", scratch / "build", 1

    def configure(self):
        listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                                check=True, stdout=subprocess.PIPE).stdout
        files = {os.fsdecode(f) for f in listed.split(b"\0") if f and (ROOT / os.fsdecode(f)).is_file()}
        for name in files:
            self.restore(name)
        for old in self.tree.rglob("*"):
            if old.is_file() and str(old.relative_to(self.tree)) not in files:
                old.unlink()
        launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
        # Mutations leave variables unused. A library that is built anew does not link again what uses it, because its
        # interface is the same. What a mutation changes is compiled for a test or two: alone, and without what makes
        # the compiler slow.
        self.run_tool(["cmake", "-G", "Unix Makefiles", "-S", self.tree, "-B", self.build,
                       "-DDESERT_WITH_ROS=OFF", "-DDESERT_WITH_CUDA=OFF", "-DDESERT_WERROR=OFF",
                       "-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_CXX_FLAGS_DEBUG=-O1 -DNDEBUG",
                       "-DDESERT_UNITY_BUILD=OFF", "-DCMAKE_LINK_DEPENDS_NO_SHARED=ON"] + launcher)

    def restore(self, name):
        """Copies a file of the tree; one that is as it was keeps its time, so that make leaves it alone."""
        source, target = ROOT / name, self.tree / name
        if target.is_file() and target.read_bytes() == source.read_bytes():
            return
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(source, target)
        shutil.copymode(source, target)

    def apply(self, mutation):
        path = self.tree / mutation.file
        path.write_text(path.read_text().replace(mutation.before, mutation.after))

    def make(self, target):
        self.run_tool(["cmake", "--build", self.build, "-j", str(self.jobs), "--target", target])

    def make_without_the_libraries_between(self, program):
        """Builds a program of kernels_*_tests and the library that it tests. The libraries between the two include the
        headers of kernels/, too, but the laws that run are those in the library or in the program."""
        for target in ("desert_physics", "desert_test_support", program):
            self.make(target + "/fast")

    @staticmethod
    def run_tool(command):
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, encoding="utf-8",
                              errors="replace")
        if done.returncode != 0:
            errors = [line for line in done.stdout.splitlines() if "error" in line.lower()]
            raise Failure("%s failed:\n%s" % (" ".join(map(str, command)), "\n".join(errors[:5] or [done.stdout])))

    def failing_test(self, program, test_filter):
        """The first test that fails, or None."""
        command = [self.build / "bin" / (program + "_tests"), "--gtest_filter=%s-*/cuda" % test_filter]
        try:
            done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, encoding="utf-8",
                                  errors="replace", timeout=LIMIT, env=dict(os.environ, GTEST_FAIL_FAST="1"))
            text, status = done.stdout, done.returncode
        except subprocess.TimeoutExpired as expired:
            text, status = (expired.stdout or b"").decode("utf-8", "replace"), "no end"
        begun = re.findall(r"^\[ RUN      \] (\S+)", text, re.M)
        if not begun:
            raise Failure("%s_tests has no test %s" % (program, test_filter))
        if status == 0:
            return None
        failed = re.findall(r"^\[  FAILED  \] ([^\s,]+)", text, re.M)
        name = failed[0] if failed else "%s (status %s)" % (begun[-1], status)
        return "%s.%s" % (program.rpartition("_")[2], re.sub(r"^On/|/cpu\b", "", name))


def killer_of(copy, mutation):
    """The test that notices a mutation that is applied, or None."""
    expected = mutation.killer.split(" ")
    if mutation.file.startswith("kernels/") and expected[0].startswith("kernels_"):
        copy.make_without_the_libraries_between(expected[0] + "_tests")
        failing = copy.failing_test(*expected)
        if failing:
            return failing
    # Always the whole program: one that was made for the mutation before may still have that one compiled in.
    for program, tests in [expected] + [(program, "*") for program in PROGRAMS]:
        copy.make(program + "_tests")
        failing = copy.failing_test(program, tests)
        if failing:
            return failing
    return None


def require_passing_tests(copy, mutations):
    for program in PROGRAMS:
        copy.make(program + "_tests")
        failing = copy.failing_test(program, "*")
        if failing:
            raise Failure("without any mutation, %s fails" % failing)
    for mutation in mutations:
        copy.failing_test(*mutation.killer.split(" "))  # fails where there is no such test


def rows_of_table():
    if not TABLE.is_file():
        return {}
    rows = re.findall(r"^\| `(\w+)` \|.* \| ([^|]+ \| [^|]+) \|$", TABLE.read_text(), re.M)
    return {name: tuple(row.split(" | ")) for name, row in rows}


def write_table(killers):
    lines = ["# Mutations", "",
             "Written by `test/mutations/run.py`: each row changes one law, and names the first test that failed then, and the",
             "commit at which that was tried last.", "",
             "| mutation | file | what it breaks | noticed by | at |", "|---|---|---|---|---|"]
    for m in MUTATIONS:
        lines.append("| `%s` | %s | %s | %s | %s |" % (m.name, m.file, m.law, *killers.get(m.name, (NOT_RUN, "-"))))
    TABLE.write_text("\n".join(lines) + "\n")


class Run:
    """The mutations, by as many workers as there are copies. A worker takes all of a file, so that it is built anew once
    less for each."""

    def __init__(self, mutations):
        self.mutations, self.lock, self.killers = mutations, threading.Lock(), rows_of_table()
        self.files = list(dict.fromkeys(m.file for m in mutations))
        self.commit = subprocess.run(["git", "-C", ROOT, "rev-parse", "--short", "HEAD"], check=True, stdout=subprocess.PIPE,
                                     text=True).stdout.strip()

    def work(self, copy):
        for program in sorted({m.killer.split(" ")[0] for m in self.mutations}):
            copy.make(program + "_tests")  # with all that the targets /fast of a mutation take for granted
        while True:
            with self.lock:
                if not self.files:
                    return
                file = self.files.pop(0)
            for mutation in self.mutations:
                if mutation.file == file:
                    self.note(mutation, self.killer_of(copy, mutation))

    def killer_of(self, copy, mutation):
        copy.apply(mutation)
        try:
            return killer_of(copy, mutation)
        except Failure as failure:
            self.files.clear()  # the others end, too
            raise Failure("%s: %s" % (mutation.name, failure))
        finally:
            copy.restore(mutation.file)

    def note(self, mutation, killer):
        with self.lock:
            self.killers[mutation.name] = "`%s`" % killer if killer else SURVIVED, self.commit
            print("%-32s %s" % (mutation.name, killer or "SURVIVED"), flush=True)
            write_table(self.killers)


def run(mutations, scratch, workers):
    copies = [Copy(scratch / str(n)) for n in range(workers)]
    for copy in copies:
        copy.configure()
    copies[0].jobs = os.cpu_count()  # the others have nothing to do yet
    require_passing_tests(copies[0], mutations)
    copies[0].jobs = 1
    of = Run(mutations)
    with concurrent.futures.ThreadPoolExecutor(workers) as pool:
        for ended in [pool.submit(of.work, copy) for copy in copies]:
            ended.result()
    return 1 if any(of.killers[m.name][0] == SURVIVED for m in mutations) else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="+", metavar="NAME", default=[])
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--scratch", type=pathlib.Path, metavar="DIR")
    parser.add_argument("--workers", type=int, default=os.cpu_count())
    options = parser.parse_args()
    if options.list:
        for m in MUTATIONS:
            print("%-32s %s\n%34s%s" % (m.name, m.file, "", m.law))
        return 0
    faults = faults_of_the_table()
    by_name = {m.name: m for m in MUTATIONS}
    faults += ["--only: there is no mutation %s" % name for name in options.only if name not in by_name]
    if faults:
        raise Failure("\n".join(faults))
    if options.check:
        return 0
    mutations = [by_name[name] for name in options.only] or MUTATIONS
    if options.scratch:
        return run(mutations, options.scratch.resolve(), options.workers)
    with tempfile.TemporaryDirectory(prefix="desert_mutations_") as scratch:
        return run(mutations, pathlib.Path(scratch), options.workers)


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Failure as failure:
        print(failure, file=sys.stderr)
        sys.exit(2)
