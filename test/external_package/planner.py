#!/usr/bin/env python3
"""Plans over the live traversability by Dijkstra's algorithm, and drives the plan. Parameters: ~goal_x, ~goal_y [m].

What cannot be traversed costs a hundred times as much, so that there is a way out of it for a rover that has cut a corner.
"""
import heapq
import math

import desert_sim
import rospy
from geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion
from nav_msgs.msg import Path


def plan(ground, start, goal):  # points of the cheapest way; none if there is no way
    begin, end = ground.world_to_cell(*start), ground.world_to_cell(*goal)
    queue, after, way = [(0.0, end, end)], {}, [begin]
    while queue and begin not in after:
        length, cell, towards = heapq.heappop(queue)
        if cell not in after:
            after[cell] = towards
            for x, y in [(cell[0] + i, cell[1] + j) for i in (-1, 0, 1) for j in (-1, 0, 1)]:
                if 0 <= x < ground.width and 0 <= y < ground.height:
                    ease = ground.values[y, x] if ground.values[y, x] > 0.01 else 0.01
                    heapq.heappush(queue, (length + math.dist(cell, (x, y)) / ease, (x, y), cell))
    while begin in after and way[-1] != end:
        way.append(after[way[-1]])
    return [ground.cell_to_world(*cell) for cell in way if cell in after]


rospy.init_node("planner")
terrain, rover, held = desert_sim.TerrainClient(layers=["traversability"]), desert_sim.Rover(), None
paths = rospy.Publisher("/planner/plan", Path, queue_size=1, latch=True)
goal = rospy.get_param("~goal_x"), rospy.get_param("~goal_y")
while terrain.wait_for_terrain(60) and rover.distance_to(*goal) > 0.3 and not rospy.is_shutdown():
    (x, y, _, yaw), ground = rover.pose(), terrain["traversability"]
    if held is None or (ground.values != held.values).any():
        held, way = ground, plan(ground, (x, y), goal)
        paths.publish(Path(poses=[PoseStamped(pose=Pose(Point(*p, 0), Quaternion(0, 0, 0, 1))) for p in way]))
    way = way[next((n for n, point in enumerate(way) if math.dist(point, (x, y)) > 0.8), -1):]
    turn = math.remainder(math.atan2(way[0][1] - y, way[0][0] - x) - yaw, math.tau) if way else 0
    rover.drive(0.3 * max(0, math.cos(turn)) ** 2 if way else 0, 2 * turn)
    rospy.sleep(0.05)
