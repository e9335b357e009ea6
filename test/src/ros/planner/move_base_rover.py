#!/usr/bin/env python3
"""move_base drives a rover with the parameters that we ship: round a dune that comes into its way, of which no keyframe
tells, to its goal."""
import unittest

import numpy as np
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from map_client import Listener
from move_base_client import Dune, MoveBaseRover, distance
from nav_msgs.msg import OccupancyGrid

START, GOAL = (10, 32), (30, 32)


class MoveBaseDrives(unittest.TestCase):
    def test_round_a_dune_that_only_updates_told_of(self):
        rover = MoveBaseRover()
        keyframes = Listener("/desert_sim/costmap", OccupancyGrid)
        keyframes.first()
        rover.put_down(*START)
        rover.send_goal(*GOAL)
        rover.wait_for_plan(lambda plan: abs(plan[:, 1] - 32).max() < 1, "straight on", 100)
        self.assertTrue(rover.wait_until_x(START[0] + 1, 100), "it drives: it is at %s" % (rover.pose,))

        rover.keyframes(0)
        poured = rospy.Time.now()
        dune = Dune(21, 29, 35)
        dune.pour()
        plan = rover.wait_for_plan(lambda plan: not dune.meets(plan), "a plan round the dune", 100)
        self.assertTrue(all(k.header.stamp < poured for k in keyframes.messages), "no keyframe has told of it")
        self.assertLess(distance(plan[-1], GOAL), 1)

        end = rover.wait_for_end(300)
        self.assertEqual(end.status, GoalStatus.SUCCEEDED, end.text)
        self.assertLess(distance(rover.pose, GOAL), 1)
        self.assertFalse(dune.meets(np.array(rover.way)), "it drove through the dune")


if __name__ == "__main__":
    rospy.init_node("move_base_rover_test", disable_signals=True)
    rostest.rosrun("desert_sim", "move_base_rover", MoveBaseDrives)
