#!/usr/bin/env python3
"""Under use_sim_time the simulation follows ROS time: not there yet, running, standing still, jumping back."""
import threading
import time
import unittest

import rospy
import rostest
from desert_sim.msg import ElevationGrid, SimulationStatus
from desert_sim.srv import QueryTerrain, Step
from desert_sim.testing import PATIENCE
from geometry_msgs.msg import Point, TransformStamped
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage


class FollowsTheClock(unittest.TestCase):
    def setUp(self):
        self.clock = rospy.Publisher("/clock", Clock, queue_size=10)
        self.changed = threading.Condition()
        self.status = None
        rospy.Subscriber("/desert_sim/status", SimulationStatus, self.on_status)

    def on_status(self, message):
        with self.changed:
            self.status = message
            self.changed.notify_all()

    def wait_for(self, fits, what, seconds=10):
        with self.changed:
            self.assertTrue(self.changed.wait_for(lambda: self.status and fits(self.status), seconds * PATIENCE), what)
            return self.status

    def tick(self, start, seconds, speed=2.0):
        """Runs the clock from `start` for `seconds`, `speed` times as fast as the wall's."""
        for n in range(int(seconds * 50) + 1):
            self.clock.publish(Clock(rospy.Time.from_sec(start + n / 50.0)))
            time.sleep(0.02 / speed)

    def steps(self):
        """Steps done, once there are no more to do for the time that the clock shows."""
        last = None
        while True:
            now = rospy.ServiceProxy("/desert_sim/step", Step)(0).step
            if now == last:
                return now
            last = now
            time.sleep(0.3)

    def test_clock(self):
        status = self.wait_for(lambda s: s.state == "waiting", "no clock yet")
        self.assertEqual(status.step, 0)
        deadline = time.monotonic() + 60 * PATIENCE
        while self.status.state != "running" and time.monotonic() < deadline:  # until the node listens
            self.tick(1000, 0)
        self.wait_for(lambda s: s.state == "running", "the clock is there")
        self.tick(1000, 2)
        after_two_seconds = self.steps()
        self.assertAlmostEqual(after_two_seconds, 21, delta=3)

        time.sleep(0.3)
        self.assertEqual(self.steps(), after_two_seconds, "the clock stands, so do the dunes")

        self.tick(500, 1)
        self.assertAlmostEqual(self.steps() - after_two_seconds, 11, delta=3, msg="goes on after a jump back")
        keyframe = rospy.wait_for_message("/desert_sim/elevation", ElevationGrid, None)
        self.assertTrue(500 <= keyframe.header.stamp.to_sec() <= 501.1, "stamps are ROS time")

        self.clock.publish(Clock(rospy.Time.from_sec(100000)))
        self.assertLess(self.steps() - after_two_seconds, 30, "a jump ahead is not caught up")
        self.wait_for(lambda s: s.lag > 1000, "but told as lag")
        self.jump_by_a_century()

    def jump_by_a_century(self):
        """A difference of times that a ros::Duration cannot hold; transforms come all the while."""
        transforms = rospy.Publisher("/tf", TFMessage, queue_size=10)
        for seconds in (4e9, 10, 4.2e9, 20):
            for _ in range(10):
                self.clock.publish(Clock(rospy.Time.from_sec(seconds)))
                transform = TransformStamped()
                transform.header.stamp = rospy.Time.from_sec(seconds)
                transform.header.frame_id, transform.child_frame_id = "map", "rover"
                transform.transform.rotation.w = 1
                transforms.publish(TFMessage([transform]))
                time.sleep(0.02)
        header = Header(frame_id="rover")
        answer = rospy.ServiceProxy("/desert_sim/query_terrain", QueryTerrain)(header, [Point(20, 20, 0)])
        self.assertTrue(answer.success, answer.message)


if __name__ == "__main__":
    rospy.init_node("clock_test", disable_signals=True)
    rostest.rosrun("desert_sim", "clock", FollowsTheClock)
