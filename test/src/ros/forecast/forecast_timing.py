#!/usr/bin/env python3
"""A hundred forecasts, and the rate of the live run beside them."""
import statistics

from actionlib import GoalStatus
from desert_sim.msg import ForecastTerrainGoal, SimulationStatus
from desert_sim.testing import wait_until
from forecast_client import ForecastClient
from node_tests import CORNER, Scenarios
import rospy
import rostest

FORECASTS = 100


class ForecastTiming(Scenarios):
    def rate(self, node):
        """Steps a second by the stamps of two states, fifty steps or more apart."""
        first = node.latest("status", SimulationStatus)
        states = [first]

        def far_on():
            states.append(node.latest("status", SimulationStatus))
            return states[-1].step >= first.step + 50

        wait_until(far_on, "the live run stands still")
        return (states[-1].step - first.step) / (states[-1].header.stamp - first.header.stamp).to_sec()

    def test_the_rate_of_the_live_run_beside_forecasts(self):
        node = self.start("untouched", {"scenario": CORNER, "paused": False, "step_rate": 100, "status_rate": 50})
        client, rates = ForecastClient("/untouched"), {False: [], True: []}
        for n in range(FORECASTS):
            if n % 20 == 0:
                rates[False].append(self.rate(node))
            client.send_goal(ForecastTerrainGoal(horizon=5000, moments=10, members=2, gust_time=1))
            if n % 20 == 10:
                client.wait_until_running()
                rates[True].append(self.rate(node))
            client.cancel_goal()
            self.assertTrue(client.wait_for_result(), "no result")
            self.assertIn(client.get_state(), (GoalStatus.PREEMPTED, GoalStatus.RECALLED))
        print("steps a second: %s alone, %s beside forecasts" % tuple(
            ["%.1f" % rate for rate in rates[beside]] for beside in (False, True)))
        self.assertGreater(statistics.median(rates[True]), 0.8 * statistics.median(rates[False]))


if __name__ == "__main__":
    rospy.init_node("forecast_timing", disable_signals=True)
    rostest.rosrun("desert_sim", "forecast_timing", ForecastTiming)
