#!/usr/bin/env python3
"""~grid_map, ~local_map, ~get_submap and ~get_grid_map, cell by cell."""
import math
import threading
import time

from desert_sim.srv import GetSubmap, GetSubmapRequest
from desert_sim.testing import wait_until
import genpy.dynamic
from geometry_msgs.msg import TransformStamped
from map_client import (GRID_MAP_MD5, GetGridMap, Listener, MapTest, Trigger, call, cells, center, elevation,
                        nested, section)
import rospy
import rostest


class Maps(MapTest):
    # ---- grid_map

    def test_grid_map_is_the_real_type_and_lies_right(self):
        with Listener("/desert_sim/grid_map") as listener:
            grid_map = listener.first()
        self.assertEqual(listener.header["type"], "grid_map_msgs/GridMap")
        self.assertEqual(listener.header["md5sum"], GRID_MAP_MD5)
        self.assertEqual(listener.decoded._md5sum, GRID_MAP_MD5, "the definition is the checksum's")
        self.expect_header(grid_map.info.header)
        self.assertEqual(grid_map.basic_layers, ["elevation"])
        self.assertEqual((grid_map.info.resolution, grid_map.info.length_x, grid_map.info.length_y), (2, 128, 96))
        self.assertEqual(len(grid_map.layers), 39)
        layers = {name: cells(grid_map, name) for name in grid_map.layers}
        for x in range(64):
            for y in range(48):
                at = center(x, y)
                self.assertAlmostEqual(layers["elevation"][at], elevation(x, y), 4, (x, y))
                self.assertAlmostEqual(layers["sand_depth"][at], elevation(x, y) - 1, 4)
                self.assertAlmostEqual(layers["bedrock"][at], 1, 4)
                self.assertEqual(layers["water_surface"][at], layers["elevation"][at], "dry")
                for absent in ("water_depth", "soil_depth", "vegetation", "moisture", "obstacle", "plants", "canopy_height", "echo",
                               "erosion_resistance", "looseness", "grass", "mesquite", "shrub", "burial", "snow_density", "illumination", "humus", "suspended_sediment", "water_velocity_x", "water_velocity_y"):
                    self.assertEqual(layers[absent][at], 0, absent)
                self.assertGreater(layers["wind_x"][at], 1)
        self.check_derived(layers)

    def expect_rate(self, listener, rate):
        """The next messages come at this rate [Hz], to within what scheduling on a busy machine costs."""
        before = len(listener.messages)
        listener.wait_for(lambda _: len(listener.messages) > before + 10, "messages at %g Hz" % rate)
        times = listener.times[before:]
        measured = (len(times) - 1) / (times[-1] - times[0])
        self.assertTrue(0.7 * rate < measured < 1.2 * rate, "%g Hz: %.2f Hz" % (rate, measured))

    def check_derived(self, layers):
        west, south, far = center(55, 5), center(57, 3), center(20, 30)
        slope = math.atan(6.0 / 4)  # over two cells
        for foot in (west, south):
            self.assertAlmostEqual(layers["slope"][foot], slope, 4)
            self.assertAlmostEqual(layers["normal_z"][foot], math.cos(slope), 4)
            self.assertAlmostEqual(layers["step_height"][foot], 6, 4)
            self.assertGreater(layers["roughness"][foot], 1)
            self.assertEqual(layers["traversability"][foot], 0)
        self.assertAlmostEqual(layers["normal_x"][west], -math.sin(slope), 4)
        self.assertEqual(layers["normal_y"][west], 0)
        self.assertAlmostEqual(layers["normal_y"][south], -math.sin(slope), 4)
        self.assertEqual(layers["normal_x"][south], 0)
        self.assertEqual([layers[n][far] for n in ("slope", "roughness", "step_height")], [0, 0, 0])
        self.assertAlmostEqual(layers["traversability"][far], 0.8, 5, "deep sand")
        self.assertGreater(layers["slip"][far], 0)
        self.assertEqual(layers["slip_downhill"][far], layers["slip"][far], "flat ground")
        self.assertEqual(layers["slip_across"][far], 0)
        self.assertTrue(0.01 < layers["sinkage"][far] < 0.1, "the rover stands in sand")
        self.assertGreater(layers["slip"][west], layers["slip"][far])
        self.assertGreater(layers["slip_across"][west], 0)
        self.assertGreater(layers["wind_shadow"][center(60, 5)], 0.5, "in the lee")
        self.assertEqual(layers["wind_shadow"][center(54, 5)], 0)

    def test_grid_map_of_a_region_with_fewer_cells(self):
        with Listener("/desert_region/grid_map") as listener:
            grid_map = listener.first()
        self.assertEqual(grid_map.layers, ["traversability", "elevation"])
        self.assertEqual((grid_map.info.resolution, grid_map.info.length_x, grid_map.info.length_y), (6, 18, 12))
        self.assertEqual((grid_map.info.pose.position.x, grid_map.info.pose.position.y), (127, -10))
        heights, worth = cells(grid_map, "elevation"), cells(grid_map, "traversability")
        # Columns 54..61 and rows 2..7 in blocks of 3; the last column of blocks has two.
        shares = {(121, -13): 1 / 9, (127, -13): 3 / 9, (133, -13): 0,
                  (121, -7): 2 / 9, (127, -7): 6 / 9, (133, -7): 0}
        self.assertEqual(set(heights), set(shares))
        for at, share in shares.items():
            self.assertAlmostEqual(heights[at], 1.5 + 6 * share, 4)
            self.assertEqual(worth[at], 0, "the worst cell of the block")

    def test_grid_map_comes_once_for_each_state_and_at_its_rate(self):
        with Listener("/desert_sim/grid_map") as listener:
            listener.first()
            time.sleep(0.5)  # more than two periods
            self.assertEqual(len(listener.messages), 1, "nothing has changed")
        with Listener("/desert_sim/grid_map") as late:
            now, then = late.first("a late joiner gets it"), listener.messages[0]
            self.assertEqual(now.info.header.stamp, then.info.header.stamp, "the same state")
            self.assertEqual(cells(now, "elevation"), cells(then, "elevation"))
        with Listener("/desert_sim/grid_map") as listener:
            listener.first()
            call("resume", Trigger)
            self.expect_rate(listener, 5)
            stamps = [m.info.header.stamp for m in listener.messages]
            self.assertEqual(stamps, sorted(stamps))

    # ---- local_map

    tf = None  # /tf of tf2_msgs/TFMessage, which Debian has for Python in a package that nothing else here needs

    def publish_robot(self, x, y):
        if Maps.tf is None:
            Maps.tf_kind = genpy.dynamic.generate_dynamic(
                "tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n" + section(TransformStamped) +
                nested(TransformStamped))["tf2_msgs/TFMessage"]
            Maps.tf = rospy.Publisher("/tf", Maps.tf_kind, queue_size=10)
            wait_until(lambda: Maps.tf.get_num_connections() >= 2, "a node does not listen to /tf")
        robot = TransformStamped()
        robot.header.stamp = rospy.Time.now()
        robot.header.frame_id, robot.child_frame_id = "terrain", "robot"
        robot.transform.translation.x, robot.transform.translation.y, robot.transform.rotation.w = x, y, 1
        Maps.tf.publish(Maps.tf_kind([robot]))

    def test_local_map_follows_the_robot(self):
        with Listener("/desert_sim/local_map") as listener:
            wait_until(listener.subscriber.get_num_connections, "nobody publishes a local map")
            time.sleep(0.5)  # five periods
            self.assertEqual(listener.messages, [], "nobody knows where the robot is")
            self.publish_robot(126.4, -9.2)
            local = listener.first("the robot is there")
            self.assertEqual(listener.header["md5sum"], GRID_MAP_MD5)
            self.expect_header(local.info.header)
            self.assertEqual(local.layers, ["traversability", "elevation"])
            self.assertEqual((local.info.length_x, local.info.length_y), (20, 12))
            self.assertEqual((local.info.pose.position.x, local.info.pose.position.y), (126, -10), "along the cells")
            found = cells(local, "elevation")
            self.assertEqual(len(found), 60)
            for (x, y), height in found.items():
                self.assertAlmostEqual(height, elevation((x - 10) // 2, (y + 20) // 2), 4)

            self.publish_robot(11.5, 75.1)  # the north-west corner
            local = listener.wait_for(lambda m: m.info.pose.position.x < 50, "it follows while paused")
            found = cells(local, "elevation")
            self.assertEqual((local.info.length_x, local.info.length_y), (20, 12))
            for (x, y), height in found.items():
                inside = x > 10 and y < 76
                self.assertEqual(math.isnan(height), not inside, (x, y))
            self.assertEqual(sum(math.isnan(h) for h in found.values()), 60 - 6 * 3)

            self.expect_rate(listener, 10)  # though nothing moves

            self.publish_robot(float("1e300"), 0)
            time.sleep(0.5)
            count = len(listener.messages)
            time.sleep(0.5)
            self.assertEqual(len(listener.messages), count, "nothing is published off the world")
            self.publish_robot(100, 0)
            listener.wait_for(lambda m: m.info.pose.position.x == 100, "and it goes on")

    def test_local_map_goes_on_over_a_periodic_edge(self):
        self.publish_robot(12, -18)
        with Listener("/desert_region/local_map") as listener:
            local = listener.wait_for(lambda m: m.info.pose.position.x == 12, "the robot is there")
            found = cells(local, "elevation")
            self.assertEqual(len(found), 400)
            for (x, y), height in found.items():
                self.assertAlmostEqual(height, elevation((x - 10) // 2 % 64, (y + 20) // 2 % 48), 4, (x, y))
            self.assertEqual(sum(h > 7 for h in found.values()), 12, "the marker, west of the west edge")

    # ---- submaps

    def submap(self, x, y, length_x, length_y, layers=("elevation",), frame=""):
        request = GetSubmapRequest()
        request.header.frame_id = frame
        request.center.x, request.center.y = x, y
        request.length_x, request.length_y, request.layers = length_x, length_y, list(layers)
        return call("get_submap", GetSubmap, request)

    def test_get_submap_gives_exactly_the_region(self):
        for x0, y0, width, height in ((54, 2, 8, 7), (0, 0, 64, 48), (63, 47, 1, 1), (55, 3, 3, 2)):
            answer = self.submap(10 + 2 * x0 + width, -20 + 2 * y0 + height, 2 * width, 2 * height)
            self.assertTrue(answer.success, answer.message)
            submap = answer.map
            self.expect_header(submap.header)
            self.assertEqual((submap.width, submap.height, submap.cell_size), (width, height, 2))
            self.assertEqual((submap.origin.position.x, submap.origin.position.y), (10 + 2 * x0, -20 + 2 * y0))
            self.assertEqual([(layer.name, layer.unit) for layer in submap.layers], [("elevation", "m")])
            self.assertEqual(len(submap.layers[0].data), width * height)
            for x in range(width):
                for y in range(height):
                    self.assertAlmostEqual(submap.layers[0].data[y * width + x], elevation(x0 + x, y0 + y), 4)

    def test_get_submap_rounds_to_cells(self):
        submap = self.submap(100.3, 20.2, 9.1, 4.9).map  # 4.55 and 2.45 cells
        self.assertEqual((submap.width, submap.height), (5, 2))
        self.assertAlmostEqual(submap.origin.position.x + submap.width, 100.3, delta=1)
        self.assertAlmostEqual(submap.origin.position.y + submap.height, 20.2, delta=1)
        self.assertEqual(self.submap(100, 20, 1e-3, 1e-3).map.width, 1)
        self.assertEqual([layer.name for layer in self.submap(100, 20, 4, 4, []).map.layers],
                         ["elevation", "bedrock", "water_surface", "sand_depth", "water_depth", "soil_depth", "vegetation",
                          "plants", "canopy_height", "illumination", "humus", "moisture", "suspended_sediment",
                          "airborne_sand", "water_velocity_x", "water_velocity_y", "erosion_resistance", "obstacle", "looseness",
                          "grass", "mesquite", "shrub", "burial", "snow_density",
                          "wind_x", "wind_y", "wind_shadow", "echo", "flux_x", "flux_y", "slope", "roughness", "step_height", "slip",
                          "slip_downhill", "slip_across", "sinkage", "traversability", "normal_x", "normal_y", "normal_z"], "all")

    def test_get_submap_refuses(self):
        nan, inf = float("nan"), float("inf")
        for arguments, named in (((nan, 0, 2, 2), "center.x"), ((50, inf, 2, 2), "center.y"),
                                 ((50, 0, 0, 2), "length_x"), ((50, 0, 2, -1), "length_y"), ((50, 0, nan, 2), "length_x"),
                                 ((50, 0, 1e300, 2), "length_x"), ((50, 0, 1000, 2), "is not inside the terrain"),
                                 ((10, 0, 4, 4), "from (10, -20) to (138, 76)"), ((1e300, 0, 2, 2), "center.x"),
                                 ((50, 0, 2, 2, ["lava"]), "'lava' is not one of: elevation, "),
                                 ((50, 0, 2, 2, [""]), "layers: ''"),
                                 ((50, 0, 2, 2, ["slope", "slope"]), "'slope' is given twice"),
                                 ((50, 0, 2, 2, ["x"] * 1000), "1000 names"),
                                 ((50, 0, 2, 2, ["slope"], "nowhere"), "nowhere")):
            answer = self.submap(*arguments)
            self.assertFalse(answer.success, arguments)
            self.assertIn(named, answer.message)
            self.assertEqual((answer.map.width, len(answer.map.layers)), (0, 0))

    def test_get_submap_for_many_at_once_while_it_runs_and_is_reset(self):
        call("resume", Trigger)
        wrong = []

        def ask(worker):
            for n in range(15):
                bad = (worker + n) % 3 == 0
                answer = self.submap(74, 28, 1e6 if bad else 20, 10, ["elevation", "slope"])
                if answer.success == bad or (not bad and [len(layer.data) for layer in answer.map.layers] != [50, 50]):
                    wrong.append(answer.message)

        workers = [threading.Thread(target=ask, args=(n,)) for n in range(8)]
        for worker in workers:
            worker.start()
        for _ in range(5):
            self.assertTrue(call("reset", Trigger).success)
            time.sleep(0.05)
        for worker in workers:
            worker.join(20)
            self.assertFalse(worker.is_alive())
        self.assertEqual(wrong, [])

    def test_get_grid_map_of_the_real_type(self):
        answer = call("get_grid_map", GetGridMap, frame_id="terrain", position_x=118, position_y=-10, length_x=16,
                      length_y=12, layers=["slope", "elevation"])
        self.assertEqual(answer.map.layers, ["slope", "elevation"])
        self.expect_header(answer.map.info.header)
        found = cells(answer.map, "elevation")
        self.assertEqual(len(found), 8 * 6)
        for (x, y), height in found.items():
            self.assertAlmostEqual(height, elevation((x - 10) // 2, (y + 20) // 2), 4)
        with self.assertRaises(rospy.ServiceException) as refused:
            call("get_grid_map", GetGridMap, frame_id="", position_x=50, position_y=0, length_x=4, length_y=4,
                 layers=["lava"])
        self.assertIn("'lava' is not one of", str(refused.exception))


if __name__ == "__main__":
    rospy.init_node("maps_test", disable_signals=True)
    rostest.rosrun("desert_sim", "maps", Maps)
