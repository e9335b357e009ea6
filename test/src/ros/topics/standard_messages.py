#!/usr/bin/env python3
"""A planner that knows messages of ROS, of navigation and of grid_map alone drives a rover around a wall, by the topics that
config/standard_publishers.yaml sends through a bridge."""
import heapq
import json
import math
import os
import sys
import unittest

import genpy.dynamic
from geometry_msgs.msg import PoseStamped, Twist
from nav_msgs.msg import OccupancyGrid, Odometry, Path
import numpy as np
import rosgraph
import rospkg
import rospy
import rostest
from sensor_msgs.msg import Image, PointCloud2
from std_msgs.msg import Float32MultiArray
import tf2_ros
import yaml

GOAL = (12.0, 3.0)
AT_GOAL = 0.7       # [m]
LETHAL, CLEARANCE = 100, 2  # cost of ~costmap; cells that the rover's width needs on either side


def decoded(message):
    """A message of a type that not every system has, here grid_map_msgs/GridMap, by the definition that its publisher sends."""
    kind = message._connection_header["type"]
    return genpy.dynamic.generate_dynamic(kind, message._connection_header["message_definition"])[kind]().deserialize(message._buff)


def free_cells(costmap):
    """Cells [row, column] that are known, not lethal, and CLEARANCE cells from any that is."""
    cost = np.array(costmap.data, dtype=np.int16).reshape(costmap.info.height, costmap.info.width)
    blocked = np.pad((cost < 0) | (cost >= LETHAL), CLEARANCE, constant_values=True)
    free = np.ones(cost.shape, dtype=bool)
    for y in range(2 * CLEARANCE + 1):
        for x in range(2 * CLEARANCE + 1):
            free &= ~blocked[y:y + cost.shape[0], x:x + cost.shape[1]]
    return free


