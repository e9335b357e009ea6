"""What the tests of maps share: a listener that decodes any type by the definition that its publisher sends, and maps read
as somebody would who only knows the published layouts. The terrain is corner.yaml: 64 x 48 cells of 2 m with their
corner at (10, -20), and on cells (56..59, 4..6) a marker of sand 6 m high."""
import threading
import time
import unittest

import genpy.dynamic
import rospy
from desert_sim.testing import PATIENCE, wait_until
from geometry_msgs.msg import Pose
from std_msgs.msg import Float32MultiArray, Header
from std_srvs.srv import Trigger

GRID_MAP_MD5 = "95681e052b1f73bf87b7eb984382b401"
GET_GRID_MAP_MD5 = "802c2cbc7b10fada2d44db75ddb8c738"
SEPARATOR = "=" * 80 + "\n"


def section(kind):
    return SEPARATOR + "MSG: %s\n%s\n" % (kind._type, kind._full_text.split(SEPARATOR)[0])


# As grid_map_msgs has them.
INFO = "Header header\nfloat64 resolution\nfloat64 length_x\nfloat64 length_y\ngeometry_msgs/Pose pose\n"
GRID_MAP = ("GridMapInfo info\nstring[] layers\nstring[] basic_layers\nstd_msgs/Float32MultiArray[] data\n"
            "uint16 outer_start_index\nuint16 inner_start_index\n")


def nested(kind):
    """The types that a type is made of."""
    return "".join(SEPARATOR + part.rstrip("\n") + "\n" for part in kind._full_text.split(SEPARATOR)[1:])


def parts():
    return (SEPARATOR + "MSG: grid_map_msgs/GridMapInfo\n" + INFO + section(Header) + section(Pose) + nested(Pose) +
            section(Float32MultiArray) + nested(Float32MultiArray))


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


class Listener:
    """All messages of a topic since it was made. Of kind AnyMsg: decoded by the definition that the publisher sends."""

    def __init__(self, topic, kind=rospy.AnyMsg):
        self.messages, self.times, self.header, self.decoded = [], [], None, None
        self.changed = threading.Condition()
        self.subscriber = rospy.Subscriber(topic, kind, self.take, queue_size=1000)

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

    def wait_for(self, fits, what, seconds=60):
        """The last message, once it fits."""
        with self.changed:
            ok = self.changed.wait_for(lambda: self.messages and fits(self.messages[-1]), seconds * PATIENCE)
            assert ok, "%s (%d messages)" % (what, len(self.messages))
            return self.messages[-1]

    def first(self, what="a message"):
        return self.wait_for(lambda m: True, what)

    last = first  # wait_for() returns the last message, and here any fits

    def close(self):
        self.subscriber.unregister()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


def wait_until_known(keyframes, updates, change, publications):
    """Waits until the node knows the subscribers of both topics of a stream, whole maps and updates, and has sent what it
    sends to new ones. `change()` changes what the stream shows, and has it published by ~step; `publications()` is the
    number of all messages so far. Rates are 0. To subscribers that the node knows a change comes as one update; before that
    it comes as a whole map, or as both."""
    def told_by_an_update_alone():
        whole, parts, before = len(keyframes.messages), len(updates.messages), publications()
        change()
        once = publications() == before + 1
        wait_until(lambda: len(keyframes.messages) > whole or len(updates.messages) > parts, "a change that is shown")
        return once and len(updates.messages) > parts

    wait_until(told_by_an_update_alone, "changes as updates alone")


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
    rospy.wait_for_service("/desert_sim/" + service, 60 * PATIENCE)
    proxy = rospy.ServiceProxy("/desert_sim/" + service, kind)
    return proxy(request) if request else proxy(**fields)


class MapTest(unittest.TestCase):
    """Each test begins paused at the scenario's start."""

    def setUp(self):
        self.assertTrue(call("pause", Trigger).success)
        self.assertTrue(call("reset", Trigger).success)

    def expect_header(self, header):
        self.assertEqual(header.frame_id, "terrain")
        self.assertTrue(0 <= (rospy.Time.now() - header.stamp).to_sec() < 60, "when the state was reached")
