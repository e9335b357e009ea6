#!/usr/bin/env python3
"""Maps of a paused node on corner.yaml, read as somebody would who only knows the published layouts: the marker, a block
of 6 m on cells (56..59, 4..6) of 64 x 48 cells of 2 m with their corner at (10, -20), has to be where it is."""
import math
import threading
import time
import unittest

import genpy.dynamic
import rospy
import rostest
from desert_sim.msg import SimulationStatus
from desert_sim.srv import EditTerrain, EditTerrainRequest, GetSubmap, GetSubmapRequest, Step
from geometry_msgs.msg import TransformStamped
from map_msgs.msg import OccupancyGridUpdate
from nav_msgs.msg import OccupancyGrid
from sensor_msgs.msg import Image
from std_msgs.msg import Float32MultiArray, Header
from geometry_msgs.msg import Pose
from desert_sim.srv import SetWindResponse
from std_msgs.msg import Empty

GRID_MAP_MD5 = "95681e052b1f73bf87b7eb984382b401"
GET_GRID_MAP_MD5 = "802c2cbc7b10fada2d44db75ddb8c738"
SEPARATOR = "=" * 80 + "\n"


def section(kind):
    return SEPARATOR + "MSG: %s\n%s\n" % (kind._type, kind._full_text.split(SEPARATOR)[0])


# As grid_map_msgs has them.
INFO = "Header header\nfloat64 resolution\nfloat64 length_x\nfloat64 length_y\ngeometry_msgs/Pose pose\n"
GRID_MAP = ("GridMapInfo info\nstring[] layers\nstring[] basic_layers\nstd_msgs/Float32MultiArray[] data\n"
            "uint16 outer_start_index\nuint16 inner_start_index\n")


def parts():
    nested = section(Header) + SEPARATOR.join([""] + [s for s in Pose._full_text.split(SEPARATOR)[1:]])
    arrays = SEPARATOR.join([""] + Float32MultiArray._full_text.split(SEPARATOR)[1:])
    return (SEPARATOR + "MSG: grid_map_msgs/GridMapInfo\n" + INFO + nested + "\n" + section(Pose) +
            section(Float32MultiArray) + arrays)


class GetGridMap:
    """grid_map_msgs/GetGridMap, made from its definition."""
    _type = "grid_map_msgs/GetGridMap"
    _md5sum = GET_GRID_MAP_MD5
    _request_class = genpy.dynamic.generate_dynamic(
        "grid_map_msgs/GetGridMapRequest",
        "string frame_id\nfloat64 position_x\nfloat64 position_y\nfloat64 length_x\nfloat64 length_y\n"
        "string[] layers\n")["grid_map_msgs/GetGridMapRequest"]
    _response_class = genpy.dynamic.generate_dynamic(
        "grid_map_msgs/GetGridMapResponse",
        "grid_map_msgs/GridMap map\n" + SEPARATOR + "MSG: grid_map_msgs/GridMap\n" + GRID_MAP +
        parts())["grid_map_msgs/GetGridMapResponse"]


class Trigger:
    """std_srvs/Trigger, which Debian has for Python in a package of its own that nothing else here needs."""
    _type = "std_srvs/Trigger"
    _md5sum = "937c9679a518e3a18d831e57125ea522"
    _request_class = Empty
    _response_class = SetWindResponse  # the same fields


class Listener:
    """All messages of a topic since it was made. Of kind AnyMsg: decoded by the definition that the publisher sends."""

    def __init__(self, topic, kind=rospy.AnyMsg):
        self.messages, self.times, self.header, self.decoded = [], [], None, None
        self.changed = threading.Condition()
        self.subscriber = rospy.Subscriber(topic, kind, self.take, queue_size=100)

    def take(self, message):
        with self.changed:
            if isinstance(message, rospy.AnyMsg):
                self.header = message._connection_header
                if self.decoded is None:
                    self.decoded = genpy.dynamic.generate_dynamic(
                        self.header["type"], self.header["message_definition"])[self.header["type"]]
                message = self.decoded().deserialize(message._buff)
            self.messages.append(message)
            self.times.append(time.monotonic())
            self.changed.notify_all()

    def wait_for(self, fits, what, seconds=10):
        """The last message, once it fits."""
        with self.changed:
            ok = self.changed.wait_for(lambda: self.messages and fits(self.messages[-1]), seconds)
            assert ok, "%s (%d messages)" % (what, len(self.messages))
            return self.messages[-1]

    def first(self, what="a message"):
        return self.wait_for(lambda m: True, what)

    def close(self):
        self.subscriber.unregister()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


