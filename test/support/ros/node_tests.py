"""What the tests of nodes share: nodes and files that go when a test ends, scenarios, and the autosaves that a node left."""
import glob
import json
import os
import shutil
import struct
import subprocess
import tempfile
import unittest

import rospkg
import yaml
from desert_sim.testing import Node, program

PACKAGE = rospkg.RosPack().get_path("desert_sim")
CORNER, OASIS = (os.path.join(PACKAGE, "test", "support", "ros", "scenarios", name) for name in ("corner.yaml", "oasis.yaml"))


class Scenarios(unittest.TestCase):
    """Nodes and files that go when a test ends."""

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="desert_sim_")
        self.nodes = []

    def tearDown(self):
        for node in self.nodes:
            if node.running:
                node.process.kill()
                node.wait()
        shutil.rmtree(self.folder)

    def start(self, name, private, **options):
        usual = {"backend": "cpu", "threads": 1, "paused": True, "answer_timeout": 600}
        node = Node(name, dict(usual, **private), **options)
        self.nodes.append(node)
        return node

    def path(self, name, text=None):
        path = os.path.join(self.folder, name)
        if text is not None:
            with open(path, "w") as file:
                file.write(text)
        return path

    def run_without_ros(self, *arguments):
        """The state hash that desert_run ends with."""
        out = self.path("out")
        subprocess.run([program("desert_run"), *arguments, "--backend", "cpu", "--threads", "1", "--quiet", "--out", out],
                       check=True, timeout=600)
        with open(os.path.join(out, "summary.json")) as file:
            return json.load(file)["state_hash"]


def autosaves(folder):
    """Oldest first."""
    return sorted(glob.glob(os.path.join(folder, "autosave", "*.ckpt")))


def step_of(checkpoint):
    """The step of the state that a checkpoint holds. The file begins with a line of text, the version of its format
    (uint32) and the length (uint64) of a YAML header, which has the step."""
    with open(checkpoint, "rb") as file:
        file.readline()
        _, length = struct.unpack("<IQ", file.read(12))
        return yaml.safe_load(file.read(length))["steps"]


def saved_steps(folder):
    """The steps of all autosaves that there are."""
    steps = set()
    for path in autosaves(folder):
        try:
            steps.add(step_of(path))
        except FileNotFoundError:
            pass  # the node has removed it since the folder was listed
    return steps
