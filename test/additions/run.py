#!/usr/bin/env python3
"""Adds a made-up process, model that moves sand, layer, topic and command to a copy of the tree, builds and runs it: that is
how many places of the tree each of them touches, tests and generated pages apart.

    test/additions/run.py [--scratch DIR]     builds for the CPU with ROS, and runs all of them
    test/additions/run.py --check             they fit the tree, and CONTRIBUTING.md names each place; nothing is built

additions.py has them. --scratch keeps the copy and its build. Exit status: 0; 1 with what is wrong.
"""
import argparse
import fnmatch
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from additions import ADDITIONS, New

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
# What each may touch at most.
MOST = {"process": 5, "sand model": 6, "layer": 5, "topic": 5, "command": 7}
SCENARIO = """\
grid: {width: 48, height: 32, cell_size: 1, boundary: open}
terrain: [uniform: {layer: bedrock, value: 3}, cone: {layer: sand, x: 20, y: 16, height: 4, radius: 8}]
wind: {speed: 6}
sand: {model: march}
salt_weathering: {enabled: true, rate: 0.01}
water: {enabled: true}
run: {steps: 20}
"""


def files_of(addition):
    return list(dict.fromkeys(place.file for place in addition.places))


def named_places(contributing, section):
    """The paths in a list of CONTRIBUTING.md as patterns: src/<room>/<name>.cpp is src/*/*.cpp."""
    text = re.search(r"^\*\*%s\*\*.*?\n\n" % re.escape(section), contributing, re.MULTILINE | re.DOTALL).group()
    return [re.sub(r"<\w+>", "*", path) for path in re.findall(r"`([\w/<>*.]+\.\w+)`", text)]


def faults():
    contributing = (ROOT / "CONTRIBUTING.md").read_text()
    for addition in ADDITIONS:
        files = files_of(addition)
        if len(files) > MOST[addition.name]:
            yield "a %s touches %d places, more than %d" % (addition.name, len(files), MOST[addition.name])
        named = [pattern for section in addition.sections for pattern in named_places(contributing, section)]
        for file in files:
            if not any(fnmatch.fnmatch(file, pattern) for pattern in named):
                yield "a %s touches %s, which CONTRIBUTING.md does not name" % (addition.name, file)
        for place in addition.places:
            path = ROOT / place.file
            if isinstance(place, New):
                if path.exists():
                    yield "%s is there already" % place.file
            elif path.read_text().count(place.after) != 1:
                yield "%s: found %d times, not once: %s" % (place.file, path.read_text().count(place.after), place.after)


def copy_tree(tree):
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-z", "--cached", "--others", "--exclude-standard"], check=True,
                            stdout=subprocess.PIPE).stdout
    for name in filter(None, map(os.fsdecode, listed.split(b"\0"))):
        (tree / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(ROOT / name, tree / name)


def add_all(tree):
    for addition in ADDITIONS:
        for place in addition.places:
            path = tree / place.file
            path.write_text(place.text if isinstance(place, New) else
                            path.read_text().replace(place.after, place.after + place.text))
        print("%-12s %d places: %s" % (addition.name, len(files_of(addition)), ", ".join(files_of(addition))), flush=True)


def build(tree, folder):
    call(["cmake", "-S", tree, "-B", folder, "-DDESERT_WITH_CUDA=OFF", "-DDESERT_WITH_RVIZ=OFF", "-DCMAKE_BUILD_TYPE=Release"])
    call(["cmake", "--build", folder, "-j", str(os.cpu_count())])
    programs = folder / "devel/lib/desert_sim"
    for page, command in (("parameters", ["desert_run", "--describe"]), ("processes", ["desert_run", "--describe-processes"]),
                          ("node_parameters", ["desert_sim_node", "--describe"])):
        text = subprocess.run([programs / command[0]] + command[1:], check=True, stdout=subprocess.PIPE).stdout
        (tree / "config" / (page + ".md")).write_bytes(text)
    call([tree / "scripts/readme_tables"])
    return programs


def run(tree, folder, programs):
    """Each of them does something: in a run, which exits with 1 if material is lost, and in a node."""
    scenario = folder / "additions.yaml"
    scenario.write_text(SCENARIO)
    pipeline = subprocess.run([programs / "desert_run", scenario, "--pipeline"], check=True, stdout=subprocess.PIPE, text=True)
    for name in ("march", "salt_weathering", "salt"):
        if not re.search(r"\b%s\b" % name, pipeline.stdout):
            raise SystemExit("%s is not in the step:\n%s" % (name, pipeline.stdout))
    hashes = set()
    for threads in "12":
        done = subprocess.run([programs / "desert_run", scenario, "--backend", "cpu", "--threads", threads, "--quiet", "--out",
                               folder / "out"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode:
            raise SystemExit("desert_run: exit status %d: %s" % (done.returncode, done.stdout))
        hashes.add(re.search(r'"state_hash": "(\w+)"', (folder / "out/summary.json").read_text()).group(1))
    if len(hashes) != 1:
        raise SystemExit("one and two threads make different bits: %s" % hashes)
    # The node's topics, services, parameters and maps are those of the pages.
    call(["ctest", "--output-on-failure", "--no-tests=error", "-R", "src_ros_node_interface"], folder)


def call(command, folder=None):
    done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode:
        raise SystemExit("%s failed:\n%s" % (" ".join(map(str, command)), done.stdout[-4000:]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--scratch", type=pathlib.Path, metavar="DIR")
    options = parser.parse_args()
    found = list(faults())
    if found or options.check:
        sys.exit("\n".join(found) or 0)
    with tempfile.TemporaryDirectory(prefix="desert_additions_") as temporary:
        scratch = (options.scratch or pathlib.Path(temporary)).resolve()
        tree = scratch / "tree"
        copy_tree(tree)
        add_all(tree)
        run(tree, tree / "build", build(tree, tree / "build"))


if __name__ == "__main__":
    main()
