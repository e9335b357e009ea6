#!/usr/bin/env python3
"""Runs clang-tidy on the sources that a build compiles for the host; scripts/lint calls it.

    scripts/_clang_tidy.py --build DIR [--tool clang-tidy-14] [--jobs N] [FILE]...

Most of the time of a source goes into headers that its neighbours include too. Sources of a folder are therefore
looked at in batches, one translation unit each, which is five times as quick. Sources that define the same name for
themselves go into different batches; one that still does not compile is halved until it does. Exit status 1 with
findings, 77 if the build has no source of this repository.
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

BATCH = 20  # sources, at most: enough batches for all processors
FOLDERS = ("kernels/", "src/")  # where all sources are looked at if none is named


def separately(entries):
    """Entries of compile_commands.json, where sources that are compiled at once (unity builds) have one each."""
    for entry in entries:
        if not re.search(r"/unity_\d+_cxx\.cxx$", entry["file"]):
            yield entry
            continue
        for source in re.findall(r'^#include "(.*)"$', pathlib.Path(entry["file"]).read_text(), re.M):
            yield dict(entry, file=source, command=entry["command"].replace(entry["file"], source))


def host_commands(build):
    """Commands of compile_commands.json by source, as clang takes them: without nvcc's (which compile the sources of
    kernels/ a second time), precompiled headers, and options that only GCC knows."""
    commands = {}
    for entry in separately(json.loads((build / "compile_commands.json").read_text())):
        source = os.path.relpath(entry["file"])
        if " -x cu " in entry["command"] or "/cmake_pch" in entry["file"] or not os.path.exists(source):
            continue
        # clang refuses headers that GCC has precompiled; each source includes what it needs.
        entry["command"] = re.sub(
            r" --param[= ]\S+| -Winvalid-pch| -Wno-maybe-uninitialized| -include \S+/cmake_pch\.hxx", "", entry["command"])
        # Names of one source can hide those of another in a batch.
        entry["command"] = entry["command"].replace(" -Wshadow", "")
        commands[source] = entry
    return commands


def own_names(source):
    """What a source defines at the beginning of a line in namespaces without a name, and main."""
    text = pathlib.Path(source).read_text()
    parts = re.findall(r"^namespace \{$(.*?)^\}  // namespace$", text, re.M | re.S) + re.findall(r"^int main\(", text, re.M)
    return {name for part in parts
            for name in re.findall(r"^(?!return|namespace|template)\w[\w:<>,*& ]*?\b(\w+) ?[(=\[{;]", part, re.M)}


def batches(sources, commands):
    """Lists of sources that are in the same folder of the second level, have the same options, and share no name."""
    groups = collections.defaultdict(list)  # of (sources, their names)
    for source in sorted(sources):
        options = re.sub(r" -o \S+ -c \S+", "", commands[source]["command"])
        alike = groups["/".join(source.split("/")[:2]) if source.startswith("src/") else source.split("/")[0], options]
        names = own_names(source)
        batch = next((b for b in alike if len(b[0]) < BATCH and not names & b[1]), None)
        if batch is None:
            batch = ([], set())
            alike.append(batch)
        batch[0].append(source)
        batch[1].update(names)
    return [batch for alike in groups.values() for batch, _ in alike]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, required=True)
    parser.add_argument("--tool", default="clang-tidy")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("files", nargs="*")
    options = parser.parse_args()
    os.chdir(pathlib.Path(__file__).resolve().parents[1])

    commands = host_commands(options.build)
    sources = set(options.files) & set(commands) if options.files else {s for s in commands if s.startswith(FOLDERS)}
    if not sources and not options.files:
        print("skipped: %s does not build the sources of this folder" % options.build)
        sys.exit(77)
    folder = options.build / "lint"
    folder.mkdir(exist_ok=True)

    def tidy(source):
        run = subprocess.run([options.tool, "-p", str(folder), "--quiet", source], stdout=subprocess.PIPE,
                             stderr=subprocess.STDOUT, universal_newlines=True)
        # Warnings in headers of others are counted, but not shown.
        return run.returncode, re.sub(r"^\d+ warnings? (generated|treated).*\n", "", run.stdout, flags=re.M)

    def unit(batch):
        """The file that clang-tidy is given for the batch."""
        if len(batch) == 1:
            return batch[0]
        name = str(folder / ("batch_%d.cpp" % (len(commands) + 1)))
        with open(name, "w") as file:
            file.writelines('#include "%s"\n' % os.path.abspath(source) for source in batch)
        first = commands[batch[0]]
        commands[name] = dict(first, file=name, command=first["command"].replace(first["file"], name))
        return name

    failed = False
    todo = batches(sources, commands)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        while todo:
            units = [unit(batch) for batch in todo]
            (folder / "compile_commands.json").write_text(json.dumps(list(commands.values())))
            halves = []
            for batch, (status, output) in zip(todo, pool.map(tidy, units)):
                if len(batch) > 1 and "[clang-diagnostic-error" in output:
                    halves += [batch[:len(batch) // 2], batch[len(batch) // 2:]]
                elif status:
                    failed = True
                    print(output)
            todo = halves
    sys.exit(failed)


if __name__ == "__main__":
    main()
