#!/usr/bin/env python3
"""Runs scenarios with parameters at the ends of their ranges, and with random ones: nothing ends but with 0 or 2, no
material is lost, and a run gives the same state on one thread and two, through a checkpoint, and in a replay that loads it.

    test/fuzz/parameters.py DESERT_RUN ends                     each parameter at both ends, in each model
    test/fuzz/parameters.py DESERT_RUN random N [--seed S]      N combinations
        --steps N (300)   --jobs N (processors)   --only TEXT (models whose name has it)
        --cuda N          each Nth on the GPU, too
        --timeout S       of a run (600: grains of sand on cells of a centimetre for a year need minutes)

What fails is printed as a command that repeats it. Exit status 1 if something does."""
import argparse
import concurrent.futures
import json
import math
import os
import random
import re
import subprocess
import sys
import tempfile

GROUND = """grid: {width: 28, height: 20, cell_size: %s, boundary: %s}
terrain:
  - noise: {layer: bedrock, low: 0, high: %s, scale: 9}
  - uniform: {layer: soil, value: 0.3}
  - noise: {layer: sand, low: 0, high: %s, scale: 6}
  - uniform: {layer: moisture, value: 0.02}
  - noise: {layer: vegetation, low: 0, high: 1, scale: 6, threshold: 0.5}
  - obstacle: {shape: box, x: %s, y: %s, size_x: %s, size_y: %s, height: %s}
"""


def ground(cell=1.0, boundary="open"):
    return GROUND % (cell, boundary, 3 * cell, 3 * cell, 14 * cell, 10 * cell, 3 * cell, 3 * cell, 6 * cell)


def without_vegetation(text):
    """Where plants live, they say where they grow."""
    return "".join(line for line in text.splitlines(True) if "vegetation" not in line)


MODELS = {
    "hops": ground() + "wind: {speed: 8, direction_deg: 20}\nsaltation: {influx: 0.2}\nlooseness: {enabled: true}\n"
            "echo_dunes: {enabled: true}\nabrasion: {rate: 0.01}\n",
    "smoothing": ground(boundary="periodic") + "wind: {speed: 8, direction_deg: 100}\n"
                 "reptation: {method: smoothing, strength: 0.1}\navalanching: {scheme: sweeps}\n",
    "continuum": ground(0.5) + "wind: {speed: 9, direction_deg: -30}\nsand: {model: continuum}\nsaltation: {influx: 1.0e-4}\n"
                 "run: {time_step: 60}\n",
    "desertscape": ground() + "wind: {speed: 6, direction_deg: 20}\n"
                   "sand: {model: desertscape_2019}\nsaltation: {lift: 0.1, influx: 0.1}\n",
    "werner": ground() + "wind: {speed: 5, direction_deg: 20}\nsaltation: {influx: 0.3}\nsand: {model: werner}\n",
    "momiji": ground() + "wind: {speed: 5, direction_deg: 70}\nsaltation: {influx: 0.3}\nsand: {model: momiji}\n",
    "bishop": ground(boundary="periodic") + "wind: {speed: 5, direction_deg: 20}\nsand: {model: bishop}\n",
    "nield_baas": ground() + "wind: {speed: 5, direction_deg: 20}\nslab_plants: {growth_time: 5}\n"
                  "sand: {model: nield_baas}\nslab_model: {slab_height: 0.1, forced_erosion: true}\n",
    "snow": ground(0.25, "periodic") + "wind: {speed: 5, direction_deg: 20}\nrun: {time_step: 3600}\n"
            "sand: {model: snow}\nslab_model: {slab_height: 0.02, poll_time: 3600}\nslab_snow: {settling_time: 3600}\n",
    "wang": ground(0.01) + "wind: {speed: 12, direction_deg: 20}\nsaltation: {influx: 2.0e-6}\nsand: {model: wang}\n",
    "water": without_vegetation(ground()) + "wind: {speed: 8, direction_deg: 20}\nrain: {rate: 1.0e-4}\nhydraulic_erosion: {enabled: true}\n"
             "moisture: {enabled: true}\nsoil: {enabled: true}\nvegetation: {enabled: true}\n"
             "species: [{name: bush}]\n"
             "water: {enabled: true, springs: [{x: 8, y: 8, radius: 2, discharge: 0.5}], sea: border, sea_level: 1}\n",
}
REFUSED = "refused"
# Sections that say how much there is and where, and lists of files.
LEFT_OUT = {"grid.width", "grid.height", "grid.from_raster", "wind.series_file", "run.steps", "run.duration", "seed",
            "vegetation.max_plants", "run.check_every"}


