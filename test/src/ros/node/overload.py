#!/usr/bin/env python3
"""A large terrain with subscribers that do not read, with a request of many steps under way, and ended in the middle of
it all: the simulation goes on, others are served between two steps, memory stays bounded, and the node ends at once."""
import os
import resource
import signal
import statistics
import subprocess
import threading
import time

from desert_sim.msg import ElevationGrid, SimulationStatus
from desert_sim.srv import QueryTerrain, Step
from desert_sim.testing import PATIENCE, wait_until
from geometry_msgs.msg import Point
from node_tests import CORNER, Scenarios
import rospy
import rostest
from std_srvs.srv import Trigger

LARGE = {"scenario": CORNER, "settings": ["grid.width=512", "grid.height=512"], "step_rate": 0}
MANY = 100000
SHUTDOWN = 5 * PATIENCE  # [s]; what it took is printed: under one on a machine that does nothing else


class Counter:
    """How many messages have come on a topic, and how many bytes if it is one of AnyMsg."""

    def __init__(self, topic, kind):
        self.count, self.bytes, self.last = 0, 0, None
        self.subscriber = rospy.Subscriber(topic, kind, self.take, queue_size=1)

    def take(self, message):
        self.count += 1
        self.bytes += len(message._buff) if isinstance(message, rospy.AnyMsg) else 0
        self.last = message

    def wait(self):
        wait_until(lambda: self.count, "no message on " + self.subscriber.name)
        return self.last


