#!/usr/bin/env python3
"""Starts rviz as the launch files do.

    rosrun desert_sim start_rviz.py --config FILE [--rover NAME --tf-prefix PREFIX] [--anti-aliasing auto|on|off]
                                    [option of rviz]...

With --rover, a file that shows a rover named rover is changed to show another one: topics and parameters that begin with
rover/ begin with NAME/ instead, frames with PREFIX/. (rviz itself puts names without a leading slash into its namespace, but
does nothing to frames.) A file that changes is copied to ~/.ros/desert_sim/rviz, and what rviz saves goes there; it is made
anew at the next start. --anti-aliasing auto, the default: on where a graphics card draws, off where the processor does, which
then is twice as fast."""
import argparse
import glob
import os
import re
import sys

LINE = re.compile(r"^(?P<key>\s*(?:- )?[^:#]+: )rover/(?P<rest>.*)$", re.MULTILINE)
CARDS = ("dri/renderD*", "nvidia[0-9]*", "dxg")  # of Mesa, of NVIDIA's driver, of Windows' subsystem for Linux


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


def processor_draws(environment, devices="/dev"):
    """Whether OpenGL is drawn by the processor: Mesa is told so, or there is no device of a graphics card."""
    if environment.get("LIBGL_ALWAYS_SOFTWARE", "").lower() in ("1", "true", "yes", "y"):
        return True
    return not any(glob.glob(os.path.join(devices, card)) for card in CARDS)


def adapted_file(path, rover, tf_prefix):
    """Path of the file for rviz that shows this rover: `path`, or a changed copy."""
    with open(path, encoding="utf-8") as file:
        text = file.read()
    changed = adapted(text, rover.strip("/"), tf_prefix.strip("/"))
    if changed == text:
        return path
    namespace = os.environ.get("ROS_NAMESPACE", "").strip("/")
    name = "_".join(part for part in (namespace, rover.strip("/")) if part).replace("/", "_")
    return written(changed, name + ".rviz")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
                                     allow_abbrev=False)
    parser.add_argument("--config", required=True)
    parser.add_argument("--rover", default="rover")
    parser.add_argument("--tf-prefix", default="rover")
    parser.add_argument("--anti-aliasing", choices=("auto", "on", "off"), default="auto")
    options, others = parser.parse_known_args()
    try:
        config = adapted_file(options.config, options.rover, options.tf_prefix)
    except (OSError, UnicodeDecodeError) as fault:
        sys.exit("start_rviz.py: %s: %s" % (options.config, fault))
    smooth = options.anti_aliasing == "on" or options.anti_aliasing == "auto" and not processor_draws(os.environ)
    if not smooth and "--disable-anti-aliasing" not in others:
        others.append("--disable-anti-aliasing")
    os.execvp("rviz", ["rviz", "-d", config, *others])


if __name__ == "__main__":
    main()
