#!/usr/bin/env python3
"""A flood of service calls from several clients, a fifth of them malformed, while subscribers of all topics come and go:
none breaks the node, each malformed one is refused with a reason, its memory stays, and the journal replays to the same
hash. DESERT_FLOOD_SECONDS (default 8) says how long."""
import math
import os
import random
import resource
import socket
import statistics
import threading
import time
import xmlrpc.client

from actionlib import GoalStatus
from desert_sim.msg import ElevationGrid, ForecastTerrainGoal, WindScheduleSegment
from desert_sim.srv import EditPlants, EditPlantsRequest, EditTerrain, EditTerrainRequest, EditWind, EditWindRequest
from desert_sim.srv import GetSubmap, GetSubmapRequest, LoadCheckpoint, LoadCheckpointRequest, LoadTerrain, LoadTerrainRequest
from desert_sim.srv import QueryTerrain, QueryTerrainRequest, SaveCheckpoint, SaveCheckpointRequest
from desert_sim.srv import SetWeather, SetWeatherRequest, SetWind, SetWindRequest, SetWindSchedule, SetWindScheduleRequest, Step
from forecast_client import ForecastClient
from geometry_msgs.msg import Point
from node_tests import OASIS, Scenarios
import rosgraph
import rospy
import rostest
from std_srvs.srv import Trigger

SECONDS = float(os.environ.get("DESERT_FLOOD_SECONDS", "8"))
CLIENTS, SUBSCRIBERS = 4, 30
CHECKPOINT = "start.ckpt"
# glibc keeps what was freed of 10 MB requests in up to eight arenas per processor, for a long time at random. Then their
# memory tells nothing of leaks; with a fixed threshold it is returned at once.
RETURNS_LARGE_BUFFERS = {"MALLOC_MMAP_THRESHOLD_": str(1 << 20), "MALLOC_TRIM_THRESHOLD_": str(1 << 20)}
BAD_NUMBERS = [math.nan, math.inf, -math.inf, 1e300, -1e300]
BAD_NAMES = ["", "../../etc/passwd", "/etc/passwd", "a/../../b", "\n", "x" * 10_000_000]


def place(draw, grid):
    """Somewhere on the terrain."""
    extent_x, extent_y = grid.width * grid.cell_size, grid.height * grid.cell_size
    return Point(grid.origin.position.x + draw.uniform(0.1, 0.9) * extent_x,
                 grid.origin.position.y + draw.uniform(0.1, 0.9) * extent_y, 0)


def good(draw, grid):
    """(service, type, request) that the node takes."""
    kind = draw.randrange(9)
    if kind == 0:
        return "set_wind", SetWind, SetWindRequest(speed=draw.uniform(0, 9), direction_deg=draw.uniform(-180, 180))
    if kind == 1:
        return "edit_terrain", EditTerrain, EditTerrainRequest(
            layer=draw.choice(["sand", "soil", "water"]), shape="circle", merge=draw.choice(["add", "sub", "max", "avg"]),
            center=place(draw, grid), radius=draw.uniform(1, 6), value=draw.uniform(0, 0.5))
    if kind == 2:
        return "set_wind_schedule", SetWindSchedule, SetWindScheduleRequest(
            kind="timeline", repeat=True,
            segments=[WindScheduleSegment(speed=draw.uniform(1, 8), duration=draw.uniform(1, 50)) for _ in range(3)])
    if kind == 3:
        return "edit_wind", EditWind, EditWindRequest(operation="clear")
    if kind == 4:
        return "load_checkpoint", LoadCheckpoint, LoadCheckpointRequest(name=CHECKPOINT)
    if kind == 5:
        return "get_submap", GetSubmap, GetSubmapRequest(
            layers=["elevation", "slope", "wind_x"], center=place(draw, grid), length_x=3, length_y=3)
    if kind == 6:
        return "edit_plants", EditPlants, EditPlantsRequest(
            operation=draw.choice(["plant", "clear"]), species=draw.choice(["tree", "bush"]), shape="circle",
            center=place(draw, grid), radius=draw.uniform(1, 6), density=draw.uniform(0, 0.2), size=0.1,
            seed=draw.randrange(99))
    if kind == 7:
        return "set_weather", SetWeather, SetWeatherRequest(
            change=["rain_rate", "evaporation"], rain_rate=draw.uniform(0, 1e-3), evaporation=draw.uniform(0, 0.1),
            ramp=draw.uniform(0, 5))
    return "query_terrain", QueryTerrain, QueryTerrainRequest(
        points=[place(draw, grid) for _ in range(20)])


