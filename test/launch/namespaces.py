#!/usr/bin/env python3
"""Two deserts in one master: each rover has the terrain, the frames and the goals of its own namespace, and a client that
waits for a desert in another one says for which topic."""
import threading
import unittest

import rospy
import rostest
from desert_sim import TerrainClient
from desert_sim.msg import PlannerStatus
from desert_sim.testing import wait_until
from geometry_msgs.msg import PoseStamped
from rosgraph_msgs.msg import Log
from tf2_msgs.msg import TFMessage



class Received:
    """Messages of a topic."""

    def __init__(self, topic, kind):
        self._lock, self._messages = threading.Lock(), []
        self._subscriber = rospy.Subscriber(topic, kind, self._take, queue_size=100)

    def _take(self, message):
        with self._lock:
            self._messages.append(message)

    @property
    def all(self):
        with self._lock:
            return list(self._messages)

    def wait_for(self, fits, what):
        wait_until(lambda: any(fits(message) for message in self.all), what)
        return next(message for message in self.all if fits(message))


class Namespaces(unittest.TestCase):
    def test_each_planner_has_its_own_terrain_rover_and_goal(self):
        planners = {name: Received("/%s/rover/desert_planner/status" % name, PlannerStatus) for name in ("mars", "moon")}
        for name, planner in planners.items():
            planner.wait_for(lambda s, name=name: s.header.frame_id == name + "/map", "terrain of " + name)
        button = rospy.Publisher("/mars/move_base_simple/goal", PoseStamped, queue_size=1, latch=True)
        goal = PoseStamped()
        goal.header.frame_id = "mars/map"
        goal.pose.position.x, goal.pose.position.y, goal.pose.orientation.w = 70, 10, 1
        button.publish(goal)
        driving = planners["mars"].wait_for(lambda s: s.state == PlannerStatus.DRIVING, "a drive to the goal")
        self.assertEqual((driving.goal.pose.position.x, driving.goal.pose.position.y), (70, 10))
        since = len(planners["moon"].all)
        wait_until(lambda: len(planners["moon"].all) > since + 1, "more of the other planner")
        self.assertEqual({s.state for s in planners["moon"].all}, {PlannerStatus.IDLE})

    def test_frames_of_two_rovers_are_not_mixed(self):
        moving, fixed = Received("/tf", TFMessage), Received("/tf_static", TFMessage)

        def pairs(received):
            return {(t.header.frame_id, t.child_frame_id) for message in received.all for t in message.transforms}
        for name in ("mars", "moon"):
            for parent, child in (("map", "rover/odom"), ("rover/odom", "rover/base_footprint")):
                pair = (name + "/" + parent, name + "/" + child)
                wait_until(lambda pair=pair: pair in pairs(moving), str(pair))
            center = (name + "/map", name + "/desert_sim/terrain_center")
            wait_until(lambda center=center: center in pairs(fixed), str(center))
        for parent, child in pairs(moving) | pairs(fixed):
            self.assertEqual(parent.split("/")[0], child.split("/")[0])

    def test_a_client_that_waits_says_for_which_topic(self):
        log = Received("/rosout", Log)
        with TerrainClient("/venus/desert_sim"):
            told = log.wait_for(lambda m: "/venus/desert_sim/elevation" in m.msg, "what the client waits for")
        self.assertIn("Nobody publishes", told.msg)
        self.assertIn("/mars/desert_sim/elevation", told.msg)


if __name__ == "__main__":
    rospy.init_node("namespaces")
    rostest.rosrun("desert_sim", "namespaces", Namespaces)
