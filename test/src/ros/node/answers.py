#!/usr/bin/env python3
"""What a node says while a step never ends, that it is given up when the node is to end, and reasons of refusals."""
import os
import signal

from desert_sim.srv import EditTerrain, QueryTerrain
from desert_sim.testing import wait_until
from dynamic_reconfigure.msg import DoubleParameter
from dynamic_reconfigure.srv import Reconfigure, ReconfigureRequest
from geometry_msgs.msg import Point
from node_tests import CORNER, Scenarios
import rospy
import rostest
from std_srvs.srv import Trigger

# A step of this takes a quarter of an hour on a fast machine: hills as steep as these slide and slide.
ENDLESS_STEP = {"grid": {"width": 1024, "height": 1024, "boundary": "open"},
                "terrain": [{"noise": {"layer": "sand", "low": 0, "high": 1000, "scale": 30}}],
                "avalanching": {"scheme": "sweeps", "quality": "converged", "tolerance": 1e-6, "max_iterations": 20000}}


def simulated_for(node):
    """Processor time of the node's simulation thread so far [s]."""
    tasks = "/proc/%d/task" % node.process.pid
    for task in os.listdir(tasks):
        with open(os.path.join(tasks, task, "stat")) as file:
            name, _, fields = file.read().partition("(")[2].rpartition(")")
        if name == "simulation":
            return int(fields.split()[11]) / os.sysconf("SC_CLK_TCK")
    raise AssertionError("the node has no simulation thread")


class Answers(Scenarios):
    def test_a_long_step_is_neither_waited_for_nor_finished(self):
        node = self.start("long", dict(ENDLESS_STEP, step_rate=0, answer_timeout=0.1, data_dir=self.folder), preexec=None)
        rospy.wait_for_service("/long/set_parameters", 600)
        before = simulated_for(node)
        # A machine that is busy with others may not answer in time even here, where the node has nothing to do.
        wait_until(lambda: node.call("resume", Trigger).success, "it does not resume")
        wait_until(lambda: simulated_for(node) > before + 0.2, "no step begins")  # all else takes it no time
        for service, kind, request in (("query_terrain", QueryTerrain, {"points": [Point(20, 20, 0)]}),
                                       ("edit_terrain", EditTerrain, {"shape": "circle", "layer": "sand", "merge": "add",
                                                                      "radius": 5, "inner": 1, "value": 1})):
            answer = node.call(service, kind, **request)
            self.assertFalse(answer.success, "%s was answered in the middle of a step" % service)
            self.assertIn("has been busy with a step", answer.message)
        with self.assertRaises(rospy.ServiceException) as refused:
            node.call("set_parameters", Reconfigure, ReconfigureRequest())
        self.assertIn("has been busy with a step", str(refused.exception))
        self.assertEqual(node.end(signal.SIGTERM)[0], 4, node.output)
        self.assertIn("was given up", node.output)

    def test_refusals_of_set_parameters_have_a_reason(self):
        node = self.start("refusing", {"scenario": CORNER, "data_dir": self.folder})
        request = ReconfigureRequest()
        request.config.doubles = [DoubleParameter("saltation__lift", 1e9)]
        with self.assertRaises(rospy.ServiceException) as refused:
            node.call("set_parameters", Reconfigure, request)
        self.assertIn("saltation.lift", str(refused.exception))
        self.assertIn("1000000000", str(refused.exception))
        self.assertEqual(node.end()[0], 0, node.output)


if __name__ == "__main__":
    rospy.init_node("answers_test", disable_signals=True)
    rostest.rosrun("desert_sim", "answers", Answers)
