#!/usr/bin/env python3
"""Repeats ctest under load and random stops; scripts/flakes calls it and says what the options are."""
import argparse
import collections
import contextlib
import datetime
import json
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import threading

STOPS = (0.02, 0.1, 0.5, 2)  # [s] for which a process stands still
PAUSE = 0.3                  # [s], at most, between two of them
HELD = "/tmp/desert_sim_held.%d"  # is there while a test itself keeps this process stopped
LOGGED = re.compile(r"^\d+/\d+ (?:Testing|Test): (\S+)\n(.*?)(?=^\d+/\d+ Testing: |\Z)", re.M | re.S)


def descendants(root):
    """Processes that a process has started, and those that they have."""
    children = collections.defaultdict(list)
    for entry in os.listdir("/proc"):
        if entry.isdigit():
            try:
                with open("/proc/%s/stat" % entry) as file:
                    children[int(file.read().rpartition(")")[2].split()[1])].append(int(entry))
            except OSError:
                pass  # it has ended since
    found, todo = [], [root]
    while todo:
        process = todo.pop()
        found += children[process]
        todo += children[process]
    return found


class Stops(threading.Thread):
    """Stops processes below a process one after the other, each for a while."""

    def __init__(self, root):
        super().__init__(daemon=True)
        self.root, self.count, self.over = root, 0, threading.Event()

    def run(self):
        while not self.over.wait(random.uniform(0, PAUSE)):
            processes = descendants(self.root)
            if not processes:
                continue
            self.stop(random.choice(processes))

    def stop(self, process):
        """Stops a process for a while, unless a test holds it: test/support/ros/child_process.hpp, node_tests.held()."""
        held = HELD % process
        if os.path.exists(held):
            return
        with contextlib.suppress(ProcessLookupError):  # it has ended since
            os.kill(process, signal.SIGSTOP)
            self.count += 1
            self.over.wait(random.choice(STOPS))
            if not os.path.exists(held):
                os.kill(process, signal.SIGCONT)
            while os.path.exists(held):  # since a moment ago: it is the test that continues it
                os.kill(process, signal.SIGSTOP)
                if os.path.exists(held):
                    break
                os.kill(process, signal.SIGCONT)

    def end(self):
        self.over.set()
        self.join()


def tests_of(build, options):
    listed = subprocess.run(["ctest", "--show-only=json-v1"] + options, cwd=build, check=True, stdout=subprocess.PIPE)
    return [test["name"] for test in json.loads(listed.stdout)["tests"]]


def run_round(build, options, logs):
    """Names of the tests that failed, whose logs are in the folder `logs` then; how often a process was stopped."""
    logs.mkdir(parents=True)
    failed_list = build / "Testing" / "Temporary" / "LastTestsFailed.log"
    if failed_list.exists():
        failed_list.unlink()  # of another run
    with open(logs / "ctest.txt", "w") as output:
        run = subprocess.Popen(["ctest", "--output-on-failure"] + options, cwd=build, stdout=output, stderr=subprocess.STDOUT)
        stops = Stops(run.pid)
        stops.start()
        try:
            status = run.wait()
        except KeyboardInterrupt:
            for process in descendants(run.pid) + [run.pid]:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(process, signal.SIGKILL)
            raise
        finally:
            stops.end()
    failed = []
    if status:
        failed = [line.partition(":")[2].strip() for line in failed_list.read_text().splitlines()] if failed_list.exists() else []
        if not failed:
            sys.exit("ctest ended with status %d, and names no failed test: see %s" % (status, logs / "ctest.txt"))
        whole = (build / "Testing" / "Temporary" / "LastTest.log").read_text(errors="replace")
        text_of = dict(LOGGED.findall(whole))
        for name in failed:
            (logs / (re.sub(r"[^\w.-]", "_", name) + ".txt")).write_text(text_of.get(name, "ctest has kept no log\n"))
    return failed, stops.count


def add_row(table, commit, tests, options, rounds, failures):
    """Adds a row to a table, which is begun where there is none."""
    if not table.exists():
        table.write_text("# Repeated tests\n\nRows of `scripts/flakes --table test/flakes.md`: tests that were repeated beside busy "
                         "neighbours, while their processes were\nstopped and continued at random. Two processors.\n\n"
                         "| date | commit | tests | rounds | neighbours | failures |\n|---|---|---|---|---|---|\n")
    said = ", ".join("%s %d" % item for item in sorted(failures.items())) or "none"
    with open(table, "a") as file:
        file.write("| %s | %s | %d: `%s` | %d | %d | %s |\n" % (
            datetime.date.today(), commit, len(tests), " ".join(options.ctest).replace("|", "\\|") or "all", rounds, options.load, said))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", type=pathlib.Path, required=True)
    parser.add_argument("--rounds", type=int, default=10)
    parser.add_argument("--load", type=int, default=4)
    parser.add_argument("--table", type=pathlib.Path)
    options, options.ctest = parser.parse_known_args()
    selection = options.ctest + ["-LE", "^(timing|lint)$"]
    tests = tests_of(options.build, selection)
    if not tests:
        sys.exit("no test fits %s" % " ".join(options.ctest))
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=pathlib.Path(__file__).parent,
                            stdout=subprocess.PIPE, text=True).stdout.strip() or "unknown"
    logs = options.build / "flakes"
    shutil.rmtree(logs, ignore_errors=True)
    # Tests often wait; neighbours never do.
    jobs = ["-j", str((os.cpu_count() or 1) + 1 + options.load)]
    # Everything takes as many times longer as there are neighbours to a processor.
    os.environ.setdefault("DESERT_PATIENCE", str(1 + options.load))
    for end in (signal.SIGINT, signal.SIGTERM):  # what was found until then is shown
        signal.signal(end, signal.default_int_handler)
    load = options.load and subprocess.Popen(["stress-ng", "--cpu", str(options.load), "--quiet"])
    failures, rounds = collections.Counter(), 0
    try:
        while rounds < options.rounds:
            failed, stops = run_round(options.build, selection + jobs, logs / ("round_%02d" % (rounds + 1)))
            if load and load.poll() is not None:
                sys.exit("stress-ng has ended with status %d: these tests had no neighbours" % load.returncode)
            failures.update(failed)
            rounds += 1
            print("round %d of %d: %d tests, %d stops, %d failed%s" % (
                rounds, options.rounds, len(tests), stops, len(failed), "".join("\n  " + name for name in failed)), flush=True)
    except KeyboardInterrupt:
        print("interrupted in round %d" % (rounds + 1))
    finally:
        if load:
            load.terminate()
            load.wait()
    for name, count in failures.most_common():
        print("%4d of %d  %s" % (count, rounds, name))
    if options.table and rounds:
        add_row(options.table, commit, tests, options, rounds, failures)
    print("%d failures in %d rounds of %d tests; logs are in %s" % (sum(failures.values()), rounds, len(tests), logs))
    return 1 if failures or rounds < options.rounds else 0


if __name__ == "__main__":
    sys.exit(main())
