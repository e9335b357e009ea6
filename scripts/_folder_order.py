#!/usr/bin/env python3
"""Reports each include of kernels/ and src/ that goes against scripts/folder_order.txt, and each in include/ of what is not
installed. Exit status 1 if there is one."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
ORDER = ROOT / "scripts/folder_order.txt"
SOURCES = {".hpp", ".cpp", ".cuh", ".cu"}
# Headers of include/desert_sim belong to the folder of src/ that defines what they declare.
INCLUDE = re.compile(r'\s*#\s*include\s*"(?:((?:kernels|src)/[^"]+)|include/desert_sim/([^"]+))"')


def folder_of(file):
    folder = file.rpartition("/")[0]
    return folder[:-len("/tuned")] if folder.endswith("/tuned") else folder


def line_of_each_folder():
    lines = [line.split() for line in ORDER.read_text().splitlines() if not line.startswith("#")]
    return {folder: number for number, folders in enumerate(lines) for folder in folders}


def findings(lines):
    files = [p for room in ("kernels", "src") for p in sorted((ROOT / room).rglob("*")) if p.suffix in SOURCES]
    for path in files:
        file = str(path.relative_to(ROOT))
        folder = folder_of(file)
        if folder not in lines:
            yield "%s: its folder is not in scripts/folder_order.txt" % file
            continue
        for number, text in enumerate(path.read_text().splitlines(), 1):
            found = INCLUDE.match(text)
            included = (found.group(1) or "src/" + found.group(2).replace("testing.hpp", "testing/")) if found else file
            other = folder_of(included)
            if other != folder and lines.get(other, len(lines)) >= lines[folder]:
                yield "%s:%d: %s must not include %s" % (file, number, folder, included)
    for path in sorted((ROOT / "include").rglob("*.hpp")):
        for number, text in enumerate(path.read_text().splitlines(), 1):
            if re.match(r'\s*#\s*include\s*"(?!desert_sim/)', text):
                yield "%s:%d: other packages have no such header" % (path.relative_to(ROOT), number)
    for folder in lines:
        if not (ROOT / folder).is_dir():
            yield "scripts/folder_order.txt: there is no folder %s" % folder


if __name__ == "__main__":
    found = list(findings(line_of_each_folder()))
    print("\n".join(found), end="\n" if found else "")
    sys.exit(1 if found else 0)
