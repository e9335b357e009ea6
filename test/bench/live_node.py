"""What the publishing benchmark and the soak test share: a master, a node and subscribers of their own on two cores, and
what is measured of them. Needs the environment of build/devel/setup.bash."""
import json
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time

import rosgraph
import rospy
from desert_sim.msg import SimulationStatus

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support", "ros"))
from desert_sim.testing import Node, program  # noqa: E402, F401
from node_tests import PACKAGE  # noqa: E402, F401
from std_srvs.srv import Trigger  # noqa: E402, F401

CORES = 2
TICKS = os.sysconf("SC_CLK_TCK")


def two_cores():
    """This process, and all that it starts, on two cores."""
    cores = sorted(os.sched_getaffinity(0))[:CORES]
    os.sched_setaffinity(0, cores)
    return cores


def quantile(numbers, share):
    """NaN of nothing."""
    ordered = sorted(numbers)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))] if ordered else float("nan")


def median(numbers):
    return quantile(numbers, 0.5)


def cpu_seconds(path):
    """CPU time that /proc/PID/stat or /proc/PID/task/TID/stat tells."""
    with open(path) as file:
        fields = file.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / TICKS


def busy_seconds(cores):
    """CPU time that anybody has taken on these cores since the machine started."""
    total = 0
    with open("/proc/stat") as file:
        for line in file:
            words = line.split()
            if words[0] in ["cpu%d" % core for core in cores]:
                total += sum(int(words[n]) for n in (1, 2, 3, 6, 7, 8)) / TICKS  # all but idle and iowait
    return total


class Subscriber:
    """A process with a TerrainClient: bench/subscriber.cpp."""

    def __init__(self):
        self.process = subprocess.Popen([program("publishing_subscriber")], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        text=True)

    def say(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()

    def cpu(self):
        return cpu_seconds("/proc/%d/stat" % self.process.pid)

    def end(self):
        self.process.stdin.close()
        self.process.wait(20)


class LiveNode:
    """A master, a desert_sim_node with these private parameters, and subscribers, which are off at first."""

    def __init__(self, private, subscribers=3):
        self.cores = two_cores()
        self.folder = tempfile.mkdtemp(prefix="desert_sim_")
        with socket.socket() as free:
            free.bind(("localhost", 0))
            port = free.getsockname()[1]
        os.environ.update(ROS_MASTER_URI="http://localhost:%d" % port, ROS_HOSTNAME="localhost")
        os.environ.setdefault("OMP_WAIT_POLICY", "passive")  # both as in launch/desert_sim.launch
        os.environ.setdefault("GOMP_SPINCOUNT", "5000")
        os.environ.pop("ROS_IP", None)
        self.master = subprocess.Popen(["rosmaster", "--core", "-p", str(port)], stdout=subprocess.DEVNULL)
        try:
            while not rosgraph.is_master_online():
                if self.master.poll() is not None:
                    raise RuntimeError("rosmaster ended with %d" % self.master.returncode)
                time.sleep(0.1)
            rospy.init_node("live_node", disable_signals=True)
            self.node = Node("desert_sim", dict({"backend": "cpu", "threads": CORES, "data_dir": self.folder}, **private))
            self.subscribers = [Subscriber() for _ in range(subscribers)]
            self.status()
        except BaseException:
            self.close()
            raise

    def close(self):
        rospy.signal_shutdown("done")
        for subscriber in getattr(self, "subscribers", []):
            subscriber.end()
        if hasattr(self, "node") and self.node.process.poll() is None:
            self.node.end()
        self.master.terminate()
        self.master.wait()
        shutil.rmtree(self.folder)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def status(self):
        """A new one; its step is that of its stamp."""
        return self.node.latest("status", SimulationStatus, 30)

    def subscribe(self, counts_bytes=False):
        """The first of them may also count the bytes of its messages, which costs it a subscription more."""
        for n, subscriber in enumerate(self.subscribers):
            subscriber.say("on, with bytes" if counts_bytes and n == 0 else "on")

    def sent(self):
        """What each of the subscribers was sent since this was last asked."""
        for subscriber in self.subscribers:
            subscriber.say("report")
        return [json.loads(subscriber.process.stdout.readline()) for subscriber in self.subscribers]

    def unsubscribe(self):
        for subscriber in self.subscribers:
            subscriber.say("off")

    def memory(self):
        """Resident [bytes]."""
        with open("/proc/%d/statm" % self.node.process.pid) as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGESIZE")

    def cpu(self):
        """CPU seconds since the start: of the node's threads that simulate, of its others, of subscribers, of all
        programs on the two cores."""
        simulation = others = 0.0
        tasks = "/proc/%d/task" % self.node.process.pid
        for task in os.listdir(tasks):
            try:
                with open("%s/%s/comm" % (tasks, task)) as file:
                    simulates = file.read().strip() == "simulation"
                seconds = cpu_seconds("%s/%s/stat" % (tasks, task))
            except FileNotFoundError:  # it ended meanwhile
                continue
            simulation, others = (simulation + seconds, others) if simulates else (simulation, others + seconds)
        return simulation, others, sum(s.cpu() for s in self.subscribers), busy_seconds(self.cores)
