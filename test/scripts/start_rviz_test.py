#!/usr/bin/env python3
"""start_rviz.py: a file for rviz that shows a rover named rover shows another one; when rviz smooths its edges."""
import os
import subprocess
import sys
import tempfile
import unittest

import yaml

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(ROOT, "scripts"))
from start_rviz import adapted, processor_draws  # noqa: E402

with open(os.path.join(ROOT, "rviz", "rover.rviz"), encoding="utf-8") as file:
    TEXT = file.read()


class RoverRviz(unittest.TestCase):
    def test_its_own_rover_changes_nothing(self):
        self.assertEqual(adapted(TEXT, "rover", "rover"), TEXT)

    def test_topics_and_frames_of_another(self):
        text = adapted(TEXT, "scout", "mars/scout")
        display = {d["Name"]: d for d in yaml.safe_load(text)["Visualization Manager"]["Displays"]}
        self.assertIn("scout/odom", [d.get("Topic") for d in display.values()])
        self.assertIn("scout/robot_description", [d.get("Robot Description") for d in display.values()])
        views = yaml.safe_load(text)["Visualization Manager"]["Views"]
        self.assertEqual(views["Current"]["Target Frame"], "mars/scout/base_footprint")
        self.assertNotRegex(text, r": rover/")
        self.assertEqual(text.count("desert_sim/"), TEXT.count("desert_sim/"), "the desert is the same")

    def test_frames_without_a_prefix(self):
        self.assertIn("Target Frame: base_footprint\n", adapted(TEXT, "rover", ""))

    def test_what_draws(self):
        with tempfile.TemporaryDirectory() as devices:
            self.assertTrue(processor_draws({}, devices), "there is no card")
            os.mkdir(os.path.join(devices, "dri"))
            open(os.path.join(devices, "dri", "card0"), "w", encoding="utf-8").close()
            self.assertTrue(processor_draws({}, devices), "a screen is no card")
            open(os.path.join(devices, "nvidia0"), "w", encoding="utf-8").close()
            self.assertFalse(processor_draws({}, devices))
            self.assertTrue(processor_draws({"LIBGL_ALWAYS_SOFTWARE": "1"}, devices))
            self.assertFalse(processor_draws({"LIBGL_ALWAYS_SOFTWARE": "0"}, devices))

    def test_what_rviz_is_started_with(self):
        def command(*options, **environment):
            with tempfile.TemporaryDirectory() as folder:
                rviz = os.path.join(folder, "rviz")
                with open(rviz, "w", encoding="utf-8") as file:
                    file.write("#!/bin/sh\necho \"$@\"\n")
                os.chmod(rviz, 0o755)
                environment = dict(os.environ, PATH=folder + os.pathsep + os.environ["PATH"], **environment)
                command = [sys.executable, os.path.join(ROOT, "scripts", "start_rviz.py")]
                return subprocess.run([*command, "--config", os.path.join(ROOT, "rviz", "desert_sim.rviz"), *options],
                                      env=environment, check=True, capture_output=True, text=True).stdout.split()[2:]
        self.assertEqual(command("-f", "map", LIBGL_ALWAYS_SOFTWARE="1"), ["-f", "map", "--disable-anti-aliasing"])
        self.assertEqual(command("--anti-aliasing", "on", LIBGL_ALWAYS_SOFTWARE="1"), [])
        self.assertEqual(command("--anti-aliasing", "off"), ["--disable-anti-aliasing"])
        self.assertEqual(command("--disable-anti-aliasing"), ["--disable-anti-aliasing"], "once")


if __name__ == "__main__":
    unittest.main()
