#!/usr/bin/env python3
import math, rospy, desert_sim

rospy.init_node("driver")
terrain = desert_sim.TerrainClient(layers=["traversability"])
rover = desert_sim.Rover()                         # topics below /rover
goal = rospy.get_param("~goal", [14, 64])          # [m], in the terrain's frame
assert terrain.wait_for_terrain(60)                # wall seconds
while rover.distance_to(*goal) > 0.4 and not rospy.is_shutdown():
    x, y, z, yaw = rover.pose()
    turn = math.remainder(math.atan2(goal[1] - y, goal[0] - x) - yaw, math.tau)
    ahead = terrain.value("traversability", x + math.cos(yaw), y + math.sin(yaw))  # 0 no way ... 1 free; NaN unknown
    rover.drive(0.3 * ahead * max(0, math.cos(turn)) if ahead > 0 else 0, turn)    # [m/s], [rad/s]; holds for 0.5 s
    rospy.sleep(0.05)
