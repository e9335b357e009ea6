#!/usr/bin/env python3
"""Measures whether run.acceleration keeps the desert's clock at its pace to the wall's, and steps evenly spread; whether a
desert that is the clock itself goes as fast as the wall's."""
import time

from desert_sim.msg import ElevationUpdate, SimulationStatus
from desert_sim.testing import PATIENCE, wait_until
from dynamic_reconfigure.client import Client
from map_client import Listener
from node_tests import CORNER, Scenarios
from rosgraph_msgs.msg import Clock
import rospy
import rostest

STEP = 0.0625  # [s]


class TwoClocks(Scenarios):
    def setUp(self):
        super().setUp()
        rospy.set_param("/use_sim_time", False)

    def tearDown(self):
        rospy.set_param("/use_sim_time", False)
        super().tearDown()

    def tied(self, name, acceleration, **private):
        """A client of dynamic_reconfigure of a node of this acceleration."""
        run = {"time_step": STEP, "acceleration": acceleration}
        self.start(name, dict({"scenario": CORNER, "run": run, "paused": False, "status_rate": 20}, **private))
        return Client("/" + name, timeout=60 * PATIENCE)

    def pace(self, statuses, seconds):
        """Simulated seconds per second of ROS time between two states, as their messages tell."""
        first = len(statuses.messages)
        wait_until(lambda: len(statuses.messages) > first + 1, "no status")
        start = statuses.messages[-1]
        wait_until(lambda: (statuses.messages[-1].header.stamp - start.header.stamp).to_sec() >= seconds, "time stands")
        end = statuses.messages[-1]
        return (end.sim_time - start.sim_time) / (end.header.stamp - start.header.stamp).to_sec()

    def test_the_desert_keeps_pace_with_the_wall(self):
        client = self.tied("paced", 2.0, update_rate=1000, update_threshold=0.0, step_rate=3)
        with Listener("/paced/elevation_updates", ElevationUpdate) as updates, \
                Listener("/paced/status", SimulationStatus) as statuses:
            self.assertAlmostEqual(self.pace(statuses, 4), 2, delta=0.1)
            self.assertLess(statuses.messages[-1].lag, 0.5)
            stamps = sorted({m.header.stamp.to_sec() for m in updates.messages})
            gaps = sorted(later - earlier for earlier, later in zip(stamps, stamps[1:]))
            self.assertAlmostEqual(gaps[len(gaps) // 2], 1 / 32, delta=0.01, msg="evenly spread")

            self.assertEqual(client.update_configuration({"run__acceleration": 0.5})["run__acceleration"], 0.5)
            self.assertAlmostEqual(self.pace(statuses, 4), 0.5, delta=0.025 + STEP / 4)
            client.update_configuration({"run__time_step": STEP / 4})
            self.assertAlmostEqual(self.pace(statuses, 4), 0.5, delta=0.025 + STEP / 16)

    def test_its_own_clock_goes_as_fast_as_the_walls(self):
        rospy.set_param("/use_sim_time", True)
        self.tied("owner", 4.0, publish_clock=True)
        with Listener("/clock", Clock) as clock:
            first, start = clock.first("the start").clock, time.monotonic()
            clock.wait_for(lambda m: (m.clock - first).to_sec() >= 3, "time stands")
            self.assertAlmostEqual(time.monotonic() - start, 3, delta=0.5 * PATIENCE)


if __name__ == "__main__":
    rospy.init_node("two_clocks_timing", disable_signals=True)
    rostest.rosrun("desert_sim", "two_clocks_timing", TwoClocks)