def bad(draw):
    """(service, type, request) that it must refuse."""
    kind = draw.randrange(8)
    number = draw.choice(BAD_NUMBERS)
    if kind == 0:
        return "set_wind", SetWind, SetWindRequest(speed=number)
    if kind == 1:
        return "edit_terrain", EditTerrain, EditTerrainRequest(
            layer="sand", shape="circle", merge="add", center=Point(20, 20, 0), radius=number, value=1)
    if kind == 2:
        request = EditTerrainRequest(layer=draw.choice(BAD_NAMES), shape="circle", merge="add", radius=2, value=1)
        request.header.frame_id = draw.choice(["", "nowhere"])
        return "edit_terrain", EditTerrain, request
    if kind == 3:
        return "set_wind_schedule", SetWindSchedule, SetWindScheduleRequest(kind=draw.choice(BAD_NAMES[:5] + ["rose"]))
    if kind == 4:
        return "edit_wind", EditWind, EditWindRequest(operation="change", id=draw.choice([-1, 0, 99]), kind="jet", radius=5)
    if kind == 5:
        return "query_terrain", QueryTerrain, QueryTerrainRequest(points=[Point(draw.choice(BAD_NUMBERS[:3]), 0, 0)])
    if kind == 6:
        return "load_checkpoint", LoadCheckpoint, LoadCheckpointRequest(name=draw.choice(BAD_NAMES))
    return draw.choice([("load_terrain", LoadTerrain, LoadTerrainRequest(name=draw.choice(BAD_NAMES[1:5]))),
                        ("save_checkpoint", SaveCheckpoint, SaveCheckpointRequest(name=draw.choice(BAD_NAMES[:4])))])


class Client(threading.Thread):
    """Calls over connections that stay; keeps what went wrong."""

    def __init__(self, node, grid, seed, until):
        super().__init__()
        self.node, self.grid, self.draw, self.until = node, grid, random.Random(seed), until
        self.proxies, self.faults, self.taken, self.refused = {}, [], 0, 0

    def run(self):
        while time.monotonic() < self.until and len(self.faults) < 5:
            wrong = self.draw.random() < 0.2
            service, kind, request = bad(self.draw) if wrong else good(self.draw, self.grid)
            if service not in self.proxies:
                self.proxies[service] = rospy.ServiceProxy("/%s/%s" % (self.node, service), kind, persistent=True)
            try:
                answer = self.proxies[service](request)
            except Exception as e:  # noqa: B902 any failure of the transport is a fault of the node
                self.faults.append("%s: %r" % (service, e))
                continue
            full = service == "edit_plants" and "vegetation.max_plants" in answer.message
            if not full and wrong == answer.success or (wrong and not answer.message):
                self.faults.append("%s: wrong %s, success %s, %s" % (service, wrong, answer.success, answer.message[:200]))
            if len(answer.message) > 2000:
                self.faults.append("%s: a reason of %d characters" % (service, len(answer.message)))
            self.taken += not wrong
            self.refused += wrong
        for proxy in self.proxies.values():
            proxy.close()


class Forecaster(threading.Thread):
    """Asks for forecasts, and cancels most of them; keeps what went wrong."""

    def __init__(self, node, seed, until):
        super().__init__()
        self.draw, self.until = random.Random(seed), until
        self.client = ForecastClient("/" + node)
        self.faults, self.ends = [], {}

    def run(self):
        self.client.wait_for_server()
        while time.monotonic() < self.until and len(self.faults) < 5:
            wrong = bool(self.ends) and self.draw.random() < 0.2  # the first answer comes when the connection is made
            self.client.send_goal(ForecastTerrainGoal(
                horizon=self.draw.choice(BAD_NUMBERS) if wrong else self.draw.uniform(1, 20), moments=self.draw.randrange(1, 9),
                members=self.draw.randrange(3), gust_speed=0.2, gust_time=5))
            if not self.client.wait_for_result(rospy.Duration(self.draw.uniform(0, 2))):
                self.client.cancel_goal()
            if not self.client.wait_for_result(rospy.Duration(60)):
                self.faults.append("a forecast has no end")
            state = self.client.get_state()
            self.ends[state] = self.ends.get(state, 0) + 1
            if wrong != (state == GoalStatus.REJECTED) and state not in (
                    GoalStatus.RECALLED, GoalStatus.ABORTED, GoalStatus.LOST):  # cancelled, overtaken by a load, or both at once
                self.faults.append("forecast: wrong %s, state %d, %s" % (wrong, state, self.client.get_goal_status_text()[:200]))


