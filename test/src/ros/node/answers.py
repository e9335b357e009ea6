#!/usr/bin/env python3
"""What a node says while a step takes long, and how soon it ends; keyframes while subscribers come and go."""
import signal
import subprocess
import time

from desert_sim.srv import EditTerrain, QueryTerrain
from desert_sim.testing import PATIENCE, wait_until
from dynamic_reconfigure.msg import DoubleParameter
from dynamic_reconfigure.srv import Reconfigure, ReconfigureRequest
from geometry_msgs.msg import Point
from nav_msgs.msg import OccupancyGrid
from node_tests import CORNER, Scenarios
import rospy
import rostest
from std_srvs.srv import Trigger

# A step of this takes many seconds on any machine: a thousand sweeps of four million cells.
LONG_STEPS = ["grid.width=2048", "grid.height=2048", "avalanching.scheme=sweeps", "avalanching.sweeps=1000"]


class Answers(Scenarios):
    def test_a_long_step_is_neither_waited_for_nor_finished(self):
        node = self.start("long", {"scenario": CORNER, "settings": LONG_STEPS, "threads": 1, "paused": True,
                                   "step_rate": 0, "answer_timeout": 0.5, "data_dir": self.folder})
        self.assertTrue(node.call("resume", Trigger).success)
        time.sleep(0.5)  # what comes before the first step is served
        for service, kind, request in (("query_terrain", QueryTerrain, {"points": [Point(20, 20, 0)]}),
                                       ("edit_terrain", EditTerrain, {"shape": "circle", "layer": "sand", "merge": "add",
                                                                      "radius": 5, "inner": 1, "value": 1})):
            start = time.monotonic()
            answer = node.call(service, kind, **request)
            self.assertFalse(answer.success, "%s was answered in the middle of a step" % service)
            self.assertIn("has been busy with a step", answer.message)
            self.assertLess(time.monotonic() - start, 2 * PATIENCE)
        with self.assertRaises(rospy.ServiceException) as refused:
            node.call("set_parameters", Reconfigure, ReconfigureRequest())
        self.assertIn("has been busy with a step", str(refused.exception))
        status, seconds = node.end(signal.SIGTERM)
        self.assertEqual(status, 4, node.output)
        self.assertIn("was given up", node.output)
        self.assertLess(seconds, 5 + PATIENCE)

    def test_refusals_of_set_parameters_have_a_reason(self):
        node = self.start("refusing", {"scenario": CORNER, "paused": True, "data_dir": self.folder})
        request = ReconfigureRequest()
        request.config.doubles = [DoubleParameter("saltation__lift", 1e9)]
        with self.assertRaises(rospy.ServiceException) as refused:
            node.call("set_parameters", Reconfigure, request)
        self.assertIn("saltation.lift", str(refused.exception))
        self.assertIn("1000000000", str(refused.exception))
        self.assertEqual(node.end()[0], 0, node.output)

    def test_keyframes_come_at_their_rate_though_subscribers_join(self):
        node = self.start("joined", {"scenario": CORNER, "paused": False, "step_rate": 20, "costmap_keyframe_rate": 0.5,
                                     "data_dir": self.folder})
        maps = []
        keeper = rospy.Subscriber("/joined/costmap", OccupancyGrid, maps.append)
        wait_until(lambda: maps, "no costmap")
        guests = [subprocess.Popen(["rostopic", "echo", "-n", "1", "--noarr", "/joined/costmap"], stdout=subprocess.DEVNULL)
                  for _ in range(8)]
        for guest in guests:
            self.assertEqual(guest.wait(60 * PATIENCE), 0)
        seen = len(maps)
        wait_until(lambda: len(maps) >= seen + 2, "the keyframes, one in two seconds, stay away", seconds=8)
        keeper.unregister()
        self.assertEqual(node.end()[0], 0, node.output)


if __name__ == "__main__":
    rospy.init_node("answers_test", disable_signals=True)
    rostest.rosrun("desert_sim", "answers", Answers)
