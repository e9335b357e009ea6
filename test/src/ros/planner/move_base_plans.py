#!/usr/bin/env python3
"""move_base over ~costmap and ~costmap_updates: its planner goes round dunes, and its costmap is cell by cell ours. The
node sends no keyframe by rate, so what was not in an update is never made good."""
import time
import unittest

import numpy as np
import rospy
import rostest
from desert_sim.srv import EditTerrain, EditTerrainRequest, LoadScenario, Step
from desert_sim.msg import SimulationStatus
from desert_sim.testing import PATIENCE, wait_until
from geometry_msgs.msg import Point
from map_client import Listener, call
from map_msgs.msg import OccupancyGridUpdate
from nav_msgs.msg import OccupancyGrid
from nav_msgs.srv import GetPlan, GetPlanRequest
from std_srvs.srv import Trigger


SPACING = 3  # s, costmap_update_spacing in move_base_plans.test


def edit(points, value=3.0, radius=3.0):
    """A stroke of sand, of which the node has told when this returns."""
    request = EditTerrainRequest(layer="sand", shape="capsule", merge="add", radius=radius, inner=0.5, value=value)
    request.points = [Point(x, y, 0) for x, y in points]
    answer = call("edit_terrain", EditTerrain, request)
    assert answer.success, answer.message
    step()


def step():
    """Makes none: it is answered when all changes have been published, without waiting for the rate of updates."""
    call("step", Step, steps=0)


def frame_of(grid):
    origin = grid.info.origin
    turned = (origin.orientation.x, origin.orientation.y, origin.orientation.z, origin.orientation.w) != (0, 0, 0, 1)
    return (grid.info.width, grid.info.height, grid.info.resolution, origin.position.x, origin.position.y, turned,
            grid.header.frame_id)


def in_costmap_2d(cost):
    """What costmap_2d publishes of a cost that it was given: it holds 0 ... 254 of it, and shows that as 0 ... 100."""
    if cost < 0 or cost >= 100:
        return cost
    held = int(cost / 100 * 254)
    return 1 + 97 * (held - 1) // 251 if held > 0 else 0


SHOWN = np.array([in_costmap_2d(cost) for cost in range(-1, 101)])


