"""What the tests of nodes share: nodes and files that go when a test ends, scenarios, and the autosaves that a node left."""
import contextlib
import glob
import json
import os
import shutil
import signal
import struct
import subprocess
import tempfile
import unittest

import rospkg
import rospy
import yaml
from desert_sim.testing import Node, program
from rosgraph_msgs.msg import Clock

PACKAGE = rospkg.RosPack().get_path("desert_sim")
CORNER, OASIS = (os.path.join(PACKAGE, "test", "support", "ros", "scenarios", name) for name in ("corner.yaml", "oasis.yaml"))


def without_alarm():
    """For Node(preexec=...): a node that is told to end sets an alarm, which gives up a step that takes too long. Here the
    alarm does not reach it, so that it ends by itself or never, however slow the machine is."""
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGALRM})


@contextlib.contextmanager
def held(process):
    """Keeps a process stopped; scripts/flakes, which stops and continues processes at random, leaves it alone."""
    held_file = "/tmp/desert_sim_held.%d" % process.pid
    with open(held_file, "w"):
        pass
    process.send_signal(signal.SIGSTOP)
    try:
        yield
    finally:
        os.unlink(held_file)
        process.send_signal(signal.SIGCONT)


class Scenarios(unittest.TestCase):
    """Nodes and files that go when a test ends. Nodes have no alarm, unless they are started with another `preexec`."""

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
        usual = {"backend": "cpu", "threads": 1, "paused": True, "answer_timeout": 600, "refresh_rate": 0}
        options.setdefault("preexec", without_alarm)
        node = Node(name, dict(usual, **private), **options)
        self.nodes.append(node)
        return node

    def of_program(self, name, private, executable):
        node = Node(name, private, executable=executable)
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


class ScriptedClock:
    """/clock as a test moves it. Nodes that start later are shown the present time, too."""

    def __init__(self):
        self.now = None
        self.publisher = rospy.Publisher("/clock", Clock, queue_size=1000, latch=True)

    def show(self, seconds):
        """It is so late."""
        self.now = rospy.Time.from_sec(seconds)
        self.publisher.publish(Clock(self.now))

    def close(self):
        """A node that is the clock refuses to be the second one."""
        self.publisher.unregister()


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
