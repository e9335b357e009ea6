#!/usr/bin/env python3
"""desert_run --export terrain.world, loaded by Gazebo 11: the ground at points of the world is that of the terrain, within a
centimetre.

    heights_test.py PLUGIN DESERT_RUN      exports terrains of its own
    heights_test.py PLUGIN WORLD PLY       one that is there
"""
import os
import re
import socket
import subprocess
import sys
import tempfile
import threading
import unittest

import numpy

PLUGIN, FILES = os.path.abspath(sys.argv[1]), [os.path.abspath(name) for name in sys.argv[2:]]
LONGEST = 120 * float(os.environ.get("DESERT_PATIENCE", "1"))  # [s]
POINTS = 100
WITHIN = 0.01  # [m]
INSIDE = 1 - 1e-6  # a ray to the very edge of a heightmap misses it
TERRAINS = {
    "flat": "grid: {width: 50, height: 20, cell_size: 0.5, boundary: open}\n"
            "terrain: [uniform: {layer: bedrock, value: -12.5}]\n",
    "open": "grid: {width: 300, height: 97, cell_size: 0.25, origin_x: 555160.25, origin_y: 4385105, boundary: open}\n"
            "terrain: [noise: {layer: bedrock, low: -420, high: -390, scale: 40}, noise: {layer: sand, low: 0, high: 3}]\n",
    "periodic": "grid: {width: 40, height: 333, cell_size: 3}\n"
                "terrain: [noise: {layer: bedrock, low: 0, high: 900, scale: 60}, noise: {layer: sand, low: 0, high: 3}]\n",
}


def vertices(ply):
    """x and y from the south-west corner, and the height of each cell."""
    with open(ply, "rb") as file:
        header, body = file.read().split(b"end_header\n", 1)
    kind = numpy.dtype([("place", "<f4", 3), ("normal", "<f4", 3), ("colour", "u1", 3)])
    return numpy.frombuffer(body, kind, int(re.search(rb"element vertex (\d+)", header)[1]))["place"].astype(float)


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def ground_of_gazebo(world, points):
    """What the plugin says of these points."""
    folder, name = os.path.split(world)
    with open(world, encoding="utf-8") as file:
        text = file.read().replace('<world name="desert">', '<world name="desert"><plugin name="p" filename="%s"/>' % PLUGIN)
    probed = os.path.join(folder, "probed_" + name)
    with open(probed, "w", encoding="utf-8") as file:
        file.write(text)
    with open(probed + ".txt", "w", encoding="utf-8") as file:
        file.writelines("%.9f %.9f %.9f\n" % tuple(point) for point in points)
    environment = dict(os.environ, DESERT_POINTS=probed + ".txt", GAZEBO_MODEL_DATABASE_URI="", HOME=folder,
                       GAZEBO_MASTER_URI="http://127.0.0.1:%d" % free_port())
    gazebo = subprocess.Popen(["gzserver", "--verbose", os.path.basename(probed)], cwd=folder, env=environment,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
    limit = threading.Timer(LONGEST, gazebo.kill)
    limit.start()
    said, heights = [], []
    for line in gazebo.stdout:
        said.append(line)
        if "GROUND end" in line:
            break
        if "GROUND " in line:
            words = line.split("GROUND ")[1].split()
            heights.append(float(words[2]) if words[3] == "terrain::ground::contact" else numpy.nan)
    limit.cancel()
    gazebo.kill()
    gazebo.communicate()
    return numpy.array(heights), "".join(said[-30:])


class Heights(unittest.TestCase):
    def expect_equal_heights(self, world, ply):
        with open(world, encoding="utf-8") as file:
            note = re.search(r"the origin is \((\S+), (\S+)\).*Gazebo's is \((\S+), (\S+)\)", file.read())
        west, south, middle_x, middle_y = map(float, note.groups())
        cells = vertices(ply) + [west - middle_x, south - middle_y, 0]
        chosen = cells[numpy.linspace(0, len(cells) - 1, POINTS).astype(int)] * [INSIDE, INSIDE, 1]
        heights, said = ground_of_gazebo(world, chosen)
        self.assertEqual(len(heights), POINTS, said)
        worst = numpy.max(numpy.abs(heights - chosen[:, 2]))
        print("%s: %d points, at most %.2f mm apart" % (os.path.basename(world), POINTS, 1000 * worst))
        self.assertLess(worst, WITHIN, said)

    @unittest.skipIf(len(FILES) > 1, "one world was given")
    def test_exported_worlds(self):
        for name, scenario in TERRAINS.items():
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                path = os.path.join(folder, name)
                with open(path + ".yaml", "w", encoding="utf-8") as file:
                    file.write(scenario)
                subprocess.run([FILES[0], path + ".yaml", "--steps", "2", "--backend", "cpu", "--quiet", "--export",
                                path + ".ply", "--export", path + ".world"], check=True, stdout=subprocess.DEVNULL)
                self.expect_equal_heights(path + ".world", path + ".ply")

    @unittest.skipIf(len(FILES) == 1, "none was given")
    def test_world(self):
        self.expect_equal_heights(*FILES)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
