#!/usr/bin/env python3
"""Whether the documentation tells what the node really has: its topics, services, their types, layers, parameters."""
import os
import re
import subprocess
import unittest

import desert_sim
import rosgraph
import rospkg
import rospy
import rosservice
import rostest
import yaml
from desert_sim.srv import GetSubmap
from desert_sim.testing import PATIENCE, program
from geometry_msgs.msg import Point

PACKAGE = rospkg.RosPack().get_path("desert_sim")
NODE = "/desert_sim"
OF_EVERY_NODE = {"/rosout", NODE + "/get_loggers", NODE + "/set_logger_level"}


def text_of(*path):
    with open(os.path.join(PACKAGE, *path)) as file:
        return file.read()


def table(first_column):
    """{name: type} of the table with this head, full names; a row may have several names of one type."""
    rows = re.search(r"^\| %s \| type \|.*\n\|[-|]+\n((?:\|.*\n)+)" % first_column,
                     text_of("doc", "robotics", "ros_interface.md"), re.M)
    assert rows, "doc/robotics/ros_interface.md has no table '%s | type'" % first_column
    found = {}
    for row in rows.group(1).splitlines():
        names, kind = row.split("|")[1:3]
        for name in re.findall("`(.+?)`", names):
            for each in of_each_layer(name.replace("~", NODE + "/")):
                assert each not in found, "%s stands twice" % each
                found[each] = kind.strip().strip("`")
    return found


def of_each_layer(name):
    """All topics that `~layers/<name>` stands for."""
    page = text_of("config", "node_parameters.md")
    layers = re.findall(r"^\| `(\w+)` \| \S+ \| [\d.]+ \|", page[page.index("## Layers of maps"):], re.M)
    return [name.replace("<name>", layer) for layer in layers] if "<name>" in name else [name]


def is_plugins(name):
    """image_transport's: as many as are installed."""
    return name.startswith(NODE + "/image/")


class Interface(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls):
        rospy.wait_for_service(NODE + "/reload_parameters", 60 * PATIENCE)  # the last to be advertised
        master = rosgraph.Master("/interface")
        cls.published, cls.subscribed, cls.services = (
            {name for name, nodes in kind if NODE in nodes and name not in OF_EVERY_NODE and not is_plugins(name)}
            for kind in master.getSystemState())
        cls.types = dict(master.getTopicTypes())

    def test_topics_that_are_published(self):
        self.assertEqual(table("topic"), {name: self.types[name] for name in self.published})

    def test_topics_that_are_listened_to(self):
        documented = table("topic it listens to")
        self.assertEqual(set(documented), self.subscribed)
        known = {name: self.types[name] for name in documented if self.types.get(name, "*") != "*"}
        self.assertLessEqual({NODE + "/cmd_wind", NODE + "/request_keyframe", "/clock", "/tf_static"}, set(known))
        self.assertEqual({name: documented[name] for name in known}, known)

    def test_services(self):
        self.assertEqual(table("service"), {name: rosservice.get_service_type(name) for name in self.services})

    def test_layers_of_get_submap(self):
        ask = rospy.ServiceProxy(NODE + "/get_submap", GetSubmap)
        answer = ask(center=Point(60, 20, 0), length_x=1, length_y=1)
        self.assertTrue(answer.success, answer.message)
        self.assertEqual([layer.name for layer in answer.map.layers], list(desert_sim.LAYERS))

    def test_page_of_parameters(self):
        page = subprocess.run([program("desert_sim_node"), "--describe"], stdout=subprocess.PIPE,
                              check=True, text=True).stdout
        self.assertEqual(page, text_of("config", "node_parameters.md"),
                         "stale: desert_sim_node --describe > config/node_parameters.md")

    def test_page_of_parameters_of_rovers(self):
        page = subprocess.run([program("desert_rover_node"), "--describe"], stdout=subprocess.PIPE,
                              check=True, text=True).stdout
        self.assertEqual(page, text_of("config", "rover_parameters.md"),
                         "stale: desert_rover_node --describe > config/rover_parameters.md")

    def test_page_of_parameters_of_planners(self):
        page = subprocess.run([program("desert_planner_node"), "--describe"], stdout=subprocess.PIPE,
                              check=True, text=True).stdout
        self.assertEqual(page, text_of("config", "planner_parameters.md"),
                         "stale: desert_planner_node --describe > config/planner_parameters.md")

    def test_publishers_yaml_has_the_defaults(self):
        """It shows what the topics' parameters are: all of them, as they are without it."""
        page = text_of("config", "node_parameters.md")
        topics = page[page.index("## Topics"):page.index("## Layers of maps")]
        documented = {name: yaml.safe_load(default.strip("`"))
                      for name, default in re.findall(r"^\| `(\w+)` \| (.*?) \|", topics, re.M)}
        for name, default in re.findall(r"`(\w+_(?:layers|thresholds))` \(default `(.*?)`\)", page):
            documented[name] = yaml.safe_load(default)
        self.assertEqual(documented, yaml.safe_load(text_of("config", "publishers.yaml")))


if __name__ == "__main__":
    rospy.init_node("interface")
    rostest.rosrun("desert_sim", "interface", Interface)
