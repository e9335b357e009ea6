#!/usr/bin/env python3
"""Watches a running desert_sim node without a display.

Prints a status line every 2 s for --seconds, then writes a hillshade of the terrain to desert_demo.png.
Exit status 1, with the reason, if no status or no elevation came, or the terrain did not change.
"""
import argparse
import sys
import threading
import time

import cv2
import numpy as np
import rosgraph
import rospy
from desert_sim.msg import ElevationGrid, SimulationStatus


class Watcher:
    """Keeps the last status, the first and the last elevation grid."""

    def __init__(self, node):
        self.lock = threading.Lock()
        self.status = None
        self.first = None
        self.last = None
        rospy.Subscriber(node + "/status", SimulationStatus, self.on_status, queue_size=1)
        rospy.Subscriber(node + "/elevation", ElevationGrid, self.on_elevation, queue_size=1, buff_size=1 << 28)

    def on_status(self, message):
        with self.lock:
            self.status = message

    def on_elevation(self, message):
        with self.lock:
            self.first = self.first or message
            self.last = message

    def line(self):
        """One line about the present state."""
        with self.lock:
            status, grid = self.status, self.last
        if status is None:
            return "waiting for the node"
        size = "no elevation yet" if grid is None else "%d x %d cells" % (grid.width, grid.height)
        return "%-8s %s  step %6d  sim time %8.1f s  %6.1f steps/s  %s" % (
            status.state, status.backend, status.step, status.sim_time, status.steps_per_second, size)


def heights(grid):
    """Elevation [m] as an array, north up, unknown cells at the lowest known height."""
    z = np.asarray(grid.elevation, dtype=np.float32).reshape(grid.height, grid.width)[::-1]
    return np.nan_to_num(z, nan=np.nanmin(z))


def hillshade(grid, azimuth_deg=315.0, altitude_deg=30.0):
    """Colour picture (BGR, uint8): sand tint by height, lit from the north-west."""
    z = heights(grid)
    dz_dy, dz_dx = np.gradient(z, grid.cell_size)
    dz_dy = -dz_dy  # rows run south
    azimuth, altitude = np.radians([90.0 - azimuth_deg, altitude_deg])
    light = np.array([np.cos(azimuth) * np.cos(altitude), np.sin(azimuth) * np.cos(altitude), np.sin(altitude)])
    shade = (-dz_dx * light[0] - dz_dy * light[1] + light[2]) / np.sqrt(dz_dx**2 + dz_dy**2 + 1.0)
    height = (z - z.min()) / max(float(np.ptp(z)), 1e-6)
    low, high = np.array([92.0, 142.0, 190.0]), np.array([170.0, 214.0, 244.0])  # BGR
    colour = low + (high - low) * height[..., None]
    return np.clip(colour * (0.25 + 0.95 * np.clip(shade, 0.0, 1.0))[..., None], 0, 255).astype(np.uint8)


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

    if watcher.status is None:
        sys.exit("demo: no status on %s/status: the node did not come up" % options.node)
    if watcher.last is None:
        sys.exit("demo: no terrain on %s/elevation" % options.node)
    cv2.imwrite(options.picture, hillshade(watcher.last))
    print("picture: " + options.picture)
    if watcher.first.step == watcher.last.step:
        sys.exit("demo: only one state of the terrain came (step %d)" % watcher.last.step)
    change = np.abs(heights(watcher.last) - heights(watcher.first))
    print("terrain changed by up to %.3f m, %.4f m on average, from step %d to %d" % (
        change.max(), change.mean(), watcher.first.step, watcher.last.step))
    if not change.max() > 0.0:
        sys.exit("demo: the terrain did not change")


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit(130)
