#!/usr/bin/env python3
"""Terrain in bags: what ~save_terrain writes is read by rosbag's own library, and what that writes is loaded."""
import array
import glob
import math
import os
import shutil
import subprocess

from desert_sim.msg import ElevationGrid
from desert_sim.srv import LoadScenario, LoadTerrain, SaveTerrain, Step
import genpy.dynamic
from map_client import GRID_MAP, GRID_MAP_MD5, Listener, MapTest, call, cells, center, elevation, parts
import rosbag
import rospy
import rostest
from std_msgs.msg import Float32MultiArray, MultiArrayDimension, String

TYPES = genpy.dynamic.generate_dynamic("grid_map_msgs/GridMap", GRID_MAP + parts())


def a_map(width=6, height=4, start=(0, 0)):
    """Elevation 10 + x + 10 y on cells of 2 m around (100, 50), in a circular buffer that begins at `start`."""
    m = TYPES["grid_map_msgs/GridMap"]()
    m.info.header.frame_id = "odom"
    m.info.resolution, m.info.length_x, m.info.length_y = 2, 2 * width, 2 * height
    m.info.pose.position.x, m.info.pose.position.y, m.info.pose.orientation.w = 100, 50, 1
    layer = Float32MultiArray()
    layer.layout.dim = [MultiArrayDimension("column_index", height, width * height),
                        MultiArrayDimension("row_index", width, width)]
    values = array.array("f", [0] * (width * height))
    for row in range(width):
        for column in range(height):
            at = (column + start[1]) % height * width + (row + start[0]) % width
            values[at] = 10 + (width - 1 - row) + 10 * (height - 1 - column)
    layer.data = list(values)
    m.layers, m.basic_layers, m.data = ["elevation"], ["elevation"], [layer]
    m.outer_start_index, m.inner_start_index = start
    return m


