#!/usr/bin/env python3
"""The command-line tools of ROS on a running node, as somebody types them."""
import os
import re
import shutil
import signal
import subprocess
import tempfile
import threading
import unittest

import rospy
import rostest
import yaml
from desert_sim.testing import PATIENCE

TIMEOUT = 30 * PATIENCE  # [s] a command; most take one
ENVIRONMENT = dict(os.environ, PYTHONUNBUFFERED="1")


def run(*words):
    """What a command prints; it must succeed."""
    done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=TIMEOUT,
                          env=ENVIRONMENT)
    assert done.returncode == 0, "%s: %s" % (" ".join(words), done.stdout)
    return done.stdout


def watch(pattern, *words):
    """The first match in what a command without an end prints."""
    process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=ENVIRONMENT,
                               start_new_session=True)
    watchdog = threading.Timer(TIMEOUT, os.killpg, (process.pid, signal.SIGKILL))
    watchdog.start()
    printed = ""
    try:
        for line in process.stdout:
            printed += line
            found = re.search(pattern, printed)
            if found:
                return found
        raise AssertionError("%s: no %s in: %s" % (" ".join(words), pattern, printed))
    finally:
        watchdog.cancel()
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        process.stdout.close()


class Tools(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="desert_sim_tools_")
        self.addCleanup(shutil.rmtree, self.folder)

    # ---- topics

    def test_rostopic_list_type_and_info(self):
        topics = run("rostopic", "list").split()
        for name in ("elevation", "elevation_updates", "grid_map", "local_map", "costmap", "costmap_updates", "image",
                     "wind", "wind_markers", "points",
                     "water_points", "plants", "plant_markers", "terrain_diff", "status", "cmd_wind", "request_keyframe"):
            self.assertIn("/desert_sim/" + name, topics)
        self.assertEqual(run("rostopic", "type", "/desert_sim/elevation").strip(), "desert_sim/ElevationGrid")
        self.assertEqual(run("rostopic", "type", "/desert_sim/grid_map").strip(), "grid_map_msgs/GridMap")
        self.assertIn("* /desert_sim (http://", run("rostopic", "info", "/desert_sim/grid_map"))

    def test_rostopic_hz_and_delay(self):
        rate = float(watch(r"average rate: (\S+)\n.*window: (?:[5-9]|\d\d)", "rostopic", "hz", "/desert_sim/elevation_updates")[1])
        self.assertTrue(5 < rate < 15, "10 Hz: %g" % rate)
        delay = float(watch(r"average delay: (\S+)\n", "rostopic", "delay", "/desert_sim/elevation")[1])
        self.assertTrue(0 <= delay < 5, delay)

    def test_rostopic_bw(self):
        # rostopic hz and echo need the Python class of a type, and grid_map_msgs may not be there; bw does not.
        for name, least in (("elevation_updates", 40), ("grid_map", 64 * 48 * 4), ("image", 64 * 48)):
            mean, unit = watch(r"mean: ([\d.]+)(K?M?B)", "rostopic", "bw", "/desert_sim/" + name).groups()
            self.assertGreater(float(mean) * {"B": 1, "KB": 1e3, "MB": 1e6}[unit], least, name)

    def test_rostopic_echo(self):
        grid = yaml.safe_load(run("rostopic", "echo", "-n1", "--noarr", "/desert_sim/elevation").partition("---")[0])
        self.assertEqual((grid["width"], grid["height"], grid["cell_size"]), (64, 48, 2))
        self.assertGreaterEqual(int(run("rostopic", "echo", "-n1", "/desert_sim/status/step").split()[0]), grid["step"])
        for name in ("wind", "costmap", "points", "image"):
            self.assertIn("frame_id: \"map\"", run("rostopic", "echo", "-n1", "--noarr", "/desert_sim/" + name))

    def test_rostopic_pub(self):
        run("rostopic", "pub", "-1", "/desert_sim/cmd_wind", "geometry_msgs/Vector3Stamped", "{vector: {x: 3.0, y: 4.0}}")
        watch(r"\ny: 4\.0\n", "rostopic", "echo", "/desert_sim/status/wind_above")

    # ---- services

    def test_rosservice(self):
        self.assertIn("/desert_sim/step", run("rosservice", "list").split())
        self.assertIn("Type: desert_sim/Step", run("rosservice", "info", "/desert_sim/step"))
        self.assertEqual(run("rosservice", "type", "/desert_sim/get_grid_map").strip(), "grid_map_msgs/GetGridMap")
        self.assertEqual(run("rosservice", "args", "/desert_sim/step").strip(), "steps")
        self.assertTrue(yaml.safe_load(run("rosservice", "call", "/desert_sim/pause"))["success"])
        before = yaml.safe_load(run("rosservice", "call", "/desert_sim/step", "{steps: 0}"))
        after = yaml.safe_load(run("rosservice", "call", "/desert_sim/step", "steps: 3"))
        self.assertEqual(after["step"], before["step"] + 3)
        self.assertNotEqual(after["state_hash"], before["state_hash"])
        refused = yaml.safe_load(run("rosservice", "call", "/desert_sim/set_wind", "{speed: .nan}"))
        self.assertFalse(refused["success"])
        self.assertIn("speed", refused["message"])
        self.assertTrue(yaml.safe_load(run("rosservice", "call", "/desert_sim/resume"))["success"])

    # ---- definitions, nodes, parameters, frames

    def test_rosmsg_and_rossrv(self):
        self.assertIn("desert_sim/LayerTile[] tiles", run("rosmsg", "show", "desert_sim/ElevationUpdate"))
        self.assertIn("desert_sim/ElevationGrid", run("rosmsg", "package", "desert_sim"))
        self.assertIn("string state_hash", run("rossrv", "show", "desert_sim/Step"))

    def test_rosnode(self):
        info = run("rosnode", "info", "/desert_sim")
        for part in ("/desert_sim/costmap_updates [map_msgs/OccupancyGridUpdate]", "/desert_sim/edit_terrain"):
            self.assertIn(part, info)
        self.assertIn("ping average", run("rosnode", "ping", "-c", "2", "/desert_sim"))

    def test_rosparam(self):
        self.assertEqual(run("rosparam", "get", "/desert_sim/step_rate").strip(), "20")
        run("rosparam", "set", "/desert_sim/step_rate", "25")
        answer = yaml.safe_load(run("rosservice", "call", "/desert_sim/reload_parameters"))
        self.assertIn("step_rate=25", answer["message"])
        self.assertEqual(run("rostopic", "echo", "-n1", "/desert_sim/status/step_rate").split()[0], "25.0")

    def test_dynparam(self):
        def dynparam(*words):
            return run("rosrun", "dynamic_reconfigure", "dynparam", *words)

        self.assertIn("/desert_sim", dynparam("list").split())
        dynparam("set", "/desert_sim", "saltation__lift", "0.3")
        self.assertIn("'saltation__lift': 0.3", dynparam("get", "/desert_sim"))
        file = os.path.join(self.folder, "parameters.yaml")
        dynparam("dump", "/desert_sim", file)
        dynparam("set", "/desert_sim", "saltation__lift", "0.7")
        dynparam("load", "/desert_sim", file)
        self.assertIn("'saltation__lift': 0.3", dynparam("get", "/desert_sim"))

    def test_tf_echo(self):
        found = watch(r"Translation: \[([\d.]+), ([\d.]+),", "rosrun", "tf", "tf_echo", "map",
                      "desert_sim/terrain_center")
        self.assertEqual((float(found[1]), float(found[2])), (10 + 64, -20 + 48))

    # ---- bags; test bags plays them

    def test_rosbag_record_and_info(self):
        bag = os.path.join(self.folder, "live.bag")
        topics = {"elevation": "desert_sim/ElevationGrid", "elevation_updates": "desert_sim/ElevationUpdate",
                  "grid_map": "grid_map_msgs/GridMap", "costmap": "nav_msgs/OccupancyGrid", "wind": "desert_sim/WindField",
                  "status": "desert_sim/SimulationStatus"}
        run("rosbag", "record", "--duration=2", "-O", bag, *("/desert_sim/" + name for name in topics))
        info = yaml.safe_load(run("rosbag", "info", "-y", bag))
        recorded = {topic["topic"]: (topic["type"], topic["messages"]) for topic in info["topics"]}
        for name, kind in topics.items():
            self.assertEqual(recorded["/desert_sim/" + name][0], kind)
            self.assertGreater(recorded["/desert_sim/" + name][1], 0)


if __name__ == "__main__":
    rospy.init_node("tools", disable_signals=True)
    rostest.rosrun("desert_sim", "tools", Tools)
