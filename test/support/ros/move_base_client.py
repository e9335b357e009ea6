"""What is asked of a rover that move_base drives (launch/move_base_rover.launch), and of the terrain in its way."""
import math
import threading

import numpy as np
import rospy
from actionlib_msgs.msg import GoalStatus, GoalStatusArray
from desert_sim.srv import EditTerrain, EditTerrainRequest, SetRoverPose
from desert_sim.testing import PATIENCE, wait_until
from dynamic_reconfigure.client import Client
from geometry_msgs.msg import Point, Pose2D, PoseStamped
from map_client import Listener, call
from nav_msgs.msg import Odometry, Path

ENDED = (GoalStatus.SUCCEEDED, GoalStatus.ABORTED, GoalStatus.REJECTED, GoalStatus.PREEMPTED)


class Dune:
    """A wall of sand with steep flanks from south to north, all of it within `radius` of x."""
    radius, height = 3.0, 3.0

    def __init__(self, x, south, north):
        self.x, self.south, self.north = x, south, north

    def pour(self):
        request = EditTerrainRequest(layer="sand", shape="capsule", merge="add", radius=self.radius, inner=0.3,
                                     value=self.height, points=[Point(self.x, y, 0) for y in (self.south, self.north)])
        answer = call("edit_terrain", EditTerrain, request)
        assert answer.success, answer.message

    def meets(self, points):
        """Whether one of the points lies in the part that nobody can drive on, whatever slid down at its feet."""
        x, y = points.T
        steep = self.radius / 2
        along = np.clip(y, self.south, self.north)
        return bool((np.hypot(x - self.x, y - along) < steep).any())


class MoveBaseRover:
    def __init__(self, name="rover"):
        self.name, self.changed, self.pose, self.way = name, threading.Condition(), None, []
        self.plans = Listener("/%s/move_base/NavfnROS/plan" % name, Path)
        self.status = Listener("/%s/move_base/status" % name, GoalStatusArray)
        self.goals = rospy.Publisher("/move_base_simple/goal", PoseStamped, queue_size=1)
        rospy.Subscriber("/%s/ground_truth" % name, Odometry, self.take_pose, queue_size=100)
        rospy.wait_for_service("/%s/move_base/make_plan" % name, 60 * PATIENCE)
        self.status.first("move_base")
        wait_until(self.goals.get_num_connections, "a connection for goals")
        self.terrain = Client("/desert_sim", timeout=60 * PATIENCE)

    def take_pose(self, odometry):
        position = odometry.pose.pose.position
        with self.changed:
            self.pose = position.x, position.y
            self.way.append(self.pose)
            self.changed.notify_all()

    def wait_until_x(self, x, seconds):
        with self.changed:
            return self.changed.wait_for(lambda: self.pose and self.pose[0] >= x, seconds * PATIENCE)

    def put_down(self, x, y, yaw=0):
        answer = rospy.ServiceProxy("/%s/desert_rover/set_pose" % self.name, SetRoverPose)(Pose2D(x, y, yaw))
        assert answer.success, answer.message

    def send_goal(self, x, y):
        """Eastwards there; its way begins here. Returns when move_base has it."""
        with self.changed:
            self.way = []
        earlier = {status.goal_id.id for status in self.status.first().status_list}
        goal = PoseStamped()
        goal.header.frame_id, goal.pose.orientation.w = "map", 1
        goal.pose.position.x, goal.pose.position.y = x, y
        self.goals.publish(goal)
        status = self.status.wait_for(lambda m: any(s.goal_id.id not in earlier for s in m.status_list), "the goal")
        self.goal = next(s.goal_id.id for s in status.status_list if s.goal_id.id not in earlier)

    def ended(self):
        """How the goal ended: a GoalStatus; None while it has not."""
        return next((status for status in self.status.messages[-1].status_list
                     if status.goal_id.id == self.goal and status.status in ENDED), None)

    def wait_for_end(self, seconds):
        self.status.wait_for(lambda _: self.ended(), "the end of the goal; the rover is at %s" % (self.pose,), seconds)
        return self.ended()

    def wait_for_plan(self, fits, what, seconds):
        """The points of the last plan, once they fit."""
        path = self.plans.wait_for(lambda m: len(m.poses) and fits(points_of(m)), what, seconds)
        return points_of(path)

    def keyframes(self, rate):
        """With a rate of 0 only updates tell of changes."""
        self.terrain.update_configuration({"costmap_keyframe_rate": rate})

    def metres(self):
        with self.changed:
            way = np.array(self.way)
        return float(np.hypot(*np.diff(way, axis=0).T).sum()) if len(way) > 1 else 0.0


def points_of(path):
    return np.array([(pose.pose.position.x, pose.pose.position.y) for pose in path.poses]).reshape(-1, 2)


def distance(a, b):
    return math.hypot(a[0] - b[0], a[1] - b[1])
