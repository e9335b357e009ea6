#!/usr/bin/env python3
"""The command-line tools of ROS on a running node, as somebody types them."""
import functools
import os
import re
import shlex
import signal
import subprocess
import tempfile
import threading
import unittest
from concurrent.futures import ThreadPoolExecutor

import rospy
import rostest
import yaml
from desert_sim.testing import PATIENCE

TIMEOUT = 300 * PATIENCE  # [s] a command; most take one
ENVIRONMENT = dict(os.environ, PYTHONUNBUFFERED="1")


def run(*words):
    """What a command prints; it must succeed."""
    done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=TIMEOUT,
                          env=ENVIRONMENT)
    assert done.returncode == 0, "%s: %s" % (" ".join(words), done.stdout)
    return done.stdout


def run_all(*commands):
    """What each of these commands prints, which run at the same time."""
    with ThreadPoolExecutor(len(commands)) as pool:
        return list(pool.map(lambda command: run(*shlex.split(command)), commands))


class Endless:
    """A command without an end, for the length of a `with`."""

    def __init__(self, *words):
        self.words = words

    def __enter__(self):
        self.process = subprocess.Popen(self.words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                        env=ENVIRONMENT, start_new_session=True)
        self.watchdog = threading.Timer(TIMEOUT, self.kill)
        self.watchdog.start()
        return self

    def first(self, pattern):
        """The first match in what it prints."""
        printed = ""
        for line in self.process.stdout:
            printed += line
            found = re.search(pattern, printed)
            if found:
                return found
        raise AssertionError("%s: no %s in: %s" % (" ".join(self.words), pattern, printed))

    def kill(self):
        if self.process.poll() is None:
            os.killpg(self.process.pid, signal.SIGKILL)

    def __exit__(self, *_):
        self.watchdog.cancel()
        self.kill()
        self.process.wait()
        self.process.stdout.close()


def watch(pattern, *words):
    with Endless(*words) as command:
        return command.first(pattern)


def at_once(test):
    """A test that begins together with all others of its class. What it runs mostly waits: for an interpreter to start, for
    the master, for a message. No two of them change the same thing."""
    @functools.wraps(test)
    def wait_for_it(self):
        self.begun[test.__name__].result()

    wait_for_it.test = test
    return wait_for_it


