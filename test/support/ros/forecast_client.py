"""A client of ~forecast for tests."""
import threading

from actionlib import ActionClient, CommState
from actionlib_msgs.msg import GoalID
from desert_sim.msg import ForecastTerrainAction
from desert_sim.testing import PATIENCE, wait_until
import rospy

# Forecasts are made in time that no other thread wants: on a machine that is busy otherwise, a thousandth of a processor.
LIMIT = 300  # [s]


class ForecastClient:
    """Has one goal at a time. It is used as actionlib's SimpleActionClient, to which an answer is lost that comes before
    its send_goal() has returned, as that of a node that refuses may. No goal of it gets LOST either."""

    def __init__(self, node):
        self.client = ActionClient(node + "/forecast", ForecastTerrainAction)
        self.handle, self.ended, self.feedback = None, threading.Event(), []
        assert self.client.wait_for_server(rospy.Duration(LIMIT * PATIENCE)), "no server of %s/forecast" % node

    def send_goal(self, goal):
        """What is told of it comes to the list `feedback`."""
        self.ended, self.feedback = ended, feedback = threading.Event(), []

        def notice(handle):
            if handle.get_comm_state() == CommState.DONE:
                ended.set()

        self.handle = self.client.send_goal(goal, notice, lambda _, told: feedback.append(told))

    def cancel_goal(self):
        """The handle would take a goal for lost that the server does not know yet when the handle cancels it."""
        self.client.pub_cancel.publish(GoalID(id=self.handle.comm_state_machine.action_goal.goal_id.id))

    def wait_until_known(self):
        """Until the node has said that it has the goal, or has ended it."""
        wait_until(lambda: self.handle.get_comm_state() != CommState.WAITING_FOR_GOAL_ACK,
                   "nothing is said of the goal", LIMIT)

    def wait_until_running(self):
        """Until the forecast has made steps, or has ended."""
        wait_until(lambda: self.ended.is_set() or self.feedback and self.feedback[-1].time > 0, "no feedback", LIMIT)

    def wait_for_result(self, seconds=LIMIT):
        """At most so long (times PATIENCE); whether the goal has ended."""
        return self.ended.wait(seconds * PATIENCE)

    def get_state(self):
        return self.handle.get_goal_status()

    def get_goal_status_text(self):
        return self.handle.get_goal_status_text()

    def get_result(self):
        return self.handle.get_result()
