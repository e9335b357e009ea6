"""Processes that a test starts: a ROS master, and nodes."""
import atexit
import os
import random
import signal
import socket
import subprocess
import sys
import threading
import time

import rosgraph
import rospy
from roslib.packages import find_node

# How much longer everything may take: with sanitizers, or on a machine that has much else to do.
PATIENCE = float(os.environ.get("DESERT_PATIENCE", 1))


def wait_until(happened, what, seconds=60):
    """Waits until `happened()` is true, at most so long (times PATIENCE); else AssertionError says `what`."""
    end = time.monotonic() + seconds * PATIENCE
    while not happened():
        assert time.monotonic() < end, what
        time.sleep(0.01)


def program(name, package="desert_sim"):
    """Path of a package's program, as rosrun finds it. AssertionError if there is none."""
    found = find_node(package, name)
    assert found, "no program %s in the package %s" % (name, package)
    return found[0]


# ---- master

def free_port():
    """A port below those that the kernel gives to connections of others, which could take it before the master does."""
    for port in random.sample(range(20000, 30000), 100):
        with socket.socket() as probe:
            try:
                probe.bind(("localhost", port))
                return port
            except OSError:
                pass
    raise OSError("none of 100 ports is free")


class Master:
    """A ROS master of this process and its children alone; the environment names it from now on."""

    def __init__(self):
        self.port = free_port()
        os.environ["ROS_MASTER_URI"] = "http://localhost:%d" % self.port
        os.environ["ROS_HOSTNAME"] = "localhost"
        os.environ.pop("ROS_IP", None)
        self.start()

    def start(self):
        self.process = subprocess.Popen(["rosmaster", "--core", "-p", str(self.port)], stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL)
        wait_until(rosgraph.is_master_online, "no master")

    def kill(self):
        self.process.kill()
        self.process.wait()


def _started_by_roslaunch():
    """rostest and roslaunch name the nodes that they start, and those have the master of the test."""
    return any(argument.startswith("__name:=") for argument in sys.argv)


def init_ros(name="desert_test"):
    """Makes this process a ROS node, if it is none yet. In a rostest its master is the test's; else it gets a master of its
    own on a free port, which ends with it: a test does not meddle with the robot whose master the environment names."""
    if rospy.core.is_initialized():
        return
    if not _started_by_roslaunch():
        atexit.register(Master().kill)
    rospy.init_node(name, anonymous=True, disable_signals=True)


# ---- nodes

class Node:
    """A node of its own. It ends with close(), with the `with` that it is used in, or at last with this process: also if a
    test fails before.

    name         full or relative name; a relative one is below /
    parameters   its private ones: all there were before are gone
    executable, package   what to run
    arguments    more arguments, such as remappings
    preexec      a function that is called in the new process before the program
    environment  what is added to the test's
    `process` is the subprocess.Popen, `output` what it has printed so far.
    """

    def __init__(self, name, parameters, executable="desert_sim_node", package="desert_sim", arguments=(), preexec=None,
                 environment=None):
        self.path = "/" + name.strip("/")
        self.name = self.path[1:]
        rospy.set_param(self.path, parameters)
        namespace, _, last = self.path.rpartition("/")
        self.process = subprocess.Popen(
            [program(executable, package), "__name:=" + last, "__ns:=" + (namespace or "/"), *arguments],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, preexec_fn=preexec,
            env=dict(os.environ, **(environment or {})))
        atexit.register(self.close)
        self.output = ""
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self):
        for line in self.process.stdout:
            self.output += line

    @property
    def running(self):
        return self.process.poll() is None

    def call(self, service, kind, *arguments, **fields):
        """The answer of one of its services, once that is there."""
        rospy.wait_for_service(self.path + "/" + service, 20 * PATIENCE)
        return rospy.ServiceProxy(self.path + "/" + service, kind)(*arguments, **fields)

    def latest(self, topic, kind, timeout=60):
        """A message of one of its topics; of those that show the terrain the present one."""
        return rospy.wait_for_message(self.path + "/" + topic, kind, timeout * PATIENCE)

    def wait(self, timeout=60):
        """Waits for its end; exit status and all output."""
        status = self.process.wait(timeout * PATIENCE)
        self._reader.join()
        self.process.stdout.close()
        return status, self.output

    def end(self, with_signal=signal.SIGINT):
        """Ends it; exit status and the seconds it took."""
        start = time.monotonic()
        self.process.send_signal(with_signal)
        status, _ = self.wait()
        return status, time.monotonic() - start

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        """Ends it if it still runs, by force if need be."""
        atexit.unregister(self.close)
        if self.running:
            try:
                self.end()
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.wait()