class TerrainBags(MapTest):
    folder = rospy.get_param("/desert_sim/data_dir")

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder, ignore_errors=True)

    def setUp(self):
        os.makedirs(self.folder, exist_ok=True)
        with open(os.path.join(self.folder, "start.yaml"), "w") as file:
            with open(rospy.get_param("/desert_sim/scenario")) as corner:
                file.write(corner.read() + "\navalanching: {enabled: false}\n")
        self.assertTrue(call("load_scenario", LoadScenario, name="start.yaml").success)

    def hash(self):
        return call("step", Step, steps=0).state_hash

    def write(self, name, *messages, topic="/robot/elevation_map"):
        path = os.path.join(self.folder, name)
        with rosbag.Bag(path, "w") as bag:
            for n, message in enumerate(messages):
                bag.write(topic, message, rospy.Time(1500000000 + n))
        return path

    def load(self, name, **fields):
        return call("load_terrain", LoadTerrain, name=name, **fields)

    def keyframe(self, width):
        with Listener("/desert_sim/elevation", ElevationGrid) as listener:
            return listener.wait_for(lambda m: m.width == width, "a keyframe %d cells wide" % width)

    def expect_refused(self, name, *texts):
        before = self.hash()
        answer = self.load(name)
        self.assertFalse(answer.success)
        for text in texts + (name,):
            self.assertIn(text, answer.message)
        self.assertEqual(self.hash(), before)

    def test_saved_is_what_rosbag_and_grid_map_know(self):
        saved = call("save_terrain", SaveTerrain, name="sites/a", format="rosbag")
        self.assertTrue(saved.success, saved.message)
        path, = glob.glob(os.path.join(self.folder, "sites", "a", "*.bag"))
        with rosbag.Bag(path) as bag:
            (topic, message, _), = bag.read_messages()
            connection, = bag._get_connections()
        self.assertEqual(topic, "/desert_sim/grid_map")
        self.assertEqual((connection.datatype, connection.md5sum), ("grid_map_msgs/GridMap", GRID_MAP_MD5))
        self.assertEqual(connection.header["latching"], b"1")
        self.assertEqual(message.info.header.frame_id, "terrain")
        self.assertEqual(message.layers, ["elevation", "bedrock", "sand_depth", "airborne_sand"])
        heights, rock, sand = (cells(message, layer) for layer in ("elevation", "bedrock", "sand_depth"))
        self.assertEqual(len(heights), 64 * 48)
        for x in range(64):
            for y in range(48):
                at = center(x, y)
                self.assertAlmostEqual(heights[at], elevation(x, y), 5)
                self.assertAlmostEqual(rock[at] + sand[at], elevation(x, y), 5)

    def test_saved_comes_back_from_folder_and_bag(self):
        call("step", Step, steps=3)
        before = self.keyframe(64)
        self.assertTrue(call("save_terrain", SaveTerrain, name="b", format="rosbag").success)
        path, = glob.glob(os.path.join(self.folder, "b", "*.bag"))
        for name in ("b", os.path.relpath(path, self.folder)):
            self.write("small.bag", a_map())
            self.assertTrue(self.load("small.bag").success)
            self.keyframe(6)
            answer = self.load(name)
            self.assertTrue(answer.success, answer.message)
            self.assertEqual(answer.state_hash, self.hash())
            after = self.keyframe(64)
            self.assertEqual(after.origin, before.origin)
            for a, b in zip(before.elevation, after.elevation):
                self.assertAlmostEqual(a, b, 5)

    def test_play_shows_it_to_whoever_comes_late(self):
        self.assertTrue(call("save_terrain", SaveTerrain, name="c", format="rosbag").success)
        path, = glob.glob(os.path.join(self.folder, "c", "*.bag"))
        player = subprocess.Popen(["rosbag", "play", "--quiet", "--keep-alive", path, "/desert_sim/grid_map:=/played"])
        self.addCleanup(player.wait)
        self.addCleanup(player.terminate)
        with Listener("/played") as early:
            early.first("nothing is played")
        with Listener("/played") as late:
            message = late.first("the map")
            self.assertEqual(late.header["latching"], "1")
        self.assertAlmostEqual(cells(message, "elevation")[center(57, 5)], 7.5, 5)

    def test_a_map_of_somebody_else(self):
        for start in ((0, 0), (2, 3), (5, 1)):
            self.write("robot.bag", a_map(3, 3), a_map(6, 4, start))
            answer = self.load("robot.bag")
            self.assertTrue(answer.success, answer.message)
            grid = self.keyframe(6)
            self.assertEqual((grid.height, grid.cell_size), (4, 2))
            self.assertEqual((grid.origin.position.x, grid.origin.position.y), (94, 46))
            self.assertEqual(list(grid.elevation), [10 + x + 10 * y for y in range(4) for x in range(6)], start)

    def test_gaps_are_filled_only_when_asked(self):
        holed = a_map()
        holed.data[0].data[9] = math.nan
        self.write("holed.bag", holed)
        self.expect_refused("holed.bag", "1 cells without data", "fill_nodata")
        self.assertTrue(self.load("holed.bag", fill_nodata=True).success)
        self.assertFalse(any(math.isnan(z) for z in self.keyframe(6).elevation))

    def test_refused_with_the_reason(self):
        self.write("words.bag", String("hello"))
        self.expect_refused("words.bag", "no grid_map_msgs/GridMap", "std_msgs/String")
        whole = self.write("whole.bag", a_map())
        for share in (0, 0.3, 0.6, 0.95):
            torn = shutil.copy(whole, os.path.join(self.folder, "torn.bag"))
            os.truncate(torn, int(share * os.path.getsize(whole)))
            self.expect_refused("torn.bag")
        with open(os.path.join(self.folder, "none.bag"), "w") as file:
            file.write("grid: {width: 9}\n")
        self.expect_refused("none.bag", "is not a bag")
        turned = a_map()
        turned.info.pose.orientation.z = turned.info.pose.orientation.w = math.sqrt(0.5)
        self.write("turned.bag", turned)
        self.expect_refused("turned.bag", "rotated")
        rows = a_map()
        rows.data[0].layout.dim.reverse()
        self.write("rows.bag", rows)
        self.expect_refused("rows.bag", "column-major")
        other = a_map()
        other.layers = ["height"]
        self.write("other.bag", other)
        self.expect_refused("other.bag", "neither a layer bedrock nor a layer elevation", "height")
        self.expect_refused("missing.bag", "no such file")

    def test_no_bag_outside_the_data_folder(self):
        outside = self.write("inside.bag", a_map())
        outside = shutil.move(outside, self.folder + "_outside.bag")
        self.addCleanup(os.remove, outside)
        os.symlink(outside, os.path.join(self.folder, "link.bag"))
        self.expect_refused("link.bag", "a symbolic link points outside")
        self.expect_refused(outside, "~data_dir")
        with open(os.path.join(self.folder, "out.yaml"), "w") as file:
            file.write("grid: {from_raster: %s}\n" % outside)
        answer = call("load_scenario", LoadScenario, name="out.yaml")
        self.assertFalse(answer.success)
        self.assertIn("is not below", answer.message)


if __name__ == "__main__":
    rospy.init_node("terrain_bags", disable_signals=True)
    rostest.rosrun("desert_sim", "terrain_bags", TerrainBags)