class Overload(Scenarios):
    def setUp(self):
        super().setUp()
        self.readers = []

    def tearDown(self):
        for reader in self.readers:
            reader.kill()  # stopped ones too
            reader.wait()
        super().tearDown()

    def reader(self, topic):
        """A subscriber in a process of its own, which can be stopped; reads already."""
        self.readers.append(subprocess.Popen(["rostopic", "bw", topic], stdout=subprocess.PIPE, text=True, bufsize=1,
                                             env=dict(os.environ, PYTHONUNBUFFERED="1")))
        for line in self.readers[-1].stdout:
            if line.startswith("average"):
                return self.readers[-1]
        self.fail("rostopic bw %s has ended" % topic)

    def memory(self, node):
        with open("/proc/%d/statm" % node.process.pid) as file:
            return int(file.read().split()[1]) * resource.getpagesize()

    def step_in_background(self, name):
        """A call for many steps that is under way, and the list that its answer will be in."""
        answers = []

        def call():
            try:
                answers.append(rospy.ServiceProxy("/%s/step" % name, Step)(MANY))
            except rospy.ServiceException as e:
                answers.append(e)

        status = Counter("/%s/status" % name, SimulationStatus)
        before = status.wait().step
        thread = threading.Thread(target=call)
        thread.start()
        wait_until(lambda: status.last.step >= before + 2, "it does not step")
        return thread, answers, status

    # ---- subscribers ---------------------------------------------------------------------------

    def test_subscribers_that_do_not_read_hold_nobody_up(self):
        node = self.start("unread", {"scenario": CORNER, "settings": ["grid.width=256", "grid.height=256"], "paused": False,
                                     "step_rate": 0, "keyframe_rate": 20, "update_rate": 20, "update_threshold": 0,
                                     "status_rate": 20, "points_rate": 20})
        topics = ["elevation", "elevation_updates", "points"]
        readers = {name: Counter("/unread/" + name, rospy.AnyMsg) for name in topics}
        status = Counter("/unread/status", SimulationStatus)
        stopped = [self.reader("/unread/" + name) for name in topics]
        status.wait()
        steps, keyframes, kept = {True: [], False: []}, {True: [], False: []}, []
        for stop in (False, True, False, True, False, True):
            for reader in stopped:
                reader.send_signal(signal.SIGSTOP if stop else signal.SIGCONT)
            time.sleep(0.2)
            start, memory = time.monotonic(), self.memory(node)
            before = status.last.step, readers["elevation"].count, sum(r.bytes for r in readers.values())
            time.sleep(1.5)
            taken = time.monotonic() - start
            steps[stop].append((status.last.step - before[0]) / taken)
            keyframes[stop].append((readers["elevation"].count - before[1]) / taken)
            if stop:
                kept.append((self.memory(node) - memory) / (sum(r.bytes for r in readers.values()) - before[2]))
        print("steps a second: %s while all read, %s while some do not; keyframes a second: %s and %s; the memory grew by "
              "%s of what was published" % tuple(["%.2f" % n for n in numbers] for numbers in (
                  steps[False], steps[True], keyframes[False], keyframes[True], kept)))
        self.assertGreater(statistics.median(steps[True]), 0.5 * statistics.median(steps[False]))
        self.assertGreater(statistics.median(keyframes[True]), 0.5 * statistics.median(keyframes[False]))
        self.assertLess(statistics.median(kept), 0.5)
        self.assertEqual(node.end()[0], 0, node.output)

    # ---- between two steps ---------------------------------------------------------------------

    def test_others_are_served_between_two_of_many_steps(self):
        self.start("stepping", dict(LARGE, status_rate=50))
        self.nodes[-1].call("step", Step, 1)
        query = rospy.ServiceProxy("/stepping/query_terrain", QueryTerrain, persistent=True)
        query(points=[Point(20, 20, 0)])
        thread, answers, status = self.step_in_background("stepping")
        first, start, waits = status.last.step, time.monotonic(), []
        for _ in range(8):
            asked = time.monotonic()
            self.assertTrue(query(points=[Point(20, 20, 0)]).success)
            waits.append(time.monotonic() - asked)
            time.sleep(0.15)  # or it is given a copy that it has been given already
        taken = (time.monotonic() - start) / max(1, status.last.step - first)
        print("a step takes %.0f ms; a query waits %s ms" % (1000 * taken, ["%.0f" % (1000 * w) for w in waits]))
        self.assertGreater(status.last.step, first, "steps and queries take turns")
        self.assertLess(statistics.median(waits), 4 * taken)
        asked = time.monotonic()
        self.assertTrue(self.nodes[-1].call("pause", Trigger).success)
        print("a pause waits %.0f ms" % (1000 * (time.monotonic() - asked)))
        thread.join(20)
        self.assertFalse(answers[0].success)
        self.assertIn("ended by a pause after", answers[0].message)

    # ---- ends ----------------------------------------------------------------------------------

    def expect_end(self, node, what, end):
        end(node)
        start = time.monotonic()
        status, output = node.wait()
        seconds = time.monotonic() - start
        print("%s: ended after %.2f s" % (what, seconds))
        self.assertEqual(status, 0, output)
        self.assertLess(seconds, SHUTDOWN, what)

    @staticmethod
    def interrupt(node):
        node.process.send_signal(signal.SIGINT)

    @staticmethod
    def terminate(node):
        node.process.send_signal(signal.SIGTERM)

    @staticmethod
    def rosnode_kill(node):
        subprocess.run(["rosnode", "kill", "/" + node.name], check=True, stdout=subprocess.DEVNULL, timeout=60 * PATIENCE)

    def test_ends_while_it_runs(self):
        for name, end in (("interrupted", self.interrupt), ("terminated", self.terminate), ("dismissed", self.rosnode_kill)):
            node = self.start(name, dict(LARGE, paused=False))
            node.latest("elevation", ElevationGrid)
            self.expect_end(node, name + " while it runs", end)

    def test_ends_while_many_steps_are_under_way(self):
        for name, end in (("interrupted", self.interrupt), ("dismissed", self.rosnode_kill)):
            node = self.start(name, LARGE)
            node.call("step", Step, 1)
            thread, answers, _ = self.step_in_background(name)
            self.expect_end(node, name + " while many steps are under way", end)
            thread.join(20)
            self.assertEqual(len(answers), 1, "the client that waits is let go")

    def test_ends_while_paused(self):
        for name, end in (("interrupted", self.interrupt), ("terminated", self.terminate), ("dismissed", self.rosnode_kill)):
            node = self.start(name, {"scenario": CORNER})
            node.call("pause", Trigger)
            self.expect_end(node, name + " while paused", end)


if __name__ == "__main__":
    rospy.init_node("overload", disable_signals=True)
    rostest.rosrun("desert_sim", "overload", Overload)
