#!/usr/bin/env python3
"""Highest stacks of the slab models beside those of a thesis and of an independent sequential program.

    test/bench/slab_models.py [--run build/bin/desert_run] [--seeds 5] [--jobs 2] [--only NAME...]

Runs the scenarios of the thesis' tables 6.1 to 6.6 and prints a row for each: the highest stack [slabs] of each seed,
their mean, and what the two others have. Exit status 1 if a mean is off the nearer of them by more than 4 slabs. The
growth curves of the scenarios with plants were fitted to these rows, because the thesis does not give its own in numbers.
"""
import argparse
import concurrent.futures
import json
import pathlib
import subprocess
import sys
import tempfile

import cv2

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Scenario, changes, thesis, independent program (None: not known).
ROWS = {
    "werner_barchan": ([], 26, 24.4),
    "werner_transverse": ([], 28, 27.9),
    "werner_star": ([], 23, 21.8),
    "momiji_barchan": ([], 26, 24.9),
    "momiji_star": ([], 22, 21.6),
    "bishop_barchan": ([], 28, 25.5),
    "werner_barchan, 200 s": (["run.duration=200"], None, 8.9),
    "werner_barchan, 200 s, each cell once": (["run.duration=200", "slab_model.polling=non_repeated"], None, 12.1),
    "nield_nebkha": ([], 58, None),
    "nield_nebkha, 1500 s": (["run.duration=1500"], 85, None),
    "nield_blowouts": ([], 76, None),
    "nield_islands": ([], 57, None),
}
TOLERANCE = 4


def highest_stack(program, name, settings, seed):
    with tempfile.TemporaryDirectory() as out:
        scenario = ROOT / "config/scenarios" / (name.split(",")[0] + ".yaml")
        command = [program, str(scenario), "--quiet", "--threads", "1", "--set", f"seed={seed}", "--out", out]
        for setting in settings:
            command += ["--set", setting]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        summary = json.loads((pathlib.Path(out) / "summary.json").read_text())
        sand = cv2.imread(str(pathlib.Path(out) / "sand.tif"), cv2.IMREAD_UNCHANGED)
        return sand.max() / summary["slab_height_m"], summary["mass_residual"]["sand"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--run", default=str(ROOT / "build/devel/lib/desert_sim/desert_run"))
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", nargs="+", choices=ROWS, default=list(ROWS))
    options = parser.parse_args()
    failed = False
    print("| scenario | highest stacks | mean | thesis | independent |\n|---|---|---|---|---|")
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        runs = {
            name: [pool.submit(highest_stack, options.run, name, ROWS[name][0], seed + 1) for seed in range(options.seeds)]
            for name in options.only
        }
        for name, futures in runs.items():
            _, thesis, independent = ROWS[name]
            stacks = [future.result()[0] for future in futures]
            mean = sum(stacks) / len(stacks)
            known = [value for value in (thesis, independent) if value is not None]
            failed |= min(abs(mean - value) for value in known) > TOLERANCE
            failed |= any(future.result()[1] for future in futures)
            each = ", ".join(f"{stack:.0f}" for stack in stacks)
            print(f"| {name} | {each} | {mean:.1f} | {thesis or ''} | {independent or ''} |", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