class Tools(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        tests = {name: member.test for name, member in vars(cls).items() if hasattr(member, "test")}
        with ThreadPoolExecutor(len(tests)) as pool:
            cls.begun = {name: pool.submit(test, cls(name)) for name, test in tests.items()}

    # ---- topics

    @at_once
    def test_rostopic_list_type_and_info(self):
        topics, elevation, grid_map, info = run_all(
            "rostopic list", "rostopic type /desert_sim/elevation", "rostopic type /desert_sim/grid_map",
            "rostopic info /desert_sim/grid_map")
        for name in ("elevation", "elevation_updates", "grid_map", "local_map", "costmap", "costmap_updates", "image",
                     "wind", "wind_markers", "points",
                     "water_points", "plants", "plant_markers", "terrain_diff", "status", "cmd_wind", "request_keyframe"):
            self.assertIn("/desert_sim/" + name, topics.split())
        self.assertEqual(elevation.strip(), "desert_sim/ElevationGrid")
        self.assertEqual(grid_map.strip(), "grid_map_msgs/GridMap")
        self.assertIn("* /desert_sim (http://", info)

    @at_once
    def test_rostopic_hz(self):
        rate = watch(r"average rate: (\S+)\n.*window: (?:[5-9]|\d\d)", "rostopic", "hz", "/desert_sim/elevation_updates")[1]
        self.assertGreater(float(rate), 0)

    @at_once
    def test_rostopic_delay(self):
        """Stamps are ROS time: anything else is decades away."""
        delay = float(watch(r"average delay: (\S+)\n", "rostopic", "delay", "/desert_sim/elevation")[1])
        self.assertTrue(0 <= delay < 2 * TIMEOUT, delay)

    @at_once
    def test_rostopic_bw(self):
        # rostopic hz and echo need the Python class of a type, and grid_map_msgs may not be there; bw does not.
        # It gives sizes in the unit of the rate, with two decimals: where messages come in a burst, small ones have 0.00MB,
        # and the next second tells more.
        for name, least in (("elevation_updates", 40), ("grid_map", 64 * 48 * 4), ("image", 64 * 48)):
            mean, unit = watch(r"mean: (?!0\.00)([\d.]+)(K?M?B)", "rostopic", "bw", "/desert_sim/" + name).groups()
            self.assertGreater((float(mean) + 0.005) * {"B": 1, "KB": 1e3, "MB": 1e6}[unit], least, name)

    @at_once
    def test_rostopic_echo(self):
        grid = yaml.safe_load(run("rostopic", "echo", "-n1", "--noarr", "/desert_sim/elevation").partition("---")[0])
        self.assertEqual((grid["width"], grid["height"], grid["cell_size"]), (64, 48, 2))
        step, *messages = run_all("rostopic echo -n1 /desert_sim/status/step",
                                  *("rostopic echo -n1 --noarr /desert_sim/" + name
                                    for name in ("wind", "costmap", "points", "image")))
        self.assertGreaterEqual(int(step.split()[0]), grid["step"])
        for message in messages:
            self.assertIn("frame_id: \"map\"", message)

    @at_once
    def test_rostopic_pub(self):
        # Once (-1) would be for three seconds, in which a busy node may not have connected.
        with Endless("rostopic", "pub", "/desert_sim/cmd_wind", "geometry_msgs/Vector3Stamped",
                     "{vector: {x: 3.0, y: 4.0}}"):
            watch(r"\ny: 4\.0\n", "rostopic", "echo", "/desert_sim/status/wind_above")

    # ---- services

    @at_once
    def test_rosservice(self):
        services, info, kind, arguments, refused = run_all(
            "rosservice list", "rosservice info /desert_sim/step", "rosservice type /desert_sim/get_grid_map",
            "rosservice args /desert_sim/step", "rosservice call /desert_sim/set_wind '{speed: .nan}'")
        self.assertIn("/desert_sim/step", services.split())
        self.assertIn("Type: desert_sim/Step", info)
        self.assertEqual(kind.strip(), "grid_map_msgs/GetGridMap")
        self.assertEqual(arguments.strip(), "steps")
        refused = yaml.safe_load(refused)
        self.assertFalse(refused["success"])
        self.assertIn("speed", refused["message"])

    @at_once
    def test_rosservice_call(self):
        self.assertTrue(yaml.safe_load(run("rosservice", "call", "/desert_sim/pause"))["success"])
        before = yaml.safe_load(run("rosservice", "call", "/desert_sim/step", "{steps: 0}"))
        after = yaml.safe_load(run("rosservice", "call", "/desert_sim/step", "steps: 3"))
        self.assertEqual(after["step"], before["step"] + 3)
        self.assertNotEqual(after["state_hash"], before["state_hash"])
        self.assertTrue(yaml.safe_load(run("rosservice", "call", "/desert_sim/resume"))["success"])

    # ---- definitions, nodes, parameters, frames

    @at_once
    def test_rosmsg_and_rossrv(self):
        update, package, step = run_all("rosmsg show desert_sim/ElevationUpdate", "rosmsg package desert_sim",
                                        "rossrv show desert_sim/Step")
        self.assertIn("desert_sim/LayerTile[] tiles", update)
        self.assertIn("desert_sim/ElevationGrid", package)
        self.assertIn("string state_hash", step)

    @at_once
    def test_rosnode(self):
        info, ping = run_all("rosnode info /desert_sim", "rosnode ping -c 2 /desert_sim")
        for part in ("/desert_sim/costmap_updates [map_msgs/OccupancyGridUpdate]", "/desert_sim/edit_terrain"):
            self.assertIn(part, info)
        self.assertIn("ping average", ping)

    @at_once
    def test_rosparam(self):
        self.assertEqual(run("rosparam", "get", "/desert_sim/step_rate").strip(), "20")
        run("rosparam", "set", "/desert_sim/step_rate", "25")
        answer = yaml.safe_load(run("rosservice", "call", "/desert_sim/reload_parameters"))
        self.assertIn("step_rate=25", answer["message"])
        self.assertEqual(run("rostopic", "echo", "-n1", "/desert_sim/status/step_rate").split()[0], "25.0")

    @at_once
    def test_dynparam(self):
        def dynparam(*words):
            return run("rosrun", "dynamic_reconfigure", "dynparam", *words)

        self.assertIn("/desert_sim", dynparam("list").split())
        with tempfile.TemporaryDirectory(prefix="desert_sim_tools_") as folder:
            file = os.path.join(folder, "parameters.yaml")
            dynparam("set", "/desert_sim", "saltation__lift", "0.3")
            dynparam("dump", "/desert_sim", file)
            dynparam("set", "/desert_sim", "saltation__lift", "0.7")
            self.assertIn("'saltation__lift': 0.7", dynparam("get", "/desert_sim"))
            dynparam("load", "/desert_sim", file)
            self.assertIn("'saltation__lift': 0.3", dynparam("get", "/desert_sim"))

    @at_once
    def test_tf_echo(self):
        found = watch(r"Translation: \[([\d.]+), ([\d.]+),", "rosrun", "tf", "tf_echo", "map",
                      "desert_sim/terrain_center")
        self.assertEqual((float(found[1]), float(found[2])), (10 + 64, -20 + 48))

    # ---- bags; test bags plays them

    @at_once
    def test_rosbag_record_and_info(self):
        topics = {"elevation": "desert_sim/ElevationGrid", "elevation_updates": "desert_sim/ElevationUpdate",
                  "grid_map": "grid_map_msgs/GridMap", "costmap": "nav_msgs/OccupancyGrid", "wind": "desert_sim/WindField",
                  "status": "desert_sim/SimulationStatus"}
        with tempfile.TemporaryDirectory(prefix="desert_sim_tools_") as folder:
            bag = os.path.join(folder, "live.bag")
            # It ends when it has two messages of each.
            run("rosbag", "record", "--limit=2", "-O", bag, *("/desert_sim/" + name for name in topics))
            info = yaml.safe_load(run("rosbag", "info", "-y", bag))
        recorded = {topic["topic"]: (topic["type"], topic["messages"]) for topic in info["topics"]}
        self.assertEqual(recorded, {"/desert_sim/" + name: (kind, 2) for name, kind in topics.items()})


if __name__ == "__main__":
    rospy.init_node("tools", disable_signals=True)
    rostest.rosrun("desert_sim", "tools", Tools)
