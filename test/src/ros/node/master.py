#!/usr/bin/env python3
"""A master that dies and comes back, while a node runs. The master is this test's own, not rostest's. (That the node is as
fast without it is measured by master_timing.py.)"""
import signal

from desert_sim.msg import ElevationUpdate, SimulationStatus
from desert_sim.srv import QueryTerrain, Step
from desert_sim.testing import PATIENCE, Master as OwnMaster, wait_until
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import Point
from node_tests import CORNER, Scenarios, autosaves
import rospy
import rostest
from std_srvs.srv import Trigger


class Master(Scenarios):
    def setUp(self):
        super().setUp()
        if MASTER.process.poll() is not None:
            MASTER.start()
        self.journal = self.path("journal.yaml")
        self.node = self.start("orphan", {"scenario": CORNER, "paused": False, "step_rate": 200, "update_rate": 50,
                                          "status_rate": 50, "diagnostic_period": 0.05, "journal": self.journal,
                                          "data_dir": self.folder, "autosave_period": 0.1})
        self.updates, self.statuses, self.diagnostics = [], [], {}
        self.subscribers = [rospy.Subscriber("/orphan/elevation_updates", ElevationUpdate, self.updates.append),
                            rospy.Subscriber("/orphan/status", SimulationStatus, self.statuses.append),
                            rospy.Subscriber("/diagnostics", DiagnosticArray, self.on_diagnostics)]
        # A call over a new connection looks the service up at the master.
        self.query = rospy.ServiceProxy("/orphan/query_terrain", QueryTerrain, persistent=True)
        self.steps = rospy.ServiceProxy("/orphan/step", Step, persistent=True)
        self.pause = rospy.ServiceProxy("/orphan/pause", Trigger, persistent=True)
        self.reload = rospy.ServiceProxy("/orphan/reload_parameters", Trigger, persistent=True)
        rospy.wait_for_service("/orphan/reload_parameters", 60 * PATIENCE)  # the last to be advertised
        for proxy in (self.steps, self.reload, self.pause):
            self.assertTrue(proxy().success)
        self.assertTrue(self.node.call("resume", Trigger).success)
        self.go_on()

    def tearDown(self):
        for subscriber in self.subscribers:
            subscriber.unregister()
        for proxy in (self.query, self.steps, self.pause, self.reload):
            proxy.close()
        super().tearDown()

    def on_diagnostics(self, message):
        for status in message.status:
            self.diagnostics[status.name] = status.level

    def health(self, part):
        return self.diagnostics.get("orphan: " + part)

    def go_on(self):
        """The node steps, and tells those who are connected."""
        steps, updates = self.step(), len(self.updates)
        wait_until(lambda: self.step() >= steps + 20, "it does not step")
        wait_until(lambda: len(self.updates) >= updates + 5, "subscribers are not served")
        self.assertEqual(self.statuses[-1].state, "running")
        self.assertTrue(self.query(points=[Point(20, 20, 0)]).success)

    def step(self):
        return self.statuses[-1].step if self.statuses else 0

    def test_dies_and_comes_back(self):
        wait_until(lambda: self.health("master") == DiagnosticStatus.OK, "diagnostics do not say that the master is there")
        MASTER.kill()
        self.go_on()
        answer = self.reload()
        self.assertFalse(answer.success, "the parameters are gone with the master, which is no wish to change them")
        self.assertIn("master", answer.message)
        wait_until(lambda: self.health("master") == DiagnosticStatus.WARN, "diagnostics do not say that the master is gone")
        MASTER.start()
        self.go_on()
        wait_until(lambda: self.health("master") == DiagnosticStatus.ERROR,
                   "diagnostics do not say that the new master does not know the node")
        self.assertEqual(self.node.end(signal.SIGTERM)[0], 0, self.node.output)

    def expect_end(self, how):
        MASTER.kill()
        saved = autosaves(self.folder)
        self.go_on()
        wait_until(lambda: autosaves(self.folder) != saved, "no autosave without a master")
        self.assertTrue(self.pause().success)
        live = self.steps(0).state_hash
        self.assertEqual(self.node.end(how)[0], 0, self.node.output)
        self.assertEqual(self.run_without_ros(CORNER, "--replay", self.journal), live)

    def test_is_terminated_without_a_master(self):
        self.expect_end(signal.SIGTERM)

    def test_is_interrupted_without_a_master(self):
        self.expect_end(signal.SIGINT)


if __name__ == "__main__":
    MASTER = OwnMaster()
    try:
        rospy.init_node("master_test", disable_signals=True)
        rostest.rosrun("desert_sim", "master", Master)
    finally:
        MASTER.kill()
