#!/usr/bin/env python3
"""A package that is installed elsewhere tests planners of its own: they drive round a wall, and round a second one that is
built while they drive."""
import unittest

import desert_sim.testing
import rospy
import rostest

# Rock, with a wall 2 m wide and 3 m high across it, but for a gap in the north.
WALLED = {"grid": {"width": 48, "height": 32, "cell_size": 0.5, "boundary": "open"}, "wind": {"speed": 0},
          "terrain": [{"uniform": {"layer": "bedrock", "value": 1}},
                      {"column": {"layer": "bedrock", "x": 12, "y": 5, "size_x": 2, "size_y": 10, "height": 3}}]}
START, GOAL = (7, 6), (17, 6)


class Planners(unittest.TestCase):
    def expect_to_drive(self, program):
        with desert_sim.testing.Desert(WALLED, rover=START, seconds_per_step=0.2) as desert:
            planner = desert_sim.testing.Node("planner", {"goal_x": GOAL[0], "goal_y": GOAL[1]}, program, "desert_sim_user")
            self.addCleanup(planner.close)
            desert.expect_cost(12, 5, at_least=0)
            desert.expect_cost(10.8, 5, at_least=100)
            with desert.expect_replanned("/planner/plan", within=30):
                desert.edit("bedrock", "rectangle", "add", 2, center=(8, 9), radius=3, radius_y=0.5, inner=1)
            desert.expect_rover_arrives(GOAL, within=600)

    def test_in_python(self):
        self.expect_to_drive("planner.py")

    def test_in_cpp(self):
        self.expect_to_drive("planner")


if __name__ == "__main__":
    rospy.init_node("planner_test", disable_signals=True)
    rostest.rosrun("desert_sim_user", "planner_test", Planners)
