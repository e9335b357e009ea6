"""Checks the scenarios, and makes the plan: a dictionary that plan.json holds for Snakemake and its jobs."""
import hashlib
import json
import os
import re
import shutil
import subprocess
import tempfile

import yaml

from . import ComparisonError

GRID = ("width", "height", "cell_size_m", "boundary")


def program(name, beside):
    """The path of a program: beside desert_compare, else in $PATH."""
    path = os.path.join(beside, name)
    found = path if os.access(path, os.X_OK) else shutil.which(name)
    if not found:
        raise ComparisonError("%s is neither in %s nor in $PATH" % (name, beside))
    return os.path.abspath(found)


def digest_of_files(paths):
    """Changes with the content of any of these files."""
    digest = hashlib.sha256()
    for path in sorted(paths):
        with open(path, "rb") as file:
            digest.update(hashlib.sha256(file.read()).digest())
    return digest.hexdigest()


def printable(text):
    """A name as people and UTF-8 can have it: bytes that are none become question marks."""
    return os.fsencode(text).decode("utf-8", "replace")


def file_name(label):
    """A name of a file for a label, which Snakemake and shells take for nothing else; another one for each label."""
    safe = re.sub(r"[^A-Za-z0-9._-]", "_", label)
    return safe if safe == label else "%s-%s" % (safe, hashlib.sha256(os.fsencode(label)).hexdigest()[:6])


def files_of_program(path):
    """The program, and those of its libraries that are of this package."""
    listing = subprocess.run(["ldd", path], check=True, stdout=subprocess.PIPE, universal_newlines=True).stdout
    words = [word for line in listing.splitlines() for word in line.split()]
    return [path] + [word for word in words if word.startswith("/") and "/libdesert_" in word]


def named_files(value, folder):
    """Paths of all files that texts of a YAML document name, from the document's folder."""
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list):
        return [path for item in value for path in named_files(item, folder)]
    path = os.path.join(folder, value) if isinstance(value, str) else ""
    return [path] if os.path.isfile(path) else []


def with_absolute_files(value, folder):
    """The same document, in which these files are named by absolute paths."""
    if isinstance(value, dict):
        return {key: with_absolute_files(item, folder) for key, item in value.items()}
    if isinstance(value, list):
        return [with_absolute_files(item, folder) for item in value]
    files = named_files(value, folder)
    return os.path.abspath(files[0]) if files else value