def cells(grid_map, layer):
    """{(x, y) of a cell's centre: value}, by grid_map's documentation."""
    array = grid_map.data[grid_map.layers.index(layer)]
    columns, rows = array.layout.dim
    assert (columns.label, rows.label) == ("column_index", "row_index")
    assert columns.stride == rows.size * columns.size == len(array.data) and rows.stride == rows.size
    info = grid_map.info
    assert (grid_map.outer_start_index, grid_map.inner_start_index) == (0, 0)
    assert abs(rows.size * info.resolution - info.length_x) < 1e-9
    assert abs(columns.size * info.resolution - info.length_y) < 1e-9
    pose = info.pose
    assert (pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w) == (0, 0, 0, 1)
    assert pose.position.z == 0
    found = {}
    for column in range(columns.size):
        for row in range(rows.size):
            x = pose.position.x + info.length_x / 2 - (row + 0.5) * info.resolution
            y = pose.position.y + info.length_y / 2 - (column + 0.5) * info.resolution
            found[round(x, 6), round(y, 6)] = array.data[column * rows.size + row]
    return found


def center(x, y):
    return 10 + (x + 0.5) * 2, -20 + (y + 0.5) * 2


def elevation(x, y):
    return 7.5 if 56 <= x < 60 and 4 <= y < 7 else 1.5


def call(service, kind, request=None, **fields):
    rospy.wait_for_service("/desert_sim/" + service, 20)
    proxy = rospy.ServiceProxy("/desert_sim/" + service, kind)
    return proxy(request) if request else proxy(**fields)


