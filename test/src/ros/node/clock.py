#!/usr/bin/env python3
"""Under use_sim_time the simulation follows ROS time: not there yet, running, standing still, jumping."""
import unittest

import rospy
import rostest
from desert_sim.msg import ElevationGrid, SimulationStatus
from desert_sim.srv import QueryTerrain
from desert_sim.testing import wait_until
from geometry_msgs.msg import Point, TransformStamped
from node_tests import ScriptedClock
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage

RATE = 512  # steps a second, as in clock.test
TICK = 1 / 32
LATE = 1e-4  # [s] of a tick, so that rounding does not put a step behind it


class FollowsTheClock(unittest.TestCase):
    def setUp(self):
        self.clock = ScriptedClock()
        self.statuses = []
        rospy.Subscriber("/desert_sim/status", SimulationStatus, self.statuses.append)
        wait_until(lambda: self.statuses, "no status")
        self.steps = 0

    def shows(self, seconds, steps, what):
        """At this time the simulation makes so many steps more and then no other, as the next statuses say. The last one."""
        self.clock.show(seconds)
        self.steps += steps
        wait_until(lambda: self.statuses[-1].step >= self.steps, what)
        seen = len(self.statuses)
        wait_until(lambda: len(self.statuses) >= seen + 2, "no status")
        for status in self.statuses[seen:]:
            self.assertEqual((status.step, status.state), (self.steps, "running"), what)
        return self.statuses[-1]

    def ticks(self, start, seconds):
        """Time goes on from `start`, which it shows already; the first step was made there."""
        for n in range(1, int(seconds / TICK) + 1):
            status = self.shows(start + n * TICK + LATE, TICK * RATE, "the steps of a tick")
            self.assertEqual(status.header.stamp, self.clock.now)
            self.assertEqual(status.lag, 0)

    def test_clock(self):
        wait_until(lambda: self.statuses[-1].state == "waiting", "no clock yet")
        self.assertEqual(self.statuses[-1].step, 0)
        self.clock.show(1000)
        wait_until(lambda: self.statuses[-1].state == "running", "the clock is there")
        self.shows(1000, 1, "the first step is due at once")
        self.ticks(1000, 0.25)

        for _ in range(4):  # as a bag does that is played in a loop
            self.shows(500, 1, "a jump back begins the schedule anew")
            self.ticks(500, 0.125)
        keyframe = rospy.wait_for_message("/desert_sim/elevation", ElevationGrid, None)
        self.assertEqual((keyframe.step, keyframe.header.stamp), (self.steps, self.clock.now), "stamps are ROS time")

        status = self.shows(100000, RATE + 1, "a jump ahead is caught up for a second")
        self.assertAlmostEqual(status.lag, 100000 - 500 - 0.125 - 1, delta=0.01, msg="and the rest is told as lag")
        self.jump_by_a_century()

    def jump_by_a_century(self):
        """A difference of times that a ros::Duration cannot hold; transforms come all the while."""
        transforms = rospy.Publisher("/tf", TFMessage, queue_size=10)

        def finds(frame):
            transform = TransformStamped()
            transform.header.stamp = self.clock.now
            transform.header.frame_id, transform.child_frame_id = "map", frame
            transform.transform.rotation.w = 1
            transforms.publish(TFMessage([transform]))
            query = rospy.ServiceProxy("/desert_sim/query_terrain", QueryTerrain)
            return query(Header(frame_id=frame), [Point(20, 20, 0)]).success

        for n, (seconds, steps) in enumerate(((4000000000, RATE + 1), (10, 1), (4200000000, RATE + 1), (20, 1))):
            self.shows(seconds, steps, "a century")
            wait_until(lambda: finds("rover_%d" % n), "it has no transform")  # noqa: B023


if __name__ == "__main__":
    rospy.init_node("clock_test", disable_signals=True)
    rostest.rosrun("desert_sim", "clock", FollowsTheClock)
