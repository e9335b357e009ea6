#!/usr/bin/env python3
"""Writes the package that README.md shows: each block of code after a line <!-- file: NAME --> becomes the file NAME.

    readme_package.py README.md FOLDER
"""
import os
import re
import sys


def main():
    readme, folder = sys.argv[1:]
    with open(readme) as file:
        blocks = re.findall(r"^<!-- file: (\S+) -->\n```\w+\n(.*?)^```$", file.read(), re.M | re.S)
    if not blocks:
        sys.exit("%s: no line <!-- file: NAME --> before a block of code" % readme)
    os.makedirs(folder, exist_ok=True)
    for name, text in blocks:
        path = os.path.join(folder, name)
        with open(path, "w") as file:
            file.write(text)
        os.chmod(path, 0o755 if text.startswith("#!") else 0o644)
        print("%s: %d lines" % (name, text.count("\n")))


if __name__ == "__main__":
    main()