class Maps(unittest.TestCase):
    def setUp(self):
        self.assertTrue(call("pause", Trigger).success)
        self.assertTrue(call("reset", Trigger).success)

    def expect_header(self, header):
        self.assertEqual(header.frame_id, "terrain")
        self.assertTrue(0 <= (rospy.Time.now() - header.stamp).to_sec() < 60, "when the state was reached")

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
        self.assertEqual(len(grid_map.layers), 18)
        layers = {name: cells(grid_map, name) for name in grid_map.layers}
        for x in range(64):
            for y in range(48):
                at = center(x, y)
                self.assertAlmostEqual(layers["elevation"][at], elevation(x, y), 4, (x, y))
                self.assertAlmostEqual(layers["sand_depth"][at], elevation(x, y) - 1, 4)
                self.assertAlmostEqual(layers["bedrock"][at], 1, 4)
                for absent in ("water_depth", "soil_depth", "vegetation", "moisture", "obstacle"):
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
            time.sleep(0.7)
            self.assertEqual(len(listener.messages), 1, "nothing has changed")
        with Listener("/desert_sim/grid_map") as late:
            now, then = late.first("a late joiner gets it"), listener.messages[0]
            self.assertEqual(now.info.header.stamp, then.info.header.stamp, "the same state")
            self.assertEqual(cells(now, "elevation"), cells(then, "elevation"))
        with Listener("/desert_sim/grid_map") as listener:
            listener.first()
            call("resume", Trigger)
            first = len(listener.messages)
            time.sleep(3)
            self.assertTrue(11 <= len(listener.messages) - first <= 17, "5 Hz: %d in 3 s" %
                            (len(listener.messages) - first))
            stamps = [m.info.header.stamp for m in listener.messages]
            self.assertEqual(stamps, sorted(stamps))

    # ---- local_map

    def publish_robot(self, x, y):
        if not hasattr(Maps, "tf"):
            kind = genpy.dynamic.generate_dynamic(
                "tf2_msgs/TFMessage",
                "geometry_msgs/TransformStamped[] transforms\n" + section(TransformStamped) +
                SEPARATOR.join([""] + TransformStamped._full_text.split(SEPARATOR)[1:]))["tf2_msgs/TFMessage"]
            Maps.tf_kind = kind
            Maps.tf = rospy.Publisher("/tf", kind, queue_size=10)
            deadline = time.monotonic() + 10
            while Maps.tf.get_num_connections() < 2 and time.monotonic() < deadline:
                time.sleep(0.02)
        message = Maps.tf_kind()
        transform = [t for t in type(message)._slot_types]
        self.assertEqual(transform, ["geometry_msgs/TransformStamped[]"])
        t = TransformStamped()
        t.header.stamp = rospy.Time.now()
        t.header.frame_id, t.child_frame_id = "terrain", "robot"
        t.transform.translation.x, t.transform.translation.y, t.transform.rotation.w = x, y, 1
        message.transforms = [t]
        Maps.tf.publish(message)

    def test_local_map_follows_the_robot(self):
        with Listener("/desert_sim/local_map") as listener:
            time.sleep(1)
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
                         ["elevation", "bedrock", "sand_depth", "water_depth", "soil_depth", "vegetation", "moisture",
                          "obstacle", "wind_x", "wind_y", "wind_shadow", "slope", "roughness", "step_height",
                          "traversability", "normal_x", "normal_y", "normal_z"], "all")

    def test_get_submap_refuses(self):
        nan, inf = float("nan"), float("inf")
        for arguments, named in (((nan, 0, 2, 2), "center.x"), ((50, inf, 2, 2), "center.y"),
                                 ((50, 0, 0, 2), "length_x"), ((50, 0, 2, -1), "length_y"), ((50, 0, nan, 2), "length_x"),
                                 ((50, 0, 1e300, 2), "length_x"), ((50, 0, 1000, 2), "is not inside the terrain"),
                                 ((10, 0, 4, 4), "from (10, -20) to (138, 76)"), ((1e300, 0, 2, 2), "center.x"),
                                 ((50, 0, 2, 2, ["lava"]), "'lava' is not one of: elevation, "),
                                 ((50, 0, 2, 2, [""]), "layers: ''"),
                                 ((50, 0, 2, 2, ["slope", "slope"]), "'slope' stands there twice"),
                                 ((50, 0, 2, 2, ["x"] * 1000), "1000 names"),
                                 ((50, 0, 2, 2, ["slope"], "nowhere"), "nowhere")):
            answer = self.submap(*arguments)
            self.assertFalse(answer.success, arguments)
            self.assertIn(named, answer.message)
            self.assertEqual((answer.map.width, len(answer.map.layers)), (0, 0))

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

    # ---- costmap

    def edit(self, x, y, value=3.0):
        request = EditTerrainRequest(layer="sand", shape="circle", merge="add", radius=5, inner=1, value=value)
        request.center.x, request.center.y = x, y
        answer = call("edit_terrain", EditTerrain, request)
        self.assertTrue(answer.success, answer.message)

    def keyframe(self):
        with Listener("/desert_sim/costmap", OccupancyGrid) as listener:
            return listener.first("a late joiner gets the whole map")

    @staticmethod
    def assemble(grid, updates):
        data = list(grid.data)
        for u in updates:
            assert u.x >= 0 and u.y >= 0 and u.width > 0 and u.height > 0
            assert u.x + u.width <= grid.info.width and u.y + u.height <= grid.info.height, "out of bounds"
            assert len(u.data) == u.width * u.height
            for y in range(u.height):
                at = (u.y + y) * grid.info.width + u.x
                data[at:at + u.width] = u.data[y * u.width:(y + 1) * u.width]
        return data

    def test_costmap_lies_right(self):
        grid = self.keyframe()
        self.expect_header(grid.header)
        self.assertEqual((grid.info.width, grid.info.height, grid.info.resolution), (64, 48, 2))
        self.assertEqual((grid.info.origin.position.x, grid.info.origin.position.y), (10, -20))
        self.assertEqual(grid.info.origin.orientation.w, 1)
        for x in range(64):
            for y in range(48):
                near = 55 <= x < 61 and 3 <= y < 8
                top = x in (57, 58) and y == 5  # flat, and all round it
                self.assertEqual(grid.data[y * 64 + x], 20 if top or not near else 100, (x, y))

    def test_costmap_updates_lead_from_one_keyframe_to_the_next(self):
        with Listener("/desert_sim/costmap", OccupancyGrid) as keyframes, \
                Listener("/desert_sim/costmap_updates", OccupancyGridUpdate) as updates:
            keyframes.first()
            time.sleep(0.7)
            base, skipped = keyframes.messages[-1], len(updates.messages)
            self.edit(40, 10)
            self.edit(120, 60)
            updates.wait_for(lambda u: u.x <= 14 and u.x + u.width >= 56, "one rectangle with both edits")
            self.expect_header(updates.messages[-1].header)
            call("resume", Trigger)
            time.sleep(3)
            call("pause", Trigger)
            time.sleep(0.5)
            got = updates.messages[skipped:]
            self.assertTrue(8 <= len(got) <= 22, "5 Hz: %d" % len(got))
            self.assertEqual(len(keyframes.messages), keyframes.messages.index(base) + 1, "no keyframe in between")
        self.assertEqual(self.assemble(base, got), list(self.keyframe().data))
        with Listener("/desert_sim/costmap", OccupancyGrid) as keyframes:
            keyframes.first()
            call("reset", Trigger)
            keyframes.wait_for(lambda k: k.header.stamp > got[-1].header.stamp and min(k.data) == 20,
                               "a replaced terrain begins with a keyframe")

    def test_an_update_repeats_what_a_client_may_not_have_looked_at(self):
        with Listener("/desert_sim/costmap", OccupancyGrid) as keyframes, \
                Listener("/desert_sim/costmap_updates", OccupancyGridUpdate) as updates:
            keyframes.first()
            time.sleep(1)
            self.edit(30, 0)
            rospy.ServiceProxy("/desert_sim/step", Step)(0)
            self.edit(110, 50)
            rospy.ServiceProxy("/desert_sim/step", Step)(0)
            last = updates.wait_for(lambda u: u.x + u.width > 50 and u.y + u.height > 34, "of the second edit")
            self.assertLessEqual(last.x, 12)
            self.assertLessEqual(last.y, 12)

    # ---- image

    def test_image_has_the_marker_in_the_south_east(self):
        with Listener("/desert_sim/image", Image) as listener:
            image = listener.first()
        self.expect_header(image.header)
        self.assertEqual(image.encoding, "bgr8")
        self.assertEqual(image.step, 3 * image.width)
        self.assertEqual(len(image.data), image.step * image.height)
        self.assertAlmostEqual(image.width / image.height, 64 / 48, 6)
        scale = image.width // 64
        pixels = bytes(image.data)

        def contrast(x0, x1, y0, y1):
            """Of green over columns x0..x1 and rows y0..y1 of cells, row 0 in the south."""
            greens = [pixels[row * image.step + 3 * column + 1] for row in range((48 - y1) * scale, (48 - y0) * scale)
                      for column in range(x0 * scale, x1 * scale)]
            return max(greens) - min(greens)

        self.assertGreater(contrast(54, 62, 2, 9), 40)
        self.assertLess(contrast(40, 62, 30, 46), 10, "north-east")
        self.assertLess(contrast(2, 30, 30, 46), 10, "north-west")

    # ---- costs

    def test_nobody_listens_nothing_is_copied(self):
        call("resume", Trigger)
        with Listener("/desert_sim/status", SimulationStatus) as statuses:
            deadline = time.monotonic() + 15
            copied = None
            while copied != 0 and time.monotonic() < deadline:  # the subscribers of other tests go
                first = statuses.first()
                before, step = first.snapshots, first.step
                time.sleep(1)
                copied = statuses.messages[-1].snapshots - before
            self.assertEqual(copied, 0)
            self.assertGreater(statuses.messages[-1].step, step, "it runs meanwhile")


if __name__ == "__main__":
    rospy.init_node("maps_test", disable_signals=True)
    rostest.rosrun("desert_sim", "maps", Maps)
