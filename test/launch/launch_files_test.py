#!/usr/bin/env python3
"""Launch files in a namespace, and with files in folders whose names have spaces: what roslaunch would start, without a
master."""
import os
import shlex
import tempfile
import unittest

import roslaunch.config
import roslaunch.loader
import roslaunch.rlutil
import rospkg
import yaml

LAUNCH = os.path.join(rospkg.RosPack().get_path("desert_sim"), "launch")


def config_of(name, *arguments, namespace=""):
    os.environ["ROS_NAMESPACE"] = namespace
    return roslaunch.config.load_config_default([(os.path.join(LAUNCH, name), list(arguments))], None, verbose=False)


def parameters(config):
    return {name: parameter.value for name, parameter in config.params.items()}


def node_of(config, name):
    return next(node for node in config.nodes if node.name == name)


class LaunchFiles(unittest.TestCase):
    def tearDown(self):
        os.environ.pop("ROS_NAMESPACE", None)

    def test_names_and_frames_without_a_namespace(self):
        config = config_of("bringup.launch", "planner:=field")
        p = parameters(config)
        self.assertEqual(p["/desert_sim/frame_id"], "map")
        self.assertEqual(p["/desert_sim/center_frame"], "desert_sim/terrain_center")
        self.assertEqual(p["/rover/desert_rover/tf_prefix"], "rover")
        self.assertEqual(p["/rover/desert_rover/terrain_node"], "desert_sim")
        self.assertEqual(p["/rover/desert_planner/goal_topic"], "move_base_simple/goal")
        self.assertIn("rover/base_link", p["/rover/robot_description"])

    def test_a_namespace_is_before_the_frames(self):
        for namespace in ("mars", "/mars", "/mars/"):
            config = config_of("bringup.launch", "planner:=field", namespace=namespace)
            p = parameters(config)
            self.assertEqual(p["/mars/desert_sim/frame_id"], "mars/map")
            self.assertEqual(p["/mars/desert_sim/center_frame"], "mars/desert_sim/terrain_center")
            for node in ("desert_rover", "desert_planner"):
                self.assertEqual(p["/mars/rover/%s/tf_prefix" % node], "mars/rover")
            self.assertIn("mars/rover/base_link", p["/mars/rover/robot_description"])
            rviz = node_of(config, "rviz").args
            self.assertIn("--tf-prefix 'mars/rover' -f mars/desert_sim/terrain_center", rviz)
        demo = node_of(config_of("demo.launch", namespace="mars"), "rviz")
        self.assertIn("-f mars/desert_sim/terrain_center", demo.args)

    def test_a_rover_on_a_dem_of_ones_own(self):
        config = config_of("bringup.launch", "dem:=/data/my dem.tif")
        p = parameters(config)
        self.assertEqual((p["/desert_sim/scenario"], p["/desert_sim/grid/from_raster"]), ("dem", "/data/my dem.tif"))
        self.assertEqual((p["/desert_sim/run/acceleration"], p["/desert_sim/run/time_step"]), (0.03, 0.003))
        self.assertNotIn("/rover/desert_rover/x", p, "it starts in the middle")
        self.assertIn("-f desert_sim/terrain_center", node_of(config, "rviz").args)
        p = parameters(config_of("bringup.launch", "dem:=/data/my dem.tif", "scenario:=wadi", "acceleration:=1"))
        self.assertEqual((p["/desert_sim/scenario"], p["/desert_sim/run/acceleration"]), ("wadi", 1))
        self.assertNotIn("/desert_sim/grid/from_raster", parameters(config_of("bringup.launch")))

    def test_rovers_start_where_headers_of_scenarios_say(self):
        def start(*arguments):
            p = parameters(config_of("bringup.launch", *arguments))
            return tuple(p.get("/rover/desert_rover/" + key) for key in ("x", "y"))
        self.assertEqual(start(), (12, 64))
        self.assertEqual(start("scenario:=flash_flood"), (236, 51))
        self.assertEqual(start("scenario:=flash_flood", "x:=20"), (20, None))
        self.assertEqual(start("scenario:=wadi"), (None, None))

    def test_the_demo_is_slow_unless_one_says_how_fast(self):
        def pace(*arguments):
            p = parameters(config_of("demo.launch", *arguments))
            return tuple(p.get("/desert_sim/" + key) for key in ("run/acceleration", "run/time_step", "step_rate"))
        self.assertEqual(pace(), (0.03, 0.003, 10))
        self.assertEqual(pace("rate:=5"), (None, None, 5))
        self.assertEqual(pace("rate:=0"), (None, None, 0))
        self.assertEqual(pace("acceleration:=2"), (2, 0.2, 10))
        self.assertEqual(pace("acceleration:=2", "time_step:=0.5"), (2, 0.5, 10))
        self.assertEqual(pace("acceleration:=0"), (0, None, 10))
        self.assertEqual(pace("scenario:=rover_barchans"), (None, None, 10), "the scenario has a pace")

    def test_the_demo_begins_with_crescents(self):
        def settings(*arguments):
            return parameters(config_of("demo.launch", *arguments))["/desert_sim/settings"]
        crescents, = settings()
        key, value = crescents.split("=", 1)
        file = yaml.safe_load(value)[1]["raster"]["file"]
        self.assertEqual((key, os.path.isfile(file)), ("terrain", True), crescents)
        self.assertEqual(settings("settings:=[wind.speed=7]"), ["wind.speed=7"])
        self.assertEqual(settings("scenario:=wadi"), [])

    def test_folders_with_spaces(self):
        with tempfile.TemporaryDirectory(prefix="a folder ") as folder:
            path = os.path.join(folder, "my rover.yaml")
            with open(path, "w", encoding="utf-8") as file:
                yaml.dump({"rover": {"seed": 31}, "lidar": {"rate": 0}}, file)
            config = config_of("bringup.launch", "rover_parameters:=" + path, "rviz_config:=" + path, "lidar:=true")
            p = parameters(config)
            self.assertEqual(p["/rover/desert_rover/rover/seed"], 31)
            self.assertNotIn("lidar", p["/rover/robot_description"], "the model is that of the file, too")
            self.assertEqual(shlex.split(node_of(config, "rviz").args)[:2], ["--config", path])
            demo = node_of(config_of("demo.launch", "rviz_config:=" + path), "rviz")
            self.assertEqual(shlex.split(demo.args)[:2], ["--config", path])


if __name__ == "__main__":
    unittest.main()
