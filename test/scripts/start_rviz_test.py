#!/usr/bin/env python3
"""rover_rviz.py: a file for rviz that shows a rover named rover shows another one."""
import os
import sys
import unittest

import yaml

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(ROOT, "scripts"))
from rover_rviz import adapted  # noqa: E402

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


if __name__ == "__main__":
    unittest.main()