def parameters(desert_run):
    """(path, ends) of each parameter: [low, high] of a number, the words of a choice."""
    text = subprocess.run([desert_run, "--describe"], check=True, stdout=subprocess.PIPE, universal_newlines=True).stdout
    found, section, listed = [], "", False
    for line in text.splitlines():
        heading = re.match(r"(##+) `?([\w.]+)`?(.*)", line)
        if heading:
            if heading[1] == "##":
                section, listed = heading[2], "list" in heading[3] or "map" in heading[3]
            else:
                listed = "each of" in line
            if section == "What":
                break
            continue
        row = re.match(r"\| `(\w+)` \|[^|]*\|[^|]*\| ([^|]*) \|", line)
        if not row or listed or section in ("terrain", "top"):
            continue
        path = section + "." + row[1]
        if path in LEFT_OUT or row[2] == "text":
            continue
        if " of " in row[2]:  # lists
            continue
        ends = [word.strip() for word in re.split("…|,", row[2])]
        found.append((path, ends, "…" in row[2]))
    return found


class Fuzzer:
    def __init__(self, options):
        self.options, self.folder = options, tempfile.mkdtemp(prefix="desert_parameters_")
        for name, text in MODELS.items():
            with open(self.scenario(name), "w", encoding="utf-8") as file:
                file.write(text)

    def scenario(self, name):
        return os.path.join(self.folder, name + ".yaml")

    def words(self, model, settings, more, backend="cpu"):
        words = [self.options.desert_run, self.scenario(model), "--backend", backend, "--quiet", "--set", "run.check_every=1"]
        for setting in settings:
            words += ["--set", setting]
        return words + more

    def run(self, words):
        # What memory held before must not matter: two runs are unlikely to find the same.
        environment = dict(os.environ, OMP_WAIT_POLICY="passive", MALLOC_PERTURB_=str(random.randrange(1, 256)))
        return subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, env=environment,
                              timeout=self.options.timeout)

    def summary(self, folder):
        with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
            return json.load(file)

    def problem(self, model, settings, on_gpu):
        """What is wrong with a run; empty if nothing is, REFUSED if it is refused. A model as it is must not be."""
        steps = str(self.options.steps)
        with tempfile.TemporaryDirectory(dir=self.folder) as folder:
            out, half = os.path.join(folder, "out"), os.path.join(folder, "half")
            try:
                words = self.words(model, settings, ["--threads", "1", "--steps", steps, "--out", out])
                first = self.run(words)
                if first.returncode == 2:
                    return REFUSED if settings else "is refused: " + first.stderr.strip()[-300:]
                if first.returncode != 0:
                    return "status %d: %s" % (first.returncode, first.stderr.strip()[-300:])
                summary = self.summary(out)
                if any(summary["mass_residual"].values()):
                    return "residual %s" % summary["mass_residual"]
                if on_gpu:
                    gpu = self.run(self.words(model, settings, ["--steps", steps, "--out", out], "cuda"))
                    if gpu.returncode != 0:
                        return "status %d on the GPU: %s" % (gpu.returncode, gpu.stderr.strip()[-300:])
                    if any(self.summary(out)["mass_residual"].values()):
                        return "residual on the GPU %s" % self.summary(out)["mass_residual"]
                middle = str(self.options.steps // 2)
                saved = self.run(self.words(model, settings, ["--threads", "2", "--steps", middle, "--checkpoint", half]))
                if saved.returncode != 0:
                    return "status %d half way: %s" % (saved.returncode, saved.stderr.strip()[-300:])
                resumed = self.run([self.options.desert_run, "--resume", half, "--threads", "2", "--steps", steps, "--backend",
                                    "cpu", "--quiet", "--out", out])
                if resumed.returncode != 0:
                    return "status %d after a checkpoint: %s" % (resumed.returncode, resumed.stderr.strip()[-300:])
                if self.summary(out)["state_hash"] != summary["state_hash"]:
                    return "another state with two threads and a checkpoint"
                # A session of the same scenario that loads the checkpoint at its step 10.
                journal = os.path.join(folder, "journal")
                with open(journal, "w", encoding="utf-8") as file:
                    file.write("{journal: 2, scenario_hash: %s, backend: cpu}\n" % summary["scenario_hash"])
                    file.write("{tick: 10, command: load_checkpoint, path: %s, hash: 0}\n" % json.dumps(half))
                replayed = self.run(self.words(model, settings, ["--threads", "2", "--replay", journal, "--steps",
                                                                 str(10 + self.options.steps - int(middle)), "--out", out]))
                if replayed.returncode != 0:
                    return "status %d of a replay: %s" % (replayed.returncode, replayed.stderr.strip()[-300:])
                if self.summary(out)["state_hash"] != summary["state_hash"]:
                    return "another state after a replay"
            except subprocess.TimeoutExpired:
                return "takes more than %g s" % self.options.timeout
        return ""

    def check(self, cases):
        """Runs all (model, settings); prints what fails, and how many were refused. Whether nothing failed."""
        failed = refused = 0
        with concurrent.futures.ThreadPoolExecutor(self.options.jobs) as at_once:
            every = self.options.cuda
            on_gpu = [every > 0 and n % every == 0 for n in range(len(cases))]
            problems = at_once.map(lambda case, gpu: self.problem(*case, gpu), cases, on_gpu)
            for (model, settings), problem in zip(cases, problems):
                if problem == REFUSED:
                    refused += 1
                elif problem:
                    failed += 1
                    print("%s: %s\n  %s" % (model, problem, " ".join("--set '%s'" % s for s in settings)), flush=True)
        print("%d runs, %d refused, %d failed; the scenarios are in %s" % (len(cases), refused, failed, self.folder))
        return failed == 0


def between(draw, low, high):
    """A number of a range: an end, or one in between, by its logarithm where the range has many orders."""
    low, high = float(low), float(high)
    kind = draw.random()
    if kind < 0.25:
        return draw.choice([low, high])
    if low >= 0 and high > 1000 * max(low, 1e-9):
        return math.exp(draw.uniform(math.log(max(low, high * 1e-9)), math.log(high)))
    return draw.uniform(low, high)


def combination(draw, known):
    settings = []
    for path, ends, is_range in draw.sample(known, draw.randrange(1, 7)):
        value = between(draw, *ends) if is_range else draw.choice(ends)
        # A whole number is taken where a real one is wanted, not the other way round.
        whole = is_range and all(re.fullmatch(r"-?\d+", end) for end in ends) and draw.random() < 0.5
        settings.append("%s=%s" % (path, round(value) if whole else value))
    return settings


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("desert_run")
    parser.add_argument("what", choices=["ends", "random"])
    parser.add_argument("count", type=int, nargs="?", default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--steps", type=int, default=300)
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--only", default="")
    parser.add_argument("--timeout", type=float, default=600)
    parser.add_argument("--cuda", type=int, default=0, metavar="N")
    options = parser.parse_args()
    known = parameters(options.desert_run)
    models = [name for name in MODELS if options.only in name]
    cases = [(model, []) for model in models]
    if options.what == "ends":
        cases += [(model, ["%s=%s" % (path, end)]) for path, ends, _ in known for end in ends for model in models]
    else:
        draw = random.Random(options.seed)
        cases += [(draw.choice(models), combination(draw, known)) for _ in range(options.count)]
    return 0 if Fuzzer(options).check(cases) else 1


if __name__ == "__main__":
    sys.exit(main())
