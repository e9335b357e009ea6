#!/usr/bin/env python3
"""Measures a node that has much to do: how fast it is while subscribers do not read or come and go, how long requests wait
for steps, and how soon it ends."""
import os
import signal
import statistics
import subprocess
import threading
import time

from answers import ENDLESS_STEP, simulated_for
from desert_sim.msg import ElevationGrid, SimulationStatus
from desert_sim.srv import QueryTerrain, Step
from desert_sim.testing import PATIENCE, wait_until
from geometry_msgs.msg import Point
from nav_msgs.msg import OccupancyGrid
from node_tests import CORNER, Scenarios, autosaves
import rospy
import rostest
from std_srvs.srv import Trigger

LARGE = {"scenario": CORNER, "settings": ["grid.width=512", "grid.height=512"], "step_rate": 0}
MANY = 4000000000  # steps: nobody waits for their end
SHUTDOWN = 5 * PATIENCE  # [s]; what it took is printed: under one on a machine that does nothing else


class Counter:
    """How many messages have come on a topic, and the last one."""

    def __init__(self, topic, kind):
        self.count, self.last = 0, None
        self.subscriber = rospy.Subscriber(topic, kind, self.take, queue_size=1)

    def take(self, message):
        self.count += 1
        self.last = message

    def wait(self):
        wait_until(lambda: self.count, "no message on " + self.subscriber.name)
        return self.last


class OverloadTiming(Scenarios):
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

    def test_subscribers_that_do_not_read_slow_nobody_down(self):
        self.start("unread", {"scenario": CORNER, "settings": ["grid.width=256", "grid.height=256"], "paused": False,
                              "step_rate": 0, "keyframe_rate": 20, "update_rate": 20, "update_threshold": 0,
                              "status_rate": 20, "points_rate": 20})
        topics = ["elevation", "elevation_updates", "points"]
        keyframe = Counter("/unread/elevation", rospy.AnyMsg)
        status = Counter("/unread/status", SimulationStatus)
        stopped = [self.reader("/unread/" + name) for name in topics]
        status.wait()
        steps, keyframes = {True: [], False: []}, {True: [], False: []}
        for stop in (False, True, False, True, False, True):
            for reader in stopped:
                reader.send_signal(signal.SIGSTOP if stop else signal.SIGCONT)
            time.sleep(0.2)
            start, before = time.monotonic(), (status.last.step, keyframe.count)
            time.sleep(1.5)
            taken = time.monotonic() - start
            steps[stop].append((status.last.step - before[0]) / taken)
            keyframes[stop].append((keyframe.count - before[1]) / taken)
        print("steps a second: %s while all read, %s while some do not; keyframes a second: %s and %s" % tuple(
            ["%.2f" % n for n in numbers] for numbers in (steps[False], steps[True], keyframes[False], keyframes[True])))
        self.assertGreater(statistics.median(steps[True]), 0.5 * statistics.median(steps[False]))
        self.assertGreater(statistics.median(keyframes[True]), 0.5 * statistics.median(keyframes[False]))

    def test_keyframes_come_at_their_rate_though_subscribers_join(self):
        self.start("joined", {"scenario": CORNER, "paused": False, "step_rate": 20, "costmap_keyframe_rate": 0.5})
        maps = Counter("/joined/costmap", OccupancyGrid)
        maps.wait()
        guests = [subprocess.Popen(["rostopic", "echo", "-n", "1", "--noarr", "/joined/costmap"], stdout=subprocess.DEVNULL)
                  for _ in range(8)]
        for guest in guests:
            self.assertEqual(guest.wait(60 * PATIENCE), 0)
        seen, start = maps.count, time.monotonic()
        wait_until(lambda: maps.count >= seen + 2, "the keyframes stay away")
        self.assertLess(time.monotonic() - start, 8 * PATIENCE, "one in two seconds")

    # ---- between two steps ---------------------------------------------------------------------

    def test_a_query_waits_for_no_more_than_a_few_steps(self):
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
        self.assertLess(statistics.median(waits), 4 * taken)
        asked = time.monotonic()
        self.assertTrue(self.nodes[-1].call("pause", Trigger).success)
        print("a pause waits %.0f ms" % (1000 * (time.monotonic() - asked)))
        thread.join(60 * PATIENCE)
        self.assertEqual(len(answers), 1)

    def test_a_long_step_holds_up_neither_answers_nor_the_end(self):
        node = self.start("long", dict(ENDLESS_STEP, step_rate=0, answer_timeout=0.5), preexec=None)
        rospy.wait_for_service("/long/set_parameters", 600)
        before = simulated_for(node)
        wait_until(lambda: node.call("resume", Trigger).success, "it does not resume")
        wait_until(lambda: simulated_for(node) > before + 0.2, "no step begins")
        start = time.monotonic()
        answer = node.call("query_terrain", QueryTerrain, points=[Point(20, 20, 0)])
        print("a query was refused after %.2f s" % (time.monotonic() - start))
        self.assertIn("has been busy with a step", answer.message)
        self.assertLess(time.monotonic() - start, 2 * PATIENCE)
        status, seconds = node.end(signal.SIGTERM)
        print("given up after %.2f s" % seconds)
        self.assertEqual(status, 4, node.output)
        self.assertLess(seconds, 5 + PATIENCE)

    # ---- ends ----------------------------------------------------------------------------------

    def expect_end(self, node, what, end, within=SHUTDOWN):
        end(node)
        start = time.monotonic()
        status, output = node.wait()
        seconds = time.monotonic() - start
        print("%s: ended after %.2f s" % (what, seconds))
        self.assertEqual(status, 0, output)
        self.assertLess(seconds, within, what)

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
            thread.join(60 * PATIENCE)
            self.assertEqual(len(answers), 1, "the client that waits is let go")

    def test_ends_while_paused(self):
        for name, end in (("interrupted", self.interrupt), ("terminated", self.terminate), ("dismissed", self.rosnode_kill)):
            node = self.start(name, {"scenario": CORNER})
            node.call("pause", Trigger)
            self.expect_end(node, name + " while paused", end)

    def test_ends_within_a_second_while_it_runs_and_serves(self):
        node = self.start("ending", {"scenario": CORNER, "paused": False, "step_rate": 0})
        thread, answers, _ = self.step_in_background("ending")
        self.expect_end(node, "interrupted while it runs and serves", self.interrupt, within=PATIENCE)
        thread.join(60 * PATIENCE)
        self.assertEqual(len(answers), 1)

    def test_ends_within_a_second_while_it_saves(self):
        node = self.start("saving", {"scenario": CORNER, "autosave_period": 0.01, "paused": False, "step_rate": 0,
                                     "data_dir": self.folder})
        wait_until(lambda: autosaves(self.folder), "no autosave")
        self.expect_end(node, "interrupted while it saves", self.interrupt, within=PATIENCE)


if __name__ == "__main__":
    rospy.init_node("overload_timing", disable_signals=True)
    rostest.rosrun("desert_sim", "overload_timing", OverloadTiming)
