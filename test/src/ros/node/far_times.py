#!/usr/bin/env python3
"""Clocks, stamps of transforms, goals and cancels near 2^32 s, the end of what a ROS time can be: no node ends, and each
goes on with what comes after."""
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray
from desert_sim.msg import ForecastTerrainGoal, PlannerStatus, RoverStatus
from desert_sim.srv import QueryTerrain, QueryTerrainRequest, Step
from desert_sim.testing import wait_until
from forecast_client import ForecastClient
from geometry_msgs.msg import Point, TransformStamped
from map_client import Listener
from move_base_msgs.msg import MoveBaseActionGoal
from node_tests import CORNER, Scenarios, ScriptedClock
import rospy
import rostest
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage

LAST = rospy.Time(4294967295, 999999999)


class FarTimes(Scenarios):
    def setUp(self):
        super().setUp()
        self.clock = ScriptedClock()
        self.clock.show(1000)
        self.desert = self.start("desert_sim", {"scenario": CORNER})
        self.rover = self.of_program("desert_rover", {"x": 40, "y": 0, "status_rate": 20, "lidar": {"rate": 0}, "depth_camera": {"rate": 0}},
                                     "desert_rover_node")
        self.planner = self.of_program("desert_planner", {"planner": "forecast", "drive": False, "pose_age": 1e6, "status_rate": 20},
                                       "desert_planner_node")
        self.rover.latest("status", RoverStatus)
        self.planner.latest("status", PlannerStatus)

    def tearDown(self):
        self.clock.close()
        super().tearDown()

    def expect_all_serve(self):
        """The planner and the rover act at a rate of wall time, and say so."""
        self.assertTrue(self.desert.call("step", Step, 1).success)
        for topic, kind in (("/desert_rover/status", RoverStatus), ("/desert_planner/status", PlannerStatus)):
            listener = Listener(topic, kind)
            wait_until(lambda: len(listener.messages) > 3, topic)
        self.planner.call("cancel", Trigger)
        for node in self.nodes:
            self.assertTrue(node.running, node.output)

    def expect_known(self, action, goal_id, wanted):
        statuses = Listener(action + "/status", GoalStatusArray)
        wait_until(lambda: any(s.goal_id.id == goal_id and s.status in wanted for m in list(statuses.messages) for s in m.status_list),
                   "%s does not know %s" % (action, goal_id))

    def forecast(self):
        client = ForecastClient("/desert_sim")
        client.send_goal(ForecastTerrainGoal(horizon=3, moments=1))
        self.assertTrue(client.wait_for_result())
        self.assertEqual(client.get_state(), GoalStatus.SUCCEEDED, client.get_goal_status_text())

    def drive(self, goal_id, frame, stamp=rospy.Time()):
        goals = rospy.Publisher("/move_base/goal", MoveBaseActionGoal, queue_size=1)
        wait_until(goals.get_num_connections, "a connection for goals")
        goal = MoveBaseActionGoal(goal_id=GoalID(id=goal_id, stamp=stamp))
        goal.goal.target_pose.header.frame_id = frame
        goal.goal.target_pose.pose.position.x, goal.goal.target_pose.pose.orientation.w = 60, 1
        goals.publish(goal)
        self.expect_known("/move_base", goal_id, (GoalStatus.ACTIVE,))

    def test_cancels_and_goals(self):
        for action in ("/desert_sim/forecast", "/move_base"):
            cancels = rospy.Publisher(action + "/cancel", GoalID, queue_size=1)
            wait_until(cancels.get_num_connections, "a connection for cancels")
            cancels.publish(GoalID(id="z", stamp=LAST))
            self.expect_known(action, "z", (GoalStatus.RECALLING,))
            # The server forgets it after a while, and publishes its status until then.
            gone = Listener(action + "/status", GoalStatusArray)
            self.clock.show(self.clock.now.to_sec() + 10)
            wait_until(lambda: gone.messages and not gone.messages[-1].status_list, action + " does not forget a cancel")
        self.expect_all_serve()
        self.forecast()
        self.drive("a goal of the future", "map", LAST)
        self.drive("a goal of the future", "map", LAST)  # sent again
        self.drive("another goal", "/map")
        self.expect_all_serve()

    def test_transforms(self):
        transforms = rospy.Publisher("/tf", TFMessage, queue_size=10)
        wait_until(lambda: transforms.get_num_connections() >= 2, "listeners to /tf")

        def tell(child, stamp):
            transform = TransformStamped(child_frame_id=child)
            transform.header.stamp, transform.header.frame_id = stamp, "map"
            transform.transform.translation.x, transform.transform.rotation.w = 5, 1
            transforms.publish(TFMessage([transform]))

        tell("site", LAST)
        tell("site", rospy.Time(999))
        query = QueryTerrainRequest(points=[Point(12, 3, 0)])
        query.header.frame_id = "site"

        def found():
            tell("site", rospy.Time(1000))
            return self.desert.call("query_terrain", QueryTerrain, query).success

        wait_until(found, "the transform that came after")
        self.drive("in another frame", "site")
        self.expect_all_serve()

    def test_clocks(self):
        for seconds in (LAST.secs - 5, LAST.secs, 1000, 2 ** 31 + 5000, 1001):
            self.clock.show(seconds)
            self.expect_all_serve()
        self.forecast()


if __name__ == "__main__":
    rospy.init_node("far_times")
    rostest.rosrun("desert_sim", "far_times", FarTimes)
