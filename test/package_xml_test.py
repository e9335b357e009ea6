#!/usr/bin/env python3
"""package.xml: `rosdep install` finds a package for each of its keys, on Ubuntu 20.04 with ROS Noetic and on Debian 12, and
they are those of scripts/dependencies.txt. The rules are those of rosdep_rules.yaml, a snapshot:

    package_xml_test.py --renew ROSDISTRO     from a checkout of github.com/ros/rosdistro
"""
import os
import subprocess
import sys
import unittest
from xml.etree import ElementTree

import yaml

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(HERE)
RULES = os.path.join(HERE, "rosdep_rules.yaml")
# What rosdep has no rule for: CMake names the package where it is missing, and CONTRIBUTING.md says what to install.
WITHOUT_RULE = {"librandom123-dev", "libcli11-dev"}
# A package of ROS there, of Debian here: the same library.
OF_ROS = {"libompl-dev": "ompl"}
# What packages bring that rosdep knows in place of these.
BROUGHT = {"libopencv-dev": {"libopencv-core-dev", "libopencv-imgproc-dev", "libopencv-imgcodecs-dev"},
           "google-mock": {"libgmock-dev"}}
# Of dependencies.txt, what a workspace has already, or only tests, checks and other tools of ours use.
OF_EVERY_WORKSPACE = {"g++", "make", "ninja-build", "cmake", "pkg-config"}
OF_TESTS = {"python3-netcdf4", "python3-xarray", "snakemake", "munge", "slurmctld", "slurmd", "slurm-client", "xvfb",
            "libgl1-mesa-dri", "shellcheck", "flake8", "catkin-lint", "python3-catkin-pkg", "clang", "llvm", "libomp-dev",
            "stress-ng", "qtbase5-dev", "qt6-base-dev", "libopengl-dev",
            "ros-noetic-grid-map-visualization", "ros-noetic-grid-map-filters"}


def keys():
    """The keys of package.xml, for ROS Noetic."""
    package = ElementTree.parse(os.path.join(ROOT, "package.xml")).getroot()
    return sorted({element.text for element in package if element.tag.endswith("depend")})


def packages_of(rule, system, release):
    """What a rule of rosdep says for a release of a system: None if nothing."""
    found = rule.get(system)
    if isinstance(found, dict) and "packages" not in found and "apt" not in found:
        found = found.get(release, found.get("*"))
    if isinstance(found, dict):
        found = found.get("apt", found).get("packages")
    return found.split() if isinstance(found, str) else found


def renew(folder):
    def show(name):
        git = ["git", "-C", folder, "show", "HEAD:" + name]
        return yaml.safe_load(subprocess.run(git, check=True, stdout=subprocess.PIPE).stdout)
    rules = {**show("rosdep/base.yaml"), **show("rosdep/python.yaml")}
    released = {}
    for repository in show("noetic/distribution.yaml")["repositories"].values():
        release = repository.get("release", {})
        for name in release.get("packages", []) if "version" in release else []:
            released[name] = "ros-noetic-" + name.replace("_", "-")
    for name, repository in show("noetic/distribution.yaml")["repositories"].items():
        release = repository.get("release", {})
        if "version" in release and "packages" not in release:
            released[name] = "ros-noetic-" + name.replace("_", "-")
    commit = subprocess.run(["git", "-C", folder, "log", "-1", "--format=%h of %cs"], check=True, stdout=subprocess.PIPE,
                            universal_newlines=True).stdout.strip()
    with open(RULES, "w", encoding="utf-8") as file:
        file.write("# Which packages rosdep installs for the keys of package.xml, by ros/rosdistro %s.\n"
                   "# test/package_xml_test.py --renew writes this file.\n" % commit)
        for key in keys():
            if key in released:
                row = {"noetic": [released[key]]}
            else:
                rule = rules.get(key, {})
                row = {"focal": packages_of(rule, "ubuntu", "focal"), "bookworm": packages_of(rule, "debian", "bookworm")}
            file.write("%s: %s\n" % (key, yaml.safe_dump(row, default_flow_style=True, width=1000).strip()))


def dependencies(column):
    """Packages of scripts/dependencies.txt: column 0 of Debian, 1 of Ubuntu."""
    with open(os.path.join(ROOT, "scripts", "dependencies.txt"), encoding="utf-8") as file:
        rows = [line.split("|") for line in file if line.strip() and not line.startswith("#")]
    return {row[column].split("[")[0].strip() for row in rows} - {"-"}


class PackageXml(unittest.TestCase):
    def setUp(self):
        with open(RULES, encoding="utf-8") as file:
            self.rules = yaml.safe_load(file)

    def test_rosdep_knows_every_key(self):
        for key in keys():
            with self.subTest(key):
                rule = self.rules.get(key)
                self.assertTrue(rule, "no rule (renew test/rosdep_rules.yaml, or take another key)")
                if "noetic" not in rule:
                    self.assertTrue(rule["focal"], "nothing for Ubuntu 20.04")
                    self.assertTrue(rule["bookworm"], "nothing for Debian 12")

    def installed(self, system):
        found = {package for key in keys() for package in self.rules[key].get("noetic") or self.rules[key][system]}
        found = found.union(*(brought for package, brought in BROUGHT.items() if package in found))
        return found | {package for package, key in OF_ROS.items() if key in keys()}

    def test_rosdep_installs_what_the_build_needs_on_noetic(self):
        missing = dependencies(1) - self.installed("focal") - OF_EVERY_WORKSPACE - OF_TESTS - WITHOUT_RULE
        self.assertEqual(missing, set())

    def test_rosdep_installs_the_libraries_on_debian(self):
        """Packages of ROS itself are Debian's there, and rosdep has no rules for them: scripts/dependencies.txt has."""
        libraries = {p for p in dependencies(0) & dependencies(1) if not p.startswith("ros-")}
        self.assertEqual(libraries - self.installed("bookworm") - OF_EVERY_WORKSPACE - OF_TESTS - WITHOUT_RULE, set())


if __name__ == "__main__":
    if sys.argv[1:2] == ["--renew"]:
        renew(sys.argv[2])
    else:
        unittest.main()
