#!/usr/bin/env python3
"""Watches a running desert_sim node without a display.

Prints a status line every 2 s for --seconds, then writes a hillshade of the terrain to desert_demo.png.
Exit status 1, with the reason, if no status or no elevation came, or the terrain did not change.
"""
import argparse
import sys
import time

import cv2
import desert_sim
import numpy as np
import rosgraph
import rospy
from desert_sim.msg import SimulationStatus
from desert_sim.picture import hillshade


class Watcher:
    """Keeps the last status, the first and the last map of the elevation."""

    def __init__(self, node):
        self.status = self.first = self.last = None
        self.subscriber = rospy.Subscriber(node + "/status", SimulationStatus, self.on_status, queue_size=1)
        self.terrain = desert_sim.TerrainClient(node, on_change=self.on_change)

    def on_status(self, message):
        self.status = message

    def on_change(self, change):
        self.first, self.last = self.first or change.map, change.map

    def line(self):
        """One line about the present state."""
        status, ground = self.status, self.last
        if status is None:
            return "waiting for the node"
        size = "no elevation yet" if ground is None else "%d x %d cells" % (ground.width, ground.height)
        return "%-8s %s  step %6d  sim time %8.1f s  %6.1f steps/s  %s" % (
            status.state, status.backend, status.step, status.sim_time, status.steps_per_second, size)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--node", default="/desert_sim")
    parser.add_argument("--picture", default="desert_demo.png")
    options = parser.parse_args(rospy.myargv()[1:])

    master = time.monotonic() + 30.0  # rospy would wait for ever
    while not rosgraph.is_master_online():
        if time.monotonic() > master:
            sys.exit("demo: there is no ROS master: roslaunch did not start")
        time.sleep(0.1)
    rospy.init_node("demo_headless", anonymous=True, disable_signals=True)
    watcher = Watcher(options.node)
    end = time.monotonic() + options.seconds
    while time.monotonic() < end and not rospy.is_shutdown():
        time.sleep(max(0.0, min(2.0, end - time.monotonic())))
        print(watcher.line(), flush=True)

    first, last = watcher.first, watcher.last
    if watcher.status is None:
        sys.exit("demo: no status on %s/status: the node did not come up" % options.node)
    if last is None:
        sys.exit("demo: no terrain on %s/elevation" % options.node)
    cv2.imwrite(options.picture, hillshade(last))
    print("picture: " + options.picture)
    if first.step == last.step:
        sys.exit("demo: only one state of the terrain came (step %d)" % last.step)
    change = np.abs(last.values - first.values)
    print("terrain changed by up to %.3f m, %.4f m on average, from step %d to %d" % (
        np.nanmax(change), np.nanmean(change), first.step, last.step))
    if not np.nanmax(change) > 0.0:
        sys.exit("demo: the terrain did not change")


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit(130)
