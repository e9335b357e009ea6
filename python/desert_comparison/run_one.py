"""One run of a comparison, a job of Snakemake: desert_run, then desert_metrics.

  run_one.py PLAN.json KEY PARENT

PARENT is the number of the process that it ends with. Everything is made in a folder of its own; result.json, with
summary and metrics, gets its name at last.
"""
import json
import os
import shutil
import subprocess
import sys

import processes  # beside this file, which is a program of its own

LOST_MATERIAL = 1  # exit status of desert_run, which has then written all its outputs


def call(words, log, cwd, allowed=(0,)):
    status = subprocess.call(words, stdout=log, stderr=log, cwd=cwd, preexec_fn=processes.ends_with_this())
    if status not in allowed:
        raise SystemExit("%s ended with status %d" % (os.path.basename(words[0]), status))


def move(folder, name, to):
    os.replace(os.path.join(folder, name), to)


def make(plan, run, home):
    desert_run, desert_metrics = plan["programs"]
    folder = processes.begin_attempt(home)
    with open(os.path.join(home, "log.txt"), "w") as log:
        words = [desert_run] + run["arguments"] + ["--format", "netcdf", "--out", folder]
        if run["film"] is not None:
            words += ["--film", os.path.join(folder, "film.mp4")] + run["film"]
        call(words + ["--threads", str(plan["threads"])], log, plan["folder"], (0, LOST_MATERIAL))
        call([desert_metrics, folder, "--layer", plan["layer"], "--out", os.path.join(folder, "metrics.json")], log, folder)
    result = {"key": run["key"], "name": run["name"], "label": run["label"], "seed": run["seed"]}
    for name in ("summary", "metrics"):
        with open(os.path.join(folder, name + ".json"), encoding="utf-8") as file:
            result[name] = json.load(file)
    move(folder, "elevation.png", os.path.join(home, "end.png"))
    if run["film"] is not None:
        move(folder, "film.mp4", os.path.join(home, "film.mp4"))
    if plan["keep_terrain"]:
        move(folder, "terrain.nc", os.path.join(home, "terrain.nc"))
    path = os.path.join(folder, "result.json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(result, file)
        file.flush()
        os.fsync(file.fileno())
    os.replace(path, os.path.join(home, "result.json"))
    shutil.rmtree(folder)


def main(plan_path, key, parent):
    processes.end_with(int(parent))
    with open(plan_path, encoding="utf-8") as file:
        plan = json.load(file)
    home = os.path.join(plan["work"], "runs", key)
    os.makedirs(home, exist_ok=True)
    processes.remove_attempts(home)
    try:
        make(plan, plan["runs"][key], home)
    except BaseException as error:  # desert_compare shows the last line of the log
        with open(os.path.join(home, "log.txt"), "a") as log:
            log.write("\n%s: %s\n" % (type(error).__name__, error))
        raise


if __name__ == "__main__":
    main(*sys.argv[1:])