def shortest_way(costmap, start, goal):
    """Points [m] from start to goal over free cells, by Dijkstra; empty if there is no way."""
    info, free = costmap.info, free_cells(costmap)

    def cell(point):
        return (int((point[1] - info.origin.position.y) / info.resolution), int((point[0] - info.origin.position.x) / info.resolution))

    def point(at):
        return (info.origin.position.x + (at[1] + 0.5) * info.resolution, info.origin.position.y + (at[0] + 0.5) * info.resolution)
    queue, came_from, done = [(0.0, cell(start), None)], {}, cell(goal)
    while queue and done not in came_from:
        length, here, before = heapq.heappop(queue)
        if here in came_from:
            continue
        came_from[here] = before
        for row, column in ((-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (-1, 1), (1, -1), (1, 1)):
            there = (here[0] + row, here[1] + column)
            if 0 <= there[0] < free.shape[0] and 0 <= there[1] < free.shape[1] and free[there]:
                heapq.heappush(queue, (length + math.hypot(row, column), there, here))
    way, here = [], done if done in came_from else None
    while here is not None:
        way.append(point(here))
        here = came_from[here]
    return way[::-1]


def command_along(way, pose, look_ahead=0.8):
    """The twist that leads from a pose (x, y, yaw) to the point of a way that lies look_ahead [m] ahead of the nearest one."""
    x, y, yaw = pose
    nearest = min(range(len(way)), key=lambda n: math.hypot(way[n][0] - x, way[n][1] - y))
    ahead = next((p for p in way[nearest:] if math.hypot(p[0] - way[nearest][0], p[1] - way[nearest][1]) >= look_ahead), way[-1])
    turn = math.remainder(math.atan2(ahead[1] - y, ahead[0] - x) - yaw, 2 * math.pi)
    twist = Twist()
    twist.linear.x = 0.7 * max(0.0, math.cos(turn)) ** 2
    twist.angular.z = 1.5 * turn
    return twist


def path_message(way):
    path = Path()
    path.header.frame_id, path.header.stamp = "map", rospy.Time.now()
    for x, y in way:
        pose = PoseStamped(header=path.header)
        pose.pose.position.x, pose.pose.position.y, pose.pose.orientation.w = x, y, 1
        path.poses.append(pose)
    return path


def wait_for(happens):
    """For as long as rostest allows."""
    while not happens():
        rospy.sleep(0.05)


class StandardMessages(unittest.TestCase):
    TOPICS = {"/desert_sim/costmap": OccupancyGrid, "/desert_sim/grid_map": rospy.AnyMsg, "/desert_sim/local_map": rospy.AnyMsg,
              "/desert_sim/points": PointCloud2, "/desert_sim/wind_array": Float32MultiArray, "/desert_sim/image": Image,
              "/rover/lidar/points": PointCloud2, "/rover/odom": Odometry}

    @classmethod
    def setUpClass(cls):
        cls.last = {}
        for topic, kind in cls.TOPICS.items():
            rospy.Subscriber(topic, kind, lambda message, topic=topic: cls.last.__setitem__(topic, message), queue_size=1)
        cls.frames = tf2_ros.Buffer()
        cls.listener = tf2_ros.TransformListener(cls.frames)
        cls.commands = rospy.Publisher("/rover/cmd_vel", Twist, queue_size=1)
        cls.path = rospy.Publisher("/rover/desert_planner/path", Path, queue_size=1)
        wait_for(lambda: len(cls.last) == len(cls.TOPICS))
        wait_for(lambda: cls.frames.can_transform("map", "rover/base_footprint", rospy.Time(0)))

    def pose(self):
        """x, y [m] and yaw of the rover on the map, by tf."""
        at = self.frames.lookup_transform("map", "rover/base_footprint", rospy.Time(0)).transform
        q = at.rotation
        yaw = math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))
        return at.translation.x, at.translation.y, yaw

    def test_planner_without_our_messages_drives_around_a_wall(self):
        begun, crossed_at = self.last["/rover/odom"].pose.pose.position, None
        self.assertFalse(shortest_way(self.last["/desert_sim/costmap"], self.pose(), (8.0, 3.0)), "no way leads onto the wall")
        while math.dist(self.pose()[:2], GOAL) > AT_GOAL:
            x, y, _ = here = self.pose()
            way = shortest_way(self.last["/desert_sim/costmap"], here, GOAL)
            self.assertTrue(way, "a way from (%.2f, %.2f)" % (x, y))
            self.path.publish(path_message(way))
            self.commands.publish(command_along(way, here))
            crossed_at = y if crossed_at is None and x > 8 else crossed_at
            rospy.sleep(0.1)
        self.commands.publish(Twist())
        self.assertGreater(crossed_at, 8, "around the wall, not over it")
        ended = self.last["/rover/odom"].pose.pose.position
        self.assertGreater(math.hypot(ended.x - begun.x, ended.y - begun.y), 1, "odometry, which skids in turns")

    def test_maps_and_wind_say_what_they_hold(self):
        wind = self.last["/desert_sim/wind_array"]
        sizes = [(axis.label, axis.size, axis.stride) for axis in wind.layout.dim]
        self.assertEqual(sizes, [("u, v", 2, 96), ("y", 6, 48), ("x", 8, 8)])
        u, v = np.array(wind.data).reshape([axis.size for axis in wind.layout.dim])
        self.assertLess(v.mean(), -2)
        self.assertLess(abs(u.mean()), 1)
        grid_map, local_map = (decoded(self.last["/desert_sim/" + name]) for name in ("grid_map", "local_map"))
        self.assertEqual(grid_map.layers, ["elevation", "sand_depth", "slope", "traversability"])
        self.assertEqual(grid_map.info.resolution, 0.5)
        self.assertEqual((local_map.info.header.frame_id, local_map.layers), ("map", ["elevation", "traversability"]))
        self.assertEqual(self.last["/desert_sim/points"].width * self.last["/desert_sim/points"].height, 64 * 48)
        beams = self.last["/rover/lidar/points"]
        self.assertGreater(beams.width * beams.height, 1000)

    def test_bridge_is_told_of_topics_that_there_are(self):
        with open(os.path.join(rospkg.RosPack().get_path("desert_sim"), "config", "ros1_bridge.yaml")) as file:
            told = {row["topic"]: row["type"].replace("/msg/", "/") for row in yaml.safe_load(file)["topics"]}
        kinds = dict(rosgraph.Master(rospy.get_name()).getTopicTypes())
        self.assertEqual(told, {topic: kinds.get(topic) for topic in told})
        self.assertFalse([topic for topic, kind in told.items() if kind.startswith("desert_sim/")])
        self.assertEqual(set(self.TOPICS) - set(told), set())

    def test_layout_shows_topics_that_there_are(self):
        with open(os.path.join(rospkg.RosPack().get_path("desert_sim"), "config", "lichtblick_layout.json")) as file:
            panels = json.load(file)["configById"]
        plotted = [path["value"].split(".")[0] for panel in panels.values() for path in panel.get("paths", [])]
        shown = {*panels["3D!terrain"]["topics"], panels["Image!hillshade"]["imageMode"]["imageTopic"], *plotted}
        self.assertEqual(shown - set(dict(rosgraph.Master(rospy.get_name()).getTopicTypes())), set())

    def test_messages_are_not_ours(self):
        self.assertFalse([name for name in sys.modules if name.split(".")[0] == "desert_sim"])


if __name__ == "__main__":
    rospy.init_node("standard_planner")
    rostest.rosrun("desert_sim", "standard_messages", StandardMessages)
