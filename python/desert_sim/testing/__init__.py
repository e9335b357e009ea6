"""For tests of programs that drive over a desert: with rostest, unittest, pytest, or none of them.

    import desert_sim.testing

    with desert_sim.testing.Desert("rover_barchans", seed=3, rover=(12, 64)) as desert:
        desert.expect_cost(12, 64, at_most=30)
        desert.expect_rover_arrives((20, 64), within=300)

Desert       a paused node with a scenario and a seed, and a rover, for one `with`; steps, edits, expectations
Node         any node as a process, with its parameters and its output
Master       a ROS master of its own; init_ros() makes this process a node, with such a master where there is none
wait_until   waits for a condition
PATIENCE     what all time limits are multiplied by (the environment's DESERT_PATIENCE): on slow machines more than 1
"""
from .desert import Desert
from .processes import PATIENCE, Master, Node, init_ros, program, wait_until

__all__ = ["PATIENCE", "Desert", "Master", "Node", "init_ros", "program", "wait_until"]