class Subscriber(threading.Thread):
    """Subscribes to one topic after another for a while, over connections of its own, as a process of its own would: rospy
    has one connection for all subscribers in a process. A fifth of them do not read what they are sent."""

    def __init__(self, uri, topics, seed, until):
        super().__init__()
        self.uri, self.topics, self.draw, self.until = uri, topics, random.Random(seed), until
        self.faults, self.connections, self.resets, self.bytes = [], 0, 0, 0

    def run(self):
        while time.monotonic() < self.until and len(self.faults) < 5:
            topic = self.draw.choice(self.topics)
            try:
                self.listen(topic, min(self.until, time.monotonic() + self.draw.uniform(0, 4)), self.draw.random() > 0.2)
            except ConnectionResetError:
                self.resets += 1
            except (OSError, ValueError, xmlrpc.client.Error) as e:
                self.faults.append("%s: %r" % (topic, e))

    def listen(self, topic, until, reads):
        node = xmlrpc.client.ServerProxy(self.uri)
        code, reason, protocol = node.requestTopic("/flood_%d" % self.ident, topic, [["TCPROS"]])
        if code != 1:
            raise ValueError(reason)
        with socket.create_connection(tuple(protocol[1:]), timeout=30) as connection:
            connection.sendall(rosgraph.network.encode_ros_handshake_header(
                {"callerid": "/flood_%d" % self.ident, "topic": topic, "type": "*", "md5sum": "*"}))
            self.connections += 1
            connection.settimeout(0.1)
            while time.monotonic() < until:
                if not reads:
                    time.sleep(0.1)
                    continue
                try:
                    received = len(connection.recv(1 << 18))
                except socket.timeout:
                    continue
                if received == 0:
                    raise ValueError("the node has closed the connection")
                self.bytes += received


class Flood(Scenarios):
    def memory(self, node):
        with open("/proc/%d/statm" % node.process.pid) as file:
            return int(file.read().split()[1]) * resource.getpagesize()

    def watch(self, node, threads, until):
        """The node's memory every tenth of a second until all threads have ended."""
        memory = []
        while any(thread.is_alive() for thread in threads):
            self.assertLess(time.monotonic(), until + 60, "a call hangs")
            self.assertIsNone(node.process.poll(), node.output)
            memory.append(self.memory(node))
            if len(memory) % 600 == 0:
                print("minute %d: %.1f MB" % (len(memory) // 600, statistics.median(memory[-600:]) / 1e6), flush=True)
            time.sleep(0.1)
        return memory

    def expect_flat(self, memory, before):
        """From the second minute to the last, or (in short runs) bounded by the 10 MB requests that are being served."""
        self.assertLess(memory[-1] - before, 250e6)
        if len(memory) < 3 * 600:
            return
        second, last = statistics.median(memory[600:1200]), statistics.median(memory[-600:])
        self.assertLess(last - second, 0.1 * second + 20e6, "memory grew from %d to %d bytes" % (second, last))

    def test_a_flood_of_calls(self):
        journal = self.path("journal")
        node = self.start("flooded", {"scenario": OASIS, "paused": False, "step_rate": 50, "journal": journal,
                                      "data_dir": self.path("data"), "forecast_rate": 2, "forecast_horizon": 5}, environment=RETURNS_LARGE_BUFFERS)
        node.call("step", Step, 1)
        self.assertTrue(node.call("save_checkpoint", SaveCheckpoint, CHECKPOINT).success)
        grid = node.latest("elevation", ElevationGrid)
        master = rosgraph.Master("/flood")
        uri = master.lookupNode("/flooded")
        topics = [topic for topic, nodes in master.getSystemState()[0] if "/flooded" in nodes]
        until = time.monotonic() + SECONDS
        clients = [Client("flooded", grid, seed, until) for seed in range(CLIENTS)]
        subscribers = [Subscriber(uri, topics, seed, until) for seed in range(SUBSCRIBERS)]
        forecaster = Forecaster("flooded", SUBSCRIBERS, until)
        before = self.memory(node)
        for thread in [*clients, *subscribers, forecaster]:
            thread.start()
        memory = self.watch(node, [*clients, *subscribers, forecaster], until)
        taken, refused = sum(c.taken for c in clients), sum(c.refused for c in clients)
        print("%.0f calls a second: %d taken, %d refused; %d subscriptions of %d topics, %.1f MB; memory grew by %.1f MB" % (
            (taken + refused) / SECONDS, taken, refused, sum(s.connections for s in subscribers), len(topics),
            sum(s.bytes for s in subscribers) / 1e6, (memory[-1] - before) / 1e6))
        print("forecasts by the status that they ended with: %s" % forecaster.ends)
        self.assertEqual([fault for thread in [*clients, *subscribers, forecaster] for fault in thread.faults], [])
        self.assertGreater(refused, 0.1 * (taken + refused))
        connections, resets = (sum(getattr(s, name) for s in subscribers) for name in ("connections", "resets"))
        self.assertGreater(connections, SUBSCRIBERS)
        # On a busy machine a few connections have been reset, seldom and for an unknown reason.
        print("%d of %d subscriptions were reset" % (resets, connections))
        self.assertLessEqual(resets, 0.05 * connections)
        self.expect_flat(memory, before)
        self.assertTrue(node.call("pause", Trigger).success)
        live = node.call("step", Step, 0).state_hash
        self.assertEqual(node.end()[0], 0)
        self.assertEqual(self.run_without_ros(OASIS, "--replay", journal), live)


if __name__ == "__main__":
    rospy.init_node("flood", anonymous=True)
    rostest.rosrun("desert_sim", "flood", Flood)
