#!/usr/bin/env python3
"""docker/ and conda/: that they install what scripts/dependencies.txt lists, and start what there is. (No image is built.)"""
import os
import re
import unittest
from xml.etree import ElementTree

from setup_test import packages, ROOT
import yaml


def text_of(*path):
    with open(os.path.join(ROOT, *path), encoding="utf-8") as file:
        return file.read()


class Images(unittest.TestCase):
    def setUp(self):
        self.text = text_of("docker", "Dockerfile")
        self.instructions = [line for line in self.text.splitlines() if line and not line.startswith("#")]

    def test_packages_come_from_the_one_list(self):
        installing = [line for line in self.instructions if re.search(r"apt|pip |conda|desert_install", line)]
        self.assertEqual(len(installing), 1, installing)
        self.assertIn("desert_install film", installing[0])

    def test_stages_copies_and_programs_exist(self):
        stages = set()
        for line in self.instructions:
            words = line.split()
            for other in re.findall(r"--from=(\S+)", line):
                self.assertIn(other, stages, line)
            if words[0] == "FROM":
                stages.add(words[-1])
            if words[0] == "COPY" and not words[1].startswith("--from"):
                for name in words[1:-1]:
                    self.assertTrue(os.path.exists(os.path.join(ROOT, name)), line)
            for name in re.findall(r"docker/\w+", line):
                self.assertTrue(os.access(os.path.join(ROOT, name), os.X_OK), line)
        self.assertLessEqual({"gpu", "cpu"}, stages)
        self.assertEqual(self.instructions[-2].split()[-1], "cpu", "what is built without --target")

    def test_nothing_that_an_image_needs_is_left_out(self):
        left_out = text_of(".dockerignore").split()
        self.assertEqual([name for name in left_out if os.path.exists(os.path.join(ROOT, name)) and name not in
                          {".git", "build", "devel", "install", "out"}], [])

    def launches(self, compose):
        """(launch file, {argument: value}) of each service that starts one."""
        for name, service in compose["services"].items():
            words = service.get("command", "").split()
            if words[:3] == ["roslaunch", "--wait", "desert_sim"]:
                yield words[3], dict(word.split(":=", 1) for word in words[4:])
            else:
                self.assertEqual((name, words), ("master", ["roscore"]))

    def test_services_start_launch_files_with_arguments_that_they_have(self):
        started = []
        for name in ("compose.yaml", "compose.gpu.yaml"):
            for launch, arguments in self.launches(yaml.safe_load(text_of("docker", name))):
                known = {arg.get("name") for arg in ElementTree.fromstring(text_of("launch", launch)).iter("arg")}
                self.assertLessEqual(set(arguments), known, launch)
                started.append(launch)
        self.assertEqual(started, ["bringup.launch", "planner.launch", "bringup.launch"])

    def test_services_find_each_other(self):
        services = yaml.safe_load(text_of("docker", "compose.yaml"))["services"]
        for name, service in services.items():
            self.assertEqual(service["hostname"], name)
            self.assertEqual(service["environment"], {"ROS_MASTER_URI": "http://master:11311", "ROS_HOSTNAME": name})
        gpu = yaml.safe_load(text_of("docker", "compose.gpu.yaml"))["services"]
        self.assertLessEqual(set(gpu), set(services))
        self.assertIn(" AS %s\n" % gpu["desert"]["build"]["target"], self.text)


class Recipe(unittest.TestCase):
    def test_its_list_is_that_of_the_dependencies(self):
        """Each line is a package of ROS, one that has the same name for conda, or names its packages in a comment."""
        named = set()
        requirements = text_of("conda", "meta.yaml").split("requirements:\n")[1].split("\ntest:")[0]
        for line in requirements.splitlines():
            entry = re.match(r"    - (.+?)\s*(?:# (.*))?$", line)
            if entry and entry[1] != "python":
                named |= set((entry[2] or entry[1]).split())
        self.assertEqual(named, packages("film", column=2) | {"libcli11-dev"})  # which Ubuntu 20.04 lacks

    def test_what_is_linked_is_there_when_it_runs(self):
        parts = re.split(r"\n  (build|host|run):\n", text_of("conda", "meta.yaml").split("\ntest:")[0])
        host, run = (set(re.findall(r"- (\S+)", parts[parts.index(name) + 1])) for name in ("host", "run"))
        only_for_builds = {"ros-noetic-catkin", "setuptools", "ros-noetic-message-generation", "eigen", "nlohmann_json",
                           "random123", "cli11"}
        self.assertEqual(host - run, only_for_builds)


if __name__ == "__main__":
    unittest.main()
