#!/usr/bin/env python3
"""Runs clang-tidy on the sources that a build compiles for the host; scripts/lint calls it.

    test/lint/clang_tidy.py --build DIR [--tool clang-tidy-14] [--jobs N] [FILE]...

Half of the time of a source goes into headers that its neighbours include too. Sources of a folder are therefore
looked at in batches, one translation unit each, which takes a quarter of the time. Where a batch has a finding, or
does not compile as one because two sources have a name in common, each of its sources is looked at by itself, and
that result counts. Exit status 1 with findings.
"""
import argparse
import collections
import concurrent.futures
import json
import os
import pathlib
import re
import subprocess
import sys

BATCH = 12  # sources, at most: of more, a name that two have in common would cost too much
FOLDERS = ("kernels/", "src/")  # where all sources are looked at if none is named


def host_commands(build):
    """Commands of compile_commands.json by source, as clang takes them: without nvcc's (which compile the sources of
    kernels/ a second time), precompiled headers, and options that only GCC knows."""
    commands = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        source = os.path.relpath(entry["file"])
        if " -x cu " in entry["command"] or "/cmake_pch" in entry["file"] or not os.path.exists(source):
            continue
        entry["command"] = re.sub(r" --param[= ]\S+", "", entry["command"])
        commands[source] = entry
    return commands


def batches(sources, commands):
    """Lists of sources that are in the same folder of the second level and have the same options."""
    alike = collections.defaultdict(list)
    for source in sorted(sources):
        options = re.sub(r" -o \S+ -c \S+", "", commands[source]["command"])
        alike["/".join(source.split("/")[:2]) if source.startswith("src/") else source.split("/")[0], options].append(source)
    for group in alike.values():
        parts = -(-len(group) // BATCH)
        yield from (group[i * len(group) // parts:(i + 1) * len(group) // parts] for i in range(parts))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, required=True)
    parser.add_argument("--tool", default="clang-tidy")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("files", nargs="*")
    options = parser.parse_args()
    os.chdir(pathlib.Path(__file__).resolve().parents[2])

    commands = host_commands(options.build)
    sources = set(options.files) & set(commands) if options.files else {s for s in commands if s.startswith(FOLDERS)}
    folder = options.build / "lint"
    folder.mkdir(exist_ok=True)

    def tidy(source):
        run = subprocess.run([options.tool, "-p", str(folder), "--quiet", source], stdout=subprocess.PIPE,
                             stderr=subprocess.STDOUT, universal_newlines=True)
        # Warnings in headers of others are counted, but not shown.
        return run.returncode, re.sub(r"^\d+ warnings? (generated|treated).*\n", "", run.stdout, flags=re.M)

    units = {}  # name of the translation unit: its sources
    for number, batch in enumerate(batches(sources, commands)):
        if len(batch) == 1:
            units[batch[0]] = batch
            continue
        unit = str(folder / ("batch_%d.cpp" % number))
        with open(unit, "w") as file:
            file.writelines('#include "%s"\n' % os.path.abspath(source) for source in batch)
        first = commands[batch[0]]
        commands[unit] = dict(first, file=unit, command=first["command"].replace(first["file"], unit))
        units[unit] = batch
    (folder / "compile_commands.json").write_text(json.dumps(list(commands.values())))

    failed = False
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        suspects = []
        for (unit, batch), (status, output) in zip(units.items(), pool.map(tidy, units)):
            if status and len(batch) > 1:
                suspects += batch
            elif status:
                failed = True
                print(output)
        for status, output in pool.map(tidy, suspects):
            if status:
                failed = True
                print(output)
    sys.exit(failed)


if __name__ == "__main__":
    main()
