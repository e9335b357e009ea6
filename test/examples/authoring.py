#!/usr/bin/env python3
"""The scripts of examples/authoring make their landscapes in a node, and what they save loads again."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

import desert_sim
import rospy
import rostest
from desert_sim.testing import PATIENCE

SCRIPTS = pathlib.Path(os.path.abspath(__file__)).parents[2] / "examples" / "authoring"
SCALE, STEPS = 0.25, 40


class Authoring(unittest.TestCase):
    def setUp(self):
        self.desert = desert_sim.Simulation(timeout=60 * PATIENCE)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(rospy.get_param("/desert_sim/data_dir"), ignore_errors=True)

    def make(self, script, name, width, height):
        """Runs a script, loads what it has saved into a node that shows something else, and returns its layers."""
        done = subprocess.run([sys.executable, str(SCRIPTS / script), "_scale:=%g" % SCALE, "_steps:=%d" % STEPS],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        self.assertEqual(done.returncode, 0, done.stdout)
        said = re.search(r"step (\d+), state ([0-9a-f]{16}): (\S+)", done.stdout)
        self.assertTrue(said, done.stdout)
        self.assertTrue(said[3].endswith("/%s/scenario.yaml" % name), said[3])
        self.assertEqual(self.desert.step(0).state_hash, said[2])
        later = self.desert.step(3).state_hash
        self.assertNotEqual(self.desert.load_scenario("plain", ["grid.width=8", "grid.height=8"]).state_hash, said[2])
        self.assertEqual(self.desert.load_scenario(name).state_hash, said[2])
        self.assertEqual(self.desert.status().scenario, name)
        state = self.desert.step(3)
        self.assertEqual((state.step, state.state_hash), (int(said[1]) + 3, later), "it goes on with the same bits")
        return {layer: found.values for layer, found in self.desert.submap(
            (width * SCALE / 2, height * SCALE / 2), (width * SCALE, height * SCALE)).items()}

    def test_figure_1(self):
        layers = self.make("figure_1.py", "figure_1", 256, 192)
        self.assertEqual(layers["elevation"].shape, (48, 64))
        self.assertGreater(layers["sand_depth"].max(), 2.2, "heaps on a sheet of at most that depth")
        self.assertGreater(layers["bedrock"].max(), 1)
        self.assertGreater(layers["vegetation"].max(), 0.8)

    def test_oasis(self):
        layers = self.make("oasis.py", "my_oasis", 192, 144)
        self.assertEqual(layers["elevation"].shape, (36, 48))
        self.assertGreater(layers["water_depth"].max(), 0.5)
        self.assertGreater(layers["vegetation"].max(), 0, "plants live there")
        self.assertLess(layers["bedrock"].min(), -5)


if __name__ == "__main__":
    rospy.init_node("authoring")
    rostest.rosrun("desert_sim", "authoring", Authoring)
