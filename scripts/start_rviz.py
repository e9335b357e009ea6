#!/usr/bin/env python3
"""Starts rviz with a file that shows a rover named rover, changed to show another one.

    rosrun desert_sim rover_rviz.py --config FILE --rover NAME --tf-prefix PREFIX [option of rviz]...

Topics and parameters that begin with rover/ begin with NAME/ instead, frames with PREFIX/. (rviz itself puts names without a
leading slash into its namespace, but does nothing to frames.) A file that changes is copied to ~/.ros/desert_sim/rviz, and
what rviz saves goes there; it is made anew at the next start."""
import argparse
import os
import re
import sys

LINE = re.compile(r"^(?P<key>\s*(?:- )?[^:#]+: )rover/(?P<rest>.*)$", re.MULTILINE)


def adapted(text, rover, tf_prefix):
    """The text of a file for rviz, whose rover is named `rover` and has the frames of `tf_prefix` (empty: none)."""
    def line(found):
        is_frame = found["key"].rstrip(": ").endswith("Frame")
        before = tf_prefix if is_frame else rover
        return found["key"] + (before + "/" if before else "") + found["rest"]
    return LINE.sub(line, text)


def written(text, name):
    """Writes the text to a file of this name; its path."""
    home = os.environ.get("ROS_HOME") or os.path.join(os.path.expanduser("~"), ".ros")
    folder = os.path.join(home, "desert_sim", "rviz")
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, name)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
                                     allow_abbrev=False)
    parser.add_argument("--config", required=True)
    parser.add_argument("--rover", default="rover")
    parser.add_argument("--tf-prefix", default="rover")
    options, others = parser.parse_known_args()
    try:
        with open(options.config, encoding="utf-8") as file:
            text = file.read()
        changed = adapted(text, options.rover.strip("/"), options.tf_prefix.strip("/"))
        config = options.config
        if changed != text:
            namespace = os.environ.get("ROS_NAMESPACE", "").strip("/")
            name = "_".join(part for part in (namespace, options.rover.strip("/")) if part).replace("/", "_")
            config = written(changed, name + ".rviz")
    except (OSError, UnicodeDecodeError) as fault:
        sys.exit("rover_rviz.py: %s: %s" % (options.config, fault))
    os.execvp("rviz", ["rviz", "-d", config, *others])


if __name__ == "__main__":
    main()
