"""A client of ~forecast for tests."""
import threading

import rospy
from actionlib import ActionClient, CommState
from desert_sim.msg import ForecastTerrainAction


class ForecastClient:
    """Has one goal at a time. It is used as actionlib's SimpleActionClient, to which an answer is lost that comes before
    its send_goal() has returned, as that of a node that refuses may."""

    def __init__(self, node):
        self.client = ActionClient(node + "/forecast", ForecastTerrainAction)
        self.handle, self.ended = None, threading.Event()

    def wait_for_server(self, timeout=rospy.Duration()):
        return self.client.wait_for_server(timeout)

    def send_goal(self, goal, feedback_cb=None):
        self.ended = ended = threading.Event()

        def notice(handle):
            if handle.get_comm_state() == CommState.DONE:
                ended.set()

        self.handle = self.client.send_goal(goal, notice, feedback_cb and (lambda _, feedback: feedback_cb(feedback)))

    def cancel_goal(self):
        self.handle.cancel()

    def wait_for_result(self, timeout):
        return self.ended.wait(timeout.to_sec())

    def get_state(self):
        return self.handle.get_goal_status()

    def get_goal_status_text(self):
        return self.handle.get_goal_status_text()

    def get_result(self):
        return self.handle.get_result()
