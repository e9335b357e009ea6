#!/usr/bin/env python3
"""Compares results of desert_bench with a stored baseline, by ratios, so that another machine can be compared too.

  test/bench/compare.py [--tolerance 0.15] [--require-all] BASELINE.json RESULT.json...
  test/bench/compare.py --write [--commit HASH] BASELINE.json RESULT.json...

A time is divided by what a copy of 100 bytes a cell took in the same run. A row fails if
  - the whole step is slower than the baseline's by more than the tolerance (15 %), or a process that takes a
    tenth of it or more by twice that (not on grids so small that one by one they wait for the host);
  - a figure of the residual has grown: by more than a tenth of it and 0.002 (shares) or 0.001 (mean excess), or to more
    than twice the largest excess, which is one cell's and as different between two seeds;
  - sand was lost, or memory a cell has grown by more than 1 %.
Results are compared with the record of the same scene, grid, quality, backend, threads and steps. Those that have
none are listed; with --require-all they fail. --write puts results in the place of their records.
Exit status: 0; 1 if a row fails; 2 for input that it cannot read.
"""
import argparse
import json
import os
import subprocess
import sys

FORMAT = "desert_bench baseline 1"
KEY = ("scene", "width", "height", "quality", "backend", "threads", "warm_up_steps", "steps")
KEPT = KEY + ("cell_size_m", "device", "ms_per_step", "copy_bytes_per_s", "residual", "fine_sweeps", "sand_lost_quanta",
              "memory_bytes_per_cell", "processes")
WORTH_LOOKING = 0.1  # share of a step from which a process counts
ONE_BY_ONE = 1.2     # times a step that processes may take one by one: on small grids it is the host that they wait for
GROWTH = {"share_over_1e-3": (1.1, 0.002), "share_over_1e-2": (1.1, 0.002), "mean_excess": (1.1, 0.001),
          "largest_excess": (2, 0.02)}  # times what it was, and more


def read(path, form):
    with open(path) as file:
        data = json.load(file)
    if not isinstance(data, dict) or data.get("format") != form:
        raise ValueError("%s: its format is not '%s'" % (path, form))
    return data


def key_of(record):
    return tuple(record[k] for k in KEY)


def name_of(record):
    threads = ", %d threads" % record["threads"] if record["backend"] == "cpu" else ""
    return "%s %dx%d %s %s%s, steps %d+%d" % (record["scene"], record["width"], record["height"], record["quality"],
                                              record["backend"], threads, record["warm_up_steps"], record["steps"])


def in_copies(record, ms):
    """A time as a multiple of what copying 100 bytes a cell takes there."""
    return ms * 1e-3 * record["copy_bytes_per_s"] / (100.0 * record["width"] * record["height"])


def faults_of(new, old, tolerance):
    """What is worse than in the baseline, and the ratio of the whole steps."""
    faults = []

    def slower(what, ms, was, most):
        ratio = in_copies(new, ms) / in_copies(old, was)
        if not ratio <= 1 + most:  # nor NaN
            faults.append("%s takes %.2f times as long (%.4f ms, baseline %.4f ms on %s)" % (
                what, ratio, ms, was, old["device"]))
        return ratio

    ratio = slower("a step", new["ms_per_step"], old["ms_per_step"], tolerance)
    whole = sum(p["ms"] for p in new["processes"].values())
    for name, process in new["processes"].items() if whole <= ONE_BY_ONE * new["ms_per_step"] else ():
        if name in old["processes"] and process["ms"] >= WORTH_LOOKING * whole:
            slower(name, process["ms"], old["processes"][name]["ms"], 2 * tolerance)
    for figure, (times, slack) in GROWTH.items():
        now, was = new["residual"][figure], old["residual"][figure]
        if not now <= times * was + slack:
            faults.append("residual: %s has grown from %.4g to %.4g" % (figure, was, now))
    if not new["memory_bytes_per_cell"] <= 1.01 * old["memory_bytes_per_cell"]:
        faults.append("memory has grown from %.1f to %.1f bytes a cell" % (
            old["memory_bytes_per_cell"], new["memory_bytes_per_cell"]))
    return faults, ratio


def compare(baseline, results, tolerance, require_all):
    records = {key_of(r): r for r in baseline["records"]}
    failed, missing = 0, 0
    for new in results:
        faults = ["%d quanta of sand were lost" % -new["sand_lost_quanta"]] if new["sand_lost_quanta"] else []
        old = records.get(key_of(new))
        if old is None:
            missing += 1
            verdict = "no baseline for %s" % name_of(new)
        else:
            worse, ratio = faults_of(new, old, tolerance)
            faults += worse
            verdict = "%s: %.2f of the baseline's time" % (name_of(new), ratio)
        failed += bool(faults)
        print("%-5s %s" % ("FAIL" if faults else "-" if old is None else "ok", verdict))
        for fault in faults:
            print("      %s" % fault)
    print("%d compared, %d failed, %d without baseline" % (len(results) - missing, failed, missing))
    return 1 if failed or (missing and require_all) else 0


def commit_here():
    answer = subprocess.run(["git", "-C", os.path.dirname(os.path.abspath(__file__)), "describe", "--always", "--dirty"],
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
    if answer.returncode != 0:
        raise ValueError("--commit: git does not know it here: %s" % answer.stderr.strip())
    return answer.stdout.strip()


def write(path, results, commit):
    lost = [name_of(r) for r in results if r["sand_lost_quanta"]]
    if lost:
        raise ValueError("sand was lost in %s: no baseline" % "; ".join(lost))
    records = {key_of(r): r for r in read(path, FORMAT)["records"]} if os.path.exists(path) else {}
    for result in results:
        record = {k: result[k] for k in KEPT}
        record["commit"] = commit
        records[key_of(record)] = record
    ordered = sorted(records.values(), key=lambda r: (r["backend"], r["device"]) + key_of(r))
    with open(path + ".part", "w") as file:
        json.dump({"format": FORMAT, "records": ordered}, file, indent=1)
        file.write("\n")
    os.replace(path + ".part", path)
    print("%s: %d records, %d of them new" % (path, len(ordered), len(results)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("baseline")
    parser.add_argument("results", nargs="+")
    parser.add_argument("--tolerance", type=float, default=0.15)
    parser.add_argument("--require-all", action="store_true")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--commit", help="what was measured; git's by default")
    options = parser.parse_args()
    results = [read(path, "desert_bench 1") for path in options.results]
    if options.write:
        return write(options.baseline, results, options.commit or commit_here())
    return compare(read(options.baseline, FORMAT), results, options.tolerance, options.require_all)


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (OSError, ValueError) as fault:
        print("compare.py: %s" % fault, file=sys.stderr)
        sys.exit(2)
    except KeyError as fault:
        print("compare.py: a result or record has no %s" % fault, file=sys.stderr)
        sys.exit(2)
