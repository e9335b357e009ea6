#!/usr/bin/env python3
"""scripts/_setup.sh: which packages of scripts/dependencies.txt scripts/demo installs, and which others do; and that
dependencies.txt has no part that nobody reads."""
import os
import re
import subprocess
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
LIST = os.path.join(ROOT, "scripts", "dependencies.txt")
NOT_OF_TESTS = {"Slurm", "Checks", "Sanitizers", "Flakes"}  # parts that scripts/test does without


def shell(command):
    return subprocess.run(["bash", "-c", ". %s/scripts/_setup.sh; %s" % (ROOT, command)], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, universal_newlines=True)


def packages(name="", column=1, release=12):
    run = shell("DESERT_RELEASE='debian %d'; packages %d %s" % (release, column, name))
    if run.returncode != 0:
        raise AssertionError(run.stdout)
    found = run.stdout.split()
    if len(set(found)) != len(found):
        raise AssertionError("a package stands twice in the list '%s'" % name)
    return set(found)


def parts(release=12):
    """{part: {packages for a release of Debian}}"""
    found = {}
    with open(LIST, encoding="utf-8") as file:
        for line in file:
            heading = re.match(r"# ([A-Za-z ]+): ", line)
            if heading and not heading[1].startswith("Columns"):
                part = found.setdefault(heading[1], set())
            elif not line.startswith("#"):
                name, *releases = line.split("|")[0].replace("[", " ").replace("]", " ").split()
                if not releases or str(release) in releases:
                    part.add(name)
    return {name: names - {"-"} for name, names in found.items()}


class Packages(unittest.TestCase):
    def test_demo_installs_neither_tests_nor_tools_of_science(self):
        for name in ("window", "film"):
            demo = packages(name)
            self.assertEqual(demo & parts()["more"], set())
            self.assertEqual(demo & parts()["kit"], set())
            self.assertNotIn("snakemake", demo)
            self.assertNotIn("libopencv-dev", demo)  # comes with VTK, Qt and FFmpeg
            self.assertLess(demo, packages())

    def test_demo_without_a_display_installs_no_rviz_and_with_one_no_film(self):
        window, film = packages("window"), packages("film")
        self.assertEqual(window - film, parts()["window"])
        self.assertEqual(film - window, parts()["film"])
        self.assertIn("rviz", window)
        self.assertIn("ffmpeg", film)

    def test_demo_installs_what_a_build_of_the_nodes_looks_for(self):
        for column, package in ((1, "libopencv-imgcodecs-dev"), (2, "ros-noetic-nodelet")):
            self.assertIn(package, packages("window", column))
        self.assertLess(packages("client") - parts()["kit"], packages("film"))

    def test_tests_install_all_parts_but_those_of_other_scripts(self):
        everything = set().union(*(names for part, names in parts().items() if part not in NOT_OF_TESTS))
        self.assertEqual(packages(), everything)
        self.assertEqual(packages("sanitizers"), everything | parts()["Sanitizers"])

    def test_releases_have_what_they_need(self):
        for release, has in ((11, {"qtbase5-dev", "libopengl-dev"}), (12, {"qtbase5-dev"}), (13, {"qt6-base-dev"})):
            window = packages("window", release=release)
            self.assertEqual(window & {"qtbase5-dev", "libopengl-dev", "qt6-base-dev"}, has)
            self.assertLessEqual(parts(release)["window"], window)
        self.assertEqual({name for release in (11, 12, 13) for name in packages(release=release) if "[" in name}, set())

    def test_the_packages_of_another_system_are_those_of_debian_12(self):
        here = shell("echo $DESERT_SYSTEM $DESERT_RELEASE").stdout.split()
        with open("/etc/os-release", encoding="utf-8") as file:
            found = dict(line.rstrip().replace('"', "").split("=", 1) for line in file if "=" in line)
        known = {"debian 11": "1", "debian 12": "1", "debian 13": "1", "ubuntu 20.04": "2"}
        name = found.get("ID", "") + " " + found.get("VERSION_ID", "")
        self.assertEqual(here, [known[name], *name.split()] if name in known else ["0", "debian", "12"])

    def test_without_ros_nothing_of_ros_is_installed(self):
        self.assertEqual([name for name in packages("core", 2) if name.startswith("ros-")], [])
        self.assertEqual({name for name in packages("core") if name.startswith(("ros", "rviz", "catkin"))}, set())

    def test_unknown_lists_are_refused(self):
        run = shell("packages 1 windows")
        self.assertNotEqual(run.returncode, 0)
        self.assertIn("windows", run.stdout)


if __name__ == "__main__":
    unittest.main()
