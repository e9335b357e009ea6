#!/usr/bin/env python3
"""Refuses arguments of the command line that a launch file of this package does not have; roslaunch ignores them.

    <param name="launch_arguments/NAME" command="$(find desert_sim)/check_launch_arguments.py '$(find desert_sim)/launch/NAME.launch'"/>

roslaunch runs this while it loads the file, and ends if it fails. Only the file that the command line of roslaunch names is
checked: not one that another includes, where roslaunch itself refuses them, and nothing where Python or rostest loads it."""
import os
import sys
import xml.etree.ElementTree


def arguments_of(path):
    """The names of the arguments that a file takes, with those that it passes on, in the order of the files."""
    root = xml.etree.ElementTree.parse(path).getroot()
    names = [arg.get("name") for arg in root.findall("arg") if arg.get("value") is None]
    for include in root.findall("include"):
        if include.get("pass_all_args") == "true":
            included = os.path.join(os.path.dirname(path), os.path.basename(include.get("file")))
            set_here = [arg.get("name") for arg in include.findall("arg")]
            names += [name for name in arguments_of(included) if name not in names + set_here]
    return names


def given(command, path):
    """The names of the arguments that a command line of roslaunch gives to the file at `path`; none if it names another
    one, or is not of roslaunch."""
    program = next((n for n, word in enumerate(command[:3]) if os.path.basename(word) == "roslaunch"), None)
    words = [] if program is None else command[program + 1:]
    others = [word for word in words if ":=" not in word]
    by_package = ("desert_sim", os.path.basename(path)) in zip(others, others[1:])
    by_path = any(os.path.realpath(word) == os.path.realpath(path) for word in others)
    if not by_package and not by_path:
        return []
    return [word.split(":=")[0] for word in words if ":=" in word and not word.startswith("_")]


def main():
    path = sys.argv[1]
    with open("/proc/%d/cmdline" % os.getppid(), encoding="utf-8", errors="replace") as file:
        names = given(file.read().split("\0")[:-1], path)
    known = arguments_of(path) if names else []
    unknown = [name for name in names if name not in known]
    if unknown:
        from desert_sim.did_you_mean import did_you_mean  # only here: it takes its time
        name = os.path.basename(path)
        for argument in unknown:
            print("%s has no argument '%s'%s" % (name, argument, did_you_mean(argument, known)), file=sys.stderr)
        print("Its arguments: %s.\nroslaunch desert_sim %s --ros-args says what they are." % (", ".join(known), name),
              file=sys.stderr)
        return 2
    print("checked")
    return 0


if __name__ == "__main__":
    sys.exit(main())