class MoveBasePlans(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.keyframes = Listener("/desert_sim/costmap", OccupancyGrid)
        cls.updates = Listener("/desert_sim/costmap_updates", OccupancyGridUpdate)
        cls.master = Listener("/move_base/local_costmap/costmap", OccupancyGrid)
        rospy.wait_for_service("/move_base/make_plan", 60 * PATIENCE)
        cls.make_plan = rospy.ServiceProxy("/move_base/make_plan", GetPlan)
        cls.keyframes.first()
        cls.master.first()

    def setUp(self):
        answer = call("load_scenario", LoadScenario, name="corner.yaml")
        self.assertTrue(answer.success, answer.message)
        self.master_is_ours("at the start")
        self.let_it_be_longer_ago()

    @staticmethod
    def let_it_be_longer_ago():
        """Sooner after another terrain, by the clock that the node looks at, changes would come as whole maps."""
        end = time.monotonic() + SPACING
        wait_until(lambda: time.monotonic() > end, "the clock goes on")

    # ---- what the node has sent, and what costmap_2d has made of it

    def sent(self):
        """The last keyframe, and the costs it has come to since, row 0 in the south."""
        grid = self.keyframes.messages[-1]
        costs = np.array(grid.data).reshape(grid.info.height, grid.info.width)
        for u in list(self.updates.messages):
            if u.header.stamp < grid.header.stamp:
                continue
            self.assertTrue(0 <= u.x and u.x + u.width <= grid.info.width, "costmap_2d does not check")
            self.assertTrue(0 <= u.y and u.y + u.height <= grid.info.height, "costmap_2d does not check")
            costs[u.y:u.y + u.height, u.x:u.x + u.width] = np.array(u.data).reshape(u.height, u.width)
        return grid, costs

    def differences(self, master):
        """Number of cells of costmap_2d that are not as was sent; None if it lies elsewhere."""
        grid, costs = self.sent()
        if frame_of(master) != frame_of(grid):
            return None
        return int(np.count_nonzero(np.array(master.data).reshape(costs.shape) != SHOWN[costs + 1]))

    def told(self):
        """Whether the last message that has come is of the node's present state."""
        stamp = rospy.wait_for_message("/desert_sim/status", SimulationStatus, 60 * PATIENCE).header.stamp
        return any(listener.messages and listener.messages[-1].header.stamp == stamp
                   for listener in (self.keyframes, self.updates))

    def master_is_ours(self, when):
        wait_until(self.told, "%s: the present state does not come" % when)
        try:
            self.master.wait_for(lambda master: self.differences(master) == 0, when)
        except AssertionError:
            master, ours = self.master.messages[-1], self.keyframes.messages[-1]
            self.fail("%s: %s cells differ; costmap_2d's %s, ours %s" %
                      (when, self.differences(master), frame_of(master), frame_of(ours)))

    def updated(self, fits, what):
        self.updates.wait_for(fits, what)
        self.master_is_ours(what)

    def plan(self, start, goal):
        request = GetPlanRequest()
        for pose, (x, y) in ((request.start, start), (request.goal, goal)):
            pose.header.frame_id = "map"
            pose.pose.position.x, pose.pose.position.y, pose.pose.orientation.w = x, y, 1
        poses = self.make_plan(request).plan.poses
        return np.array([(p.pose.position.x, p.pose.position.y) for p in poses]).reshape(-1, 2)

    def plan_until(self, fits, what, start, goal):
        """The global costmap has a rhythm of its own."""
        plans = []

        def found():
            plans.append(self.plan(start, goal))
            return fits(plans[-1])

        try:
            wait_until(found, what)
        except AssertionError:
            self.fail("%s: %s" % (what, plans[-1].tolist()))
        return plans[-1]

    def expect_passable(self, plan):
        grid, costs = self.sent()
        origin = grid.info.origin.position
        for x, y in plan[1:-1]:  # navfn speaks of a cell by its south-west corner
            column = int(round((x - origin.x) / grid.info.resolution))
            row = int(round((y - origin.y) / grid.info.resolution))
            self.assertLess(costs[row, column], 100, "the plan leads through (%g, %g)" % (x, y))

    # ---- tests

    def test_the_plan_goes_round_a_dune_that_only_updates_told_of(self):
        start, goal = (25, 5), (121, 5)
        straight = self.plan_until(len, "a plan", start, goal)
        self.assertLessEqual(abs(straight[:, 1] - 5).max(), 2.1, "straight on")
        self.expect_passable(straight)

        keyframes = len(self.keyframes.messages)
        edit([(75, -20), (75, 21)])  # from the southern edge: the way round is in the north
        self.updated(lambda u: u.x <= 32 < u.x + u.width, "the dune")
        bent = self.plan_until(lambda p: len(p) and abs(p[:, 1] - 5).max() > 4, "round it", start, goal)
        self.assertEqual(len(self.keyframes.messages), keyframes, "no keyframe has told of it")
        self.expect_passable(bent)
        beside = bent[abs(bent[:, 0] - 75) < 2]
        self.assertGreater(len(beside), 0)
        self.assertGreater(beside[:, 1].min(), 20, "north of the dune")
        self.assertLess(beside[:, 1].max(), 35, "and no farther than it must")
        self.assertGreaterEqual(bent[:, 1].min(), 2, "nowhere in the south")

    def test_the_plan_goes_on_where_a_dune_was_taken_away(self):
        start, goal = (25, 5), (121, 5)
        edit([(75, -20), (75, 21)])
        self.plan_until(lambda p: len(p) and p[:, 1].max() > 20, "round the dune", start, goal)
        call("edit_terrain", EditTerrain,
             EditTerrainRequest(layer="sand", shape="rectangle", merge="replace", inner=1, value=0.5, radius=10,
                                radius_y=60, center=Point(75, 5, 0)))
        step()
        self.plan_until(lambda p: len(p) and abs(p[:, 1] - 5).max() <= 2.1, "straight on", start, goal)
        self.master_is_ours("after both")

    def test_updates_that_follow_each_other_within_a_cycle_all_arrive(self):
        for i in range(6):
            for x, y in ((20 + 4 * i, -10 + 5 * i), (118 - 4 * i, 60 - 5 * i)):
                edit([(x, y), (x + 1, y)])
            self.master_is_ours("pair %d" % i)

    def test_a_terrain_of_another_size_comes_whole_before_its_updates(self):
        edit([(20, -15), (130, 70)])
        for name in ("other.yaml", "corner.yaml") * 3 + ("other.yaml",):
            answer = call("load_scenario", LoadScenario, name=name)
            self.assertTrue(answer.success, answer.message)
            edit([(25, 10), (-20, 100)] if name == "other.yaml" else [(20, -15), (130, 70)])
        self.master_is_ours("the other terrain")
        self.assertTrue(call("reset", Trigger).success)
        self.master_is_ours("after a reset")
        self.let_it_be_longer_ago()
        start, goal = (-5, 20), (-5, 100)
        self.plan_until(lambda p: len(p) and abs(p[:, 0] + 5).max() < 1.6, "straight on", start, goal)
        edit([(-30, 35), (15, 35)])  # from the western edge: the way round is in the east
        plan = self.plan_until(lambda p: len(p) and p[:, 0].max() > 15, "round it", start, goal)
        self.expect_passable(plan)


if __name__ == "__main__":
    rospy.init_node("move_base_plans_test", disable_signals=True)
    rostest.rosrun("desert_sim", "move_base_plans", MoveBasePlans)
