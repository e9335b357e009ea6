#!/usr/bin/env python3
"""~grid_map, ~local_map, ~get_submap and ~get_grid_map, cell by cell."""
import itertools
import math
import threading

import desert_sim
from desert_sim.srv import GetSubmap, GetSubmapRequest
from desert_sim.testing import PATIENCE, wait_until
import genpy.dynamic
from geometry_msgs.msg import TransformStamped
from map_client import (GRID_MAP_MD5, GetGridMap, Listener, MapTest, Trigger, call, cells, center, elevation,
                        nested, section)
import rospy
import rostest


class Maps(MapTest):
    @classmethod
    def setUpClass(cls):
        cls.desert = desert_sim.Simulation(timeout=60 * PATIENCE)

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

    def test_a_late_joiner_gets_the_grid_map_of_the_same_state(self):
        with Listener("/desert_sim/grid_map") as listener:
            then = listener.first()
        with Listener("/desert_sim/grid_map") as late:
            now = late.first("a late joiner gets it")
        self.assertEqual(now.info.header.stamp, then.info.header.stamp, "the same state")
        self.assertEqual(cells(now, "elevation"), cells(then, "elevation"))

    def set_grid_map_rate(self, rate):
        self.desert.set_parameters({"grid_map_rate": rate})
        self.addCleanup(self.desert.set_parameters, {"grid_map_rate": 0.0})

    def stamps_to_now(self, listener):
        """Those of all messages, once that of the present state is there."""
        stamp = self.desert.status().header.stamp
        listener.wait_for(lambda m: m.info.header.stamp == stamp, "the grid map of the present state")
        return [m.info.header.stamp for m in listener.messages]

    def test_grid_map_comes_once_for_each_state(self):
        self.set_grid_map_rate(1000.0)
        with Listener("/desert_sim/grid_map") as listener:
            listener.first()
            for _ in range(10):
                self.desert.status()  # comes from the thread that publishes, which sees each time what is due
            self.desert.step(1)
            stamps = self.stamps_to_now(listener)
            # The first state may come twice: once because it is another terrain, and once to the new subscriber.
            self.assertLessEqual(len(stamps), 3, "an unchanged state is not repeated")
            call("resume", Trigger)
            listener.wait_for(lambda _: len(listener.messages) > 10, "the grid map by its rate")
            call("pause", Trigger)
            stamps = self.stamps_to_now(listener)
        self.assertEqual(stamps, sorted(stamps))
        self.assertLessEqual(len(stamps) - len(set(stamps)), 1, "each state once")

    def test_a_rate_holds_the_grid_map_back(self):
        self.set_grid_map_rate(0.001)
        with Listener("/desert_sim/grid_map") as listener:
            listener.first()
            begin = self.desert.status()
            call("resume", Trigger)
            wait_until(lambda: self.desert.status().step > begin.step + 20, "steps")
            call("pause", Trigger)  # which publishes what was held back
            later = [stamp for stamp in self.stamps_to_now(listener) if stamp > begin.header.stamp]
        self.assertLessEqual(len(later), 2, "at most the first one was due by the rate")

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
        def complains(text):
            """Whether the node says why it could not publish the local map."""
            return lambda m: any(status.name == "desert_sim: topics" and text in status.message for status in m.status)

        with Listener("/desert_sim/local_map") as listener, Listener("/diagnostics") as diagnostics:
            diagnostics.wait_for(complains("local_map: frame 'robot' cannot be transformed"), "where the robot is")
            self.publish_robot(126.4, -9.2)
            listener.first("the robot is there")
            local = listener.messages[0]
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
            corner = (local.info.pose.position.x, local.info.pose.position.y)

            count = len(listener.messages)
            listener.wait_for(lambda _: len(listener.messages) > count + 3, "it goes on though nothing moves")

            self.publish_robot(float("1e300"), 0)
            diagnostics.wait_for(complains("local_map: center.x: 1e+300"), "nothing is published off the world")
            self.publish_robot(100, 0)
            listener.wait_for(lambda m: m.info.pose.position.x == 100, "and it goes on")
            places = [(m.info.pose.position.x, m.info.pose.position.y) for m in listener.messages]
            self.assertEqual([place for place, _ in itertools.groupby(places)], [(126, -10), corner, (100, 0)])

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
                         list(desert_sim.LAYERS), "all")

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
            wait_until(lambda: self.desert.status().step > 0, "it runs")
        for worker in workers:
            worker.join(60 * PATIENCE)
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
