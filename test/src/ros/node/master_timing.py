#!/usr/bin/env python3
"""Measures how fast a node is, and how soon it ends, once its master is gone. The master is this test's own, not
rostest's."""
import signal
import time

from desert_sim.srv import Step
from desert_sim.testing import PATIENCE, Master as OwnMaster
from node_tests import CORNER, Scenarios
import rospy
import rostest

SHUTDOWN = 5  # [s]; what it took is printed: under one on a machine that does nothing else


class Master(Scenarios):
    def setUp(self):
        super().setUp()
        if MASTER.process.poll() is not None:
            MASTER.start()
        self.node = self.start("orphan", {"scenario": CORNER, "paused": False, "step_rate": 20, "data_dir": self.folder})
        rospy.wait_for_service("/orphan/step", 60 * PATIENCE)
        self.steps = rospy.ServiceProxy("/orphan/step", Step, persistent=True)

    def tearDown(self):
        self.steps.close()
        super().tearDown()

    def rate(self, seconds=2):
        """Steps a second of wall time."""
        first, start = self.steps(0).step, time.monotonic()
        time.sleep(seconds)
        return (self.steps(0).step - first) / (time.monotonic() - start)

    def test_it_is_as_fast_without(self):
        before = self.rate()
        MASTER.kill()
        without = self.rate()
        print("steps a second: %.1f with a master, %.1f without" % (before, without))
        self.assertGreater(without, 0.5 * before)

    def expect_end(self, how):
        self.steps(1)  # over a connection that needs no master
        MASTER.kill()
        status, seconds = self.node.end(how)
        print("%s: ended after %.2f s without a master" % (how.name, seconds))
        self.assertEqual(status, 0, self.node.output)
        self.assertLess(seconds, SHUTDOWN)

    def test_is_terminated_without_a_master(self):
        self.expect_end(signal.SIGTERM)

    def test_is_interrupted_without_a_master(self):
        self.expect_end(signal.SIGINT)


if __name__ == "__main__":
    MASTER = OwnMaster()
    try:
        rospy.init_node("master_timing", disable_signals=True)
        rostest.rosrun("desert_sim", "master_timing", Master)
    finally:
        MASTER.kill()
