#!/usr/bin/env python3
"""How long move_base needs from a change of the terrain to a plan round it, and whether it arrives: a rover drives over bare
rock upwind of the dunes of rover_barchans, and a dune is poured across its way of which only ~costmap_updates tell. After
`. build/devel/setup.bash`, with move_base installed:

    test/bench/move_base_replan.py [--frequencies 0 1 2] [--trials 5] [--cross]

Prints a line for each trial and medians for each planner_frequency. --cross lets it also drive once across the field,
between dunes that move, with a frequency of 1. Exit status 1 if a goal was not reached."""
import argparse
import os
import subprocess
import sys
import time

import numpy as np
import rospy
from actionlib_msgs.msg import GoalStatus
from dynamic_reconfigure.client import Client
from live_node import median  # finds the next two
from map_client import call
from move_base_client import Dune, MoveBaseRover, distance
from std_srvs.srv import Trigger

START, GOAL, DUNE = (12, 46), (44, 46), Dune(30, 40, 52)
FIELD_START, FIELD_GOAL = (12, 64), (236, 64)
SPEED = 0.3  # m/s


class Trials:
    def __init__(self):
        self.rover = MoveBaseRover()
        self.rover.keyframes(0)
        self.move_base = Client("/rover/move_base", timeout=60)
        self.failed = 0

    def begin(self, start, goal):
        assert call("reset", Trigger).success
        self.rover.put_down(*start)
        time.sleep(4)  # until the costmaps have forgotten the last trial
        self.rover.plans.messages.clear()
        self.rover.send_goal(*goal)

    def end(self, goal, straight):
        """Waits for it; how it went."""
        begin = rospy.get_time()
        end = self.rover.wait_for_end(10 * straight / SPEED)
        fine = end.status == GoalStatus.SUCCEEDED
        self.failed += not fine
        return "%s in %.0f s, %.1f m driven for %.1f, %.2f m from the goal" % (
            "arrived" if fine else "FAILED (%s)" % end.text, rospy.get_time() - begin, self.rover.metres(), straight,
            distance(self.rover.pose, goal))

    def trial(self, frequency):
        """Seconds from the change to the plan round it, and metres that the rover was then away from the dune."""
        self.move_base.update_configuration({"planner_frequency": frequency})
        self.begin(START, GOAL)
        self.rover.wait_for_plan(lambda plan: DUNE.meets(plan), "straight on", 30)
        assert self.rover.wait_until_x(START[0] + 3 + np.random.uniform(0, 0.6), 60), self.rover.pose
        DUNE.pour()
        poured = time.monotonic()
        self.rover.wait_for_plan(lambda plan: not DUNE.meets(plan), "a plan round the dune", 200)
        seconds = time.monotonic() - poured
        away = DUNE.x - self.rover.pose[0]
        how = self.end(GOAL, distance(START, GOAL))
        print("%.1f Hz: new plan after %5.2f s, %4.1f m before the dune; %s%s" % (
            frequency, seconds, away, how, "; it met the dune" if DUNE.meets(np.array(self.rover.way)) else ""), flush=True)
        return seconds, away

    def cross(self):
        self.move_base.update_configuration({"planner_frequency": 1})
        self.begin(FIELD_START, FIELD_GOAL)
        print("across the field: " + self.end(FIELD_GOAL, distance(FIELD_START, FIELD_GOAL)), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--frequencies", type=float, nargs="*", default=[0, 1, 2])
    parser.add_argument("--trials", type=int, default=5)
    parser.add_argument("--cross", action="store_true")
    arguments = parser.parse_args()
    launch = subprocess.Popen(["roslaunch", "desert_sim", "move_base_rover.launch", "gui:=false", "backend:=cpu"],
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        rospy.init_node("move_base_replan", disable_signals=True)
        trials = Trials()
        for frequency in arguments.frequencies:
            results = [trials.trial(frequency) for _ in range(arguments.trials)]
            seconds = [result[0] for result in results]
            print("%.1f Hz: median %.2f s, %.2f to %.2f s; load of the machine %.1f on %d processors" % (
                frequency, median(seconds), min(seconds), max(seconds), os.getloadavg()[0], os.cpu_count()), flush=True)
        if arguments.cross:
            trials.cross()
    finally:
        launch.terminate()
        launch.wait(60)
    return 1 if trials.failed else 0


if __name__ == "__main__":
    sys.exit(main())
