#!/usr/bin/env python3
"""A node that follows the clock of a bag: with no clock yet it answers and says that it waits; while the bag plays in a
loop, so that time jumps back again and again, it goes on in the time of the bag. (How many steps there are in a time that
jumps back is a matter of clock.py, which moves the clock itself.)"""
import os
import shutil
import signal
import subprocess
import tempfile
import unittest

from desert_sim.msg import ElevationUpdate, SimulationStatus
from desert_sim.srv import EditTerrain, EditTerrainRequest, QueryTerrain, SaveCheckpoint, SetWind, Step
from desert_sim.testing import PATIENCE, wait_until
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Point
import rosbag
from rosgraph_msgs.msg import Clock
import rospy
import rostest
from std_msgs.msg import Empty
from std_srvs.srv import Trigger

BEGIN, SECONDS = 1500000000, 0.5  # of the bag


class BagClock:
    """How often time went back, as /clock tells it."""

    def __init__(self):
        self.now, self.back = rospy.Time(), 0
        rospy.Subscriber("/clock", Clock, self.take)

    def take(self, message):
        self.back += message.clock < self.now
        self.now = message.clock


def call(service, kind, *arguments, **fields):
    rospy.wait_for_service("/desert_sim/" + service, 60 * PATIENCE)
    return rospy.ServiceProxy("/desert_sim/" + service, kind)(*arguments, **fields)


class FollowsABag(unittest.TestCase):
    def setUp(self):
        self.status, self.diagnosis, self.updates = None, {}, []
        rospy.Subscriber("/desert_sim/status", SimulationStatus, self.take_status)
        rospy.Subscriber("/diagnostics", DiagnosticArray, self.take_diagnosis)
        rospy.Subscriber("/desert_sim/elevation_updates", ElevationUpdate, self.updates.append)
        self.folder = tempfile.mkdtemp(prefix="desert_sim_bag_clock_")
        self.addCleanup(shutil.rmtree, self.folder)

    def take_status(self, message):
        self.status = message

    def take_diagnosis(self, message):
        for status in message.status:
            self.diagnosis[status.name] = (status.level, status.message)

    def play(self):
        path = os.path.join(self.folder, "time.bag")
        with rosbag.Bag(path, "w") as bag:
            for n in range(int(20 * SECONDS) + 1):
                bag.write("/tick", Empty(), rospy.Time.from_sec(BEGIN + n / 20.0))
        player = subprocess.Popen(["rosrun", "rosbag", "play", "--quiet", "--clock", "--loop", path],
                                  stdin=subprocess.DEVNULL)
        self.addCleanup(player.wait)
        self.addCleanup(player.send_signal, signal.SIGINT)

    def test_no_clock_and_then_one_that_jumps_back(self):
        # Nobody publishes /clock.
        wait_until(lambda: self.status and self.status.state == "waiting", "status does not say that it waits")
        name = "desert_sim: simulation"
        wait_until(lambda: name in self.diagnosis, "no diagnostics")
        wait_until(lambda: "/clock" in self.diagnosis[name][1], self.diagnosis[name])
        self.assertEqual(self.diagnosis[name][0], 1)
        self.assertTrue(call("query_terrain", QueryTerrain, points=[Point(20, 20, 0)]).success)
        self.assertTrue(call("set_wind", SetWind, speed=6, direction_deg=20).success)
        heap = EditTerrainRequest(layer="sand", shape="circle", merge="add", center=Point(40, 10, 0), radius=4, value=1)
        self.assertTrue(call("edit_terrain", EditTerrain, heap).success)
        self.assertTrue(call("save_checkpoint", SaveCheckpoint, "waiting.ckpt").success)
        self.assertEqual(call("step", Step, 3).step, 3)
        self.assertTrue(call("pause", Trigger).success)
        wait_until(lambda: self.status.state == "paused", "it is not paused")
        self.assertTrue(call("resume", Trigger).success)
        wait_until(lambda: self.status.state == "waiting", "it does not wait again")
        self.assertEqual(self.status.step, 3)

        clock = BagClock()
        self.play()
        wait_until(lambda: self.status.state == "running" and clock.back >= 1, "it does not run")
        for _ in range(4):
            back, step = clock.back, self.status.step
            wait_until(lambda: clock.back > back and self.status.step > step, "it does not go on")  # noqa: B023
            self.assertLess(self.status.lag, 1.5, "time that went back is no lag")
        wait_until(lambda: self.updates[-1].header.stamp.to_sec() >= BEGIN, "updates are of the bag's time")
        self.assertLessEqual(self.updates[-1].header.stamp.to_sec(), BEGIN + SECONDS + 1)
        self.assertTrue(call("query_terrain", QueryTerrain, points=[Point(20, 20, 0)]).success)


if __name__ == "__main__":
    rospy.init_node("bag_clock", disable_signals=True)
    rostest.rosrun("desert_sim", "bag_clock", FollowsABag)
