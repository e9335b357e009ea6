"""Where the hubs of a rover's wheels are, by the model that it publishes."""
from xml.etree import ElementTree

import numpy as np


class RobotModel:
    """The wheels of a robot_description, below base_link by joints that turn about an axis."""

    def __init__(self, description):
        robot = ElementTree.fromstring(description)
        above = {joint.find("child").get("link"): joint for joint in robot.findall("joint")}
        self.wheels = {}  # name in RoverStatus -> (radius, joints from base_link on)
        for link in robot.findall("link"):
            name = link.get("name")
            if not name.endswith("_wheel"):
                continue
            joints = []
            while name in above:
                joint = above[name]
                joints.insert(0, (joint.get("name"), self.numbers(joint.find("origin").get("xyz")),
                                  self.numbers(joint.find("axis").get("xyz"))))
                name = joint.find("parent").get("link")
            radius = float(link.find("visual/geometry/cylinder").get("radius"))
            self.wheels[link.get("name")[:-len("_wheel")]] = (radius, joints)

    @staticmethod
    def numbers(text):
        return np.array([float(word) for word in text.split()])

    def hubs(self, wheel, poses, joints):
        """In the terrain's frame, one row a pose: `poses` has x, y, z and the quaternion x, y, z, w; joints by name."""
        place, turned = poses[:, :3].copy(), poses[:, 3:]
        for name, origin, axis in self.wheels[wheel][1]:
            place += rotated(turned, origin)
            half = joints[name][:, None] / 2
            turned = product(turned, np.hstack([np.sin(half) * axis, np.cos(half)]))
        return place


def product(a, b):
    """Of quaternions x, y, z, w, row by row."""
    (x, y, z, w), (i, j, k, m) = a.T, b.T
    return np.stack([w * i + x * m + y * k - z * j, w * j - x * k + y * m + z * i, w * k + x * j - y * i + z * m,
                     w * m - x * i - y * j - z * k], axis=1)


def rotated(q, v):
    axis, w = q[:, :3], q[:, 3:]
    across = 2 * np.cross(axis, v)
    return v + w * across + np.cross(axis, across)