class Planner:
    """Makes the plan of the options; programs are looked for in the folder `beside` first."""

    def __init__(self, options, beside):
        self.options = options
        self.desert_run = program("desert_run", beside)
        self.desert_metrics = program("desert_metrics", beside)
        self.programs = digest_of_files(set(files_of_program(self.desert_run) + files_of_program(self.desert_metrics)))
        self.settings = ["saltation.flux=true"] + options.set  # counting changes nothing else

    def plan(self):
        """Raises ComparisonError with what desert_run says of a scenario that it refuses."""
        o = self.options
        scenarios = [self.scenario(argument) for argument in o.scenarios]
        labels = [s["name"] for s in scenarios]
        for n, label in enumerate(labels):
            if label in labels[:n]:
                raise ComparisonError("%s and %s: both are called %s (allowed: files of different names)"
                                      % (o.scenarios[labels.index(label)], o.scenarios[n], printable(label)))
        if o.same_start:
            self.start(scenarios[0])  # refuses one whose terrain is malformed
            self.take_terrain_of(scenarios[0])
        for s in scenarios:
            s["start"] = self.start(s)
            s["files"] = digest_of_files(self.files_of(s))
        if o.same_start:
            require_same_grid(scenarios)
        runs = [self.run(s, n) for s in scenarios for n in range(o.seeds)]
        return {"scenarios": scenarios, "runs": {r["key"]: r for r in runs}, "programs": [self.desert_run, self.desert_metrics],
                "folder": os.getcwd(), "layer": o.layer, "keep_terrain": o.keep_terrain, "work": o.work, "threads": 1,
                "seeds": o.seeds, "same_start": o.same_start, "settings": o.set}

    def scenario(self, argument):
        path = argument if os.path.isfile(argument) else self.shipped(argument)
        with open(path, encoding="utf-8", errors="replace") as file:
            text = file.read()
        name = os.path.splitext(os.path.basename(path))[0]
        return {"label": printable(name), "name": file_name(name), "path": os.path.abspath(path), "text": text,
                "comment": leading_comment(text), "document": yaml_value(text, path) or {}}

    def shipped(self, name):
        """The file of an installed scenario, in the source tree or in the installed package."""
        here = os.path.dirname(os.path.realpath(__file__))
        for root in ("../..", "../../../share/desert_sim", "../../share/desert_sim"):
            path = os.path.join(here, root, "config", "scenarios", name + ".yaml")
            if os.path.isfile(path):
                return path
        return self.refused_by_desert_run(name)

    def refused_by_desert_run(self, name):
        self.call([self.desert_run, name, "--steps", "0", "--quiet"], name)
        raise ComparisonError("%s: is not a file (allowed: a scenario's file or the name of a shipped one)" % name)

    def take_terrain_of(self, first):
        document, folder = first["document"], os.path.dirname(first["path"])
        if not isinstance(document, dict) or "terrain" not in document:
            raise ComparisonError("--same-start: %s has no section `terrain`" % first["path"])
        terrain = with_absolute_files(document["terrain"], folder)
        raster = (document.get("grid") or {}).get("from_raster")
        for step in terrain:
            if raster and "raster" in step:  # without a file, a step reads the raster of the grid
                step["raster"].setdefault("file", os.path.abspath(os.path.join(folder, raster)))
        self.settings.insert(0, "terrain=" + yaml.safe_dump(terrain, default_flow_style=True, width=10 ** 9).strip())

    def files_of(self, scenario):
        """All files that the scenario and --set name, from the scenario's folder or the present one."""
        values = [scenario["document"]] + [yaml_value(s.partition("=")[2], "--set " + s) for s in self.settings]
        return {path for folder in (os.path.dirname(scenario["path"]), os.getcwd())
                for value in values for path in named_files(value, folder)}

    def arguments(self, scenario, seed):
        """Of desert_run, without those that say how long and where to."""
        words = [scenario["path"], "--seed", str(seed), "--backend", self.options.backend]
        for setting in self.settings:
            words += ["--set", setting]
        return words

    def call(self, words, what):
        done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
        if done.returncode:
            raise ComparisonError("%s: %s" % (what, done.stderr.strip() or "desert_run: status %d" % done.returncode))

    def check_length(self, words, what):
        """How long a run takes, which may depend on the scenario, is refused here and not in its runs."""
        if self.options.duration:
            self.call(words + ["--pipeline", "--duration", self.options.duration], what)

    def start(self, scenario):
        """The summary and the picture of the start, which desert_run draws if the scenario is valid."""
        starts = os.path.join(self.options.work, "starts")
        os.makedirs(starts, exist_ok=True)
        picture = os.path.join(starts, scenario["name"] + ".png")
        with tempfile.TemporaryDirectory(dir=starts) as folder:
            words = [self.desert_run] + self.arguments(scenario, self.options.first_seed)
            self.check_length(words, scenario["path"])
            self.call(words + ["--steps", "0", "--quiet", "--format", "netcdf", "--out", folder], scenario["path"])
            os.replace(os.path.join(folder, "elevation.png"), picture)
            with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
                summary = json.load(file)
        return {"picture": picture, **{key: summary[key] for key in GRID}}

    def run(self, scenario, n):
        o, seed = self.options, self.options.first_seed + n
        words = self.arguments(scenario, seed) + ["--snapshots", str(o.snapshots)]
        words += ["--steps", str(o.steps)] if o.steps else []
        words += ["--duration", o.duration] if o.duration else []
        film = [w for v in o.view for w in ("--view", v)] if o.film and n == 0 else None
        made_of = [words[1:], film, o.layer, o.keep_terrain, scenario["text"], scenario["files"], self.programs]
        digest = hashlib.sha256(json.dumps(made_of).encode()).hexdigest()[:12]
        return {"key": "%s-%d-%s" % (scenario["name"], seed, digest), "name": scenario["name"], "label": scenario["label"], "seed": seed,
                "arguments": words, "film": film}


def yaml_value(text, where):
    try:
        return yaml.safe_load(text)
    except yaml.YAMLError as error:
        raise ComparisonError("%s: is not YAML: %s" % (where, " ".join(str(error).split())))


def leading_comment(text):
    """What the comment at the head of a scenario says."""
    lines = []
    for line in text.splitlines():
        if not line.startswith("#"):
            break
        lines.append(line.lstrip("#").strip())
    return " ".join(lines)


def require_same_grid(scenarios):
    def grid(s):
        return "%(width)d x %(height)d cells of %(cell_size_m)g m, %(boundary)s" % s["start"]
    for s in scenarios[1:]:
        if grid(s) != grid(scenarios[0]):
            raise ComparisonError("--same-start: the grid of %s (%s) is not that of %s (%s); allowed: the same grid"
                                  % (s["path"], grid(s), scenarios[0]["path"], grid(scenarios[0])))
