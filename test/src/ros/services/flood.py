#!/usr/bin/env python3
"""A flood of service calls from several clients, a fifth of them malformed, while subscribers of all topics come and go:
none breaks the node, each malformed one is refused with a reason, its memory stays, and the journal replays to the same
hash. DESERT_FLOOD_CALLS (default 250) says how many each client makes; from 10000 on memory must not grow in the end."""
import math
import os
import random
import socket
import statistics
import threading
import traceback
import xmlrpc.client

from actionlib import GoalStatus
from desert_sim.msg import ElevationGrid, ForecastTerrainGoal, WindScheduleSegment
from desert_sim.srv import EditPlants, EditPlantsRequest, EditTerrain, EditTerrainRequest, EditWind, EditWindRequest
from desert_sim.srv import GetSubmap, GetSubmapRequest, LoadCheckpoint, LoadCheckpointRequest, LoadTerrain, LoadTerrainRequest
from desert_sim.srv import QueryTerrain, QueryTerrainRequest, SaveCheckpoint, SaveCheckpointRequest
from desert_sim.srv import SetWeather, SetWeatherRequest, SetWind, SetWindRequest, SetWindSchedule, SetWindScheduleRequest, Step
from desert_sim.testing import wait_until
from forecast_client import ForecastClient
from geometry_msgs.msg import Point
from node_memory import RETURNS_LARGE_BUFFERS, memory_of
from node_tests import OASIS, Scenarios
import rosgraph
import rospy
import rostest
from std_srvs.srv import Trigger

CALLS = int(os.environ.get("DESERT_FLOOD_CALLS", "250"))
CLIENTS, SUBSCRIBERS = 4, 30
SUBSCRIPTIONS, FORECASTS = 2, 5  # of each subscriber, and of the forecaster, at least
MANY_CALLS = 10000
CHECKPOINT = "start.ckpt"
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
        plants = {"operation": "clear"} if draw.random() < 0.5 else {
            "operation": "plant", "density": draw.uniform(0, 0.2), "size": 0.1, "seed": draw.randrange(99)}
        return "edit_plants", EditPlants, EditPlantsRequest(
            species=draw.choice(["tree", "bush"]), shape="circle", center=place(draw, grid), radius=draw.uniform(1, 6),
            **plants)
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


class Progress:
    """How many calls have been answered: what goes on beside them begins and ends by their number."""

    def __init__(self):
        self.count, self.stopped, self.changed = 0, False, threading.Condition()

    def answered(self):
        with self.changed:
            self.count += 1
            self.changed.notify_all()

    def stop(self):
        """Something went wrong: nobody waits for more calls."""
        with self.changed:
            self.stopped = True
            self.changed.notify_all()

    @property
    def over(self):
        return self.stopped or self.count >= CLIENTS * CALLS

    def reached(self, count):
        return self.over or self.count >= count

    def wait_for(self, count):
        with self.changed:
            self.changed.wait_for(lambda: self.reached(count))


class Worker(threading.Thread):
    """A thread that keeps what went wrong, after which it ends soon."""

    def __init__(self, seed, progress):
        super().__init__(daemon=True)
        self.draw, self.progress, self.faults = random.Random(seed), progress, []

    def run(self):
        try:
            while not self.done() and len(self.faults) < 5:
                self.work()
        except Exception:  # noqa: B902 the test shows it
            self.faults.append(traceback.format_exc())
        if self.faults:
            self.progress.stop()


class Client(Worker):
    """Calls over connections that stay."""

    def __init__(self, seed, progress, node, grid):
        super().__init__(seed, progress)
        self.node, self.grid = node, grid
        self.proxies, self.taken, self.refused = {}, 0, 0

    def done(self):
        return self.taken + self.refused + len(self.faults) >= CALLS

    def work(self):
        wrong = self.draw.random() < 0.2
        service, kind, request = bad(self.draw) if wrong else good(self.draw, self.grid)
        if service not in self.proxies:
            self.proxies[service] = rospy.ServiceProxy("/%s/%s" % (self.node, service), kind, persistent=True)
        try:
            answer = self.proxies[service](request)
        finally:
            self.progress.answered()
        full = service == "edit_plants" and "vegetation.max_plants" in answer.message
        if not full and wrong == answer.success or (wrong and not answer.message):
            self.faults.append("%s: wrong %s, success %s, %s" % (service, wrong, answer.success, answer.message[:200]))
        elif len(answer.message) > 2000:
            self.faults.append("%s: a reason of %d characters" % (service, len(answer.message)))
        else:
            self.taken += not wrong
            self.refused += wrong

    def close(self):
        for proxy in self.proxies.values():
            proxy.close()


class Forecaster(Worker):
    """Asks for forecasts, and cancels two thirds of them."""

    def __init__(self, seed, progress, node):
        super().__init__(seed, progress)
        self.client, self.ends = ForecastClient("/" + node), {}

    def done(self):
        return self.progress.over and sum(self.ends.values()) >= FORECASTS

    def work(self):
        wrong, way = self.draw.random() < 0.2, self.draw.randrange(3)
        horizon = self.draw.uniform(1, 20) if way < 2 else self.draw.uniform(0.1, 1)
        horizon = self.draw.choice(BAD_NUMBERS) if wrong else horizon
        members = self.draw.randrange(3)
        gusts = {"gust_speed": 0.2, "gust_time": 5} if members > 1 else {}
        self.client.send_goal(ForecastTerrainGoal(horizon=horizon, moments=self.draw.randrange(1, 9), members=members,
                                                  **gusts))
        if way > 0:
            self.client.wait_until_running()
        if way < 2:
            self.client.cancel_goal()
        if not self.client.wait_for_result():
            raise AssertionError("a forecast has no end")
        state = self.client.get_state()
        self.ends[state] = self.ends.get(state, 0) + 1
        # Cancelled before it was looked at, overtaken by a load, or both at once.
        if wrong != (state == GoalStatus.REJECTED) and state not in (GoalStatus.RECALLED, GoalStatus.ABORTED):
            self.faults.append("forecast: wrong %s, state %d, %s" % (wrong, state, self.client.get_goal_status_text()[:200]))


class Subscriber(Worker):
    """Subscribes to one topic after another until some more calls have been answered, over connections of its own, as a
    process of its own would: rospy has one connection for all subscribers in a process. A fifth of them do not read what
    they are sent."""

    def __init__(self, seed, progress, uri, topics):
        super().__init__(seed, progress)
        self.uri, self.topics = uri, topics
        self.connections, self.bytes = 0, 0

    def done(self):
        return self.progress.over and self.connections >= SUBSCRIPTIONS

    def work(self):
        topic = self.draw.choice(self.topics)
        try:
            self.listen(topic, self.progress.count + self.draw.randrange(CLIENTS * CALLS // 2), self.draw.random() > 0.2)
        except (OSError, ValueError, xmlrpc.client.Error):
            self.faults.append("%s: %s" % (topic, traceback.format_exc()))

    def listen(self, topic, end, reads):
        node = xmlrpc.client.ServerProxy(self.uri)
        code, reason, protocol = node.requestTopic("/flood_%d" % self.ident, topic, [["TCPROS"]])
        if code != 1:
            raise ValueError(reason)
        with socket.create_connection(tuple(protocol[1:])) as connection:
            connection.sendall(rosgraph.network.encode_ros_handshake_header(
                {"callerid": "/flood_%d" % self.ident, "topic": topic, "type": "*", "md5sum": "*"}))
            self.connections += 1
            if not reads:
                self.progress.wait_for(end)
            connection.settimeout(0.1)
            while not self.progress.reached(end):
                try:
                    received = len(connection.recv(1 << 18))
                except socket.timeout:
                    continue
                if received == 0:
                    raise ValueError("the node has closed the connection")
                self.bytes += received


class Flood(Scenarios):
    def watch(self, node, threads):
        """The node's memory from time to time until all threads have ended."""
        memory = []

        def ended():
            self.assertIsNone(node.process.poll(), node.output)
            memory.append(memory_of(node))
            return not any(thread.is_alive() for thread in threads)

        wait_until(ended, "a call hangs", 300 + CALLS)
        return memory

    def expect_flat(self, memory):
        """From the second tenth to the last."""
        n = len(memory) // 10
        second, last = statistics.median(memory[n:2 * n]), statistics.median(memory[-n:])
        self.assertLess(last - second, 0.1 * second + 20e6, "memory grew from %d to %d bytes" % (second, last))

    def test_a_flood_of_calls(self):
        journal = self.path("journal")
        node = self.start("flooded", {"scenario": OASIS, "paused": False, "step_rate": 50, "journal": journal,
                                      "data_dir": self.path("data"), "forecast_rate": 2, "forecast_horizon": 5},
                          environment=RETURNS_LARGE_BUFFERS)
        node.call("step", Step, 1)
        self.assertTrue(node.call("save_checkpoint", SaveCheckpoint, CHECKPOINT).success)
        grid = node.latest("elevation", ElevationGrid)
        master = rosgraph.Master("/flood")
        uri = master.lookupNode("/flooded")
        topics = [topic for topic, nodes in master.getSystemState()[0] if "/flooded" in nodes]
        progress = Progress()
        clients = [Client(seed, progress, "flooded", grid) for seed in range(CLIENTS)]
        subscribers = [Subscriber(seed, progress, uri, topics) for seed in range(SUBSCRIBERS)]
        forecaster = Forecaster(SUBSCRIBERS, progress, "flooded")
        before = memory_of(node)
        threads = [*clients, *subscribers, forecaster]
        for thread in threads:
            thread.start()
        memory = self.watch(node, threads)
        print("%d calls taken, %d refused; %d subscriptions of %d topics, %.1f MB; memory grew by %.1f MB" % (
            sum(c.taken for c in clients), sum(c.refused for c in clients), sum(s.connections for s in subscribers),
            len(topics), sum(s.bytes for s in subscribers) / 1e6, (memory[-1] - before) / 1e6))
        print("forecasts by the status that they ended with: %s" % forecaster.ends)
        self.assertEqual([fault for thread in threads for fault in thread.faults], [])
        wait_until(lambda: memory_of(node) - before < 250e6, "memory stays")  # while 10 MB requests are served
        if CALLS >= MANY_CALLS:
            self.expect_flat(memory)
        for client in clients:
            client.close()
        self.assertTrue(node.call("pause", Trigger).success)
        live = node.call("step", Step, 0).state_hash
        self.assertEqual(node.end()[0], 0)
        self.assertEqual(self.run_without_ros(OASIS, "--replay", journal), live)


if __name__ == "__main__":
    rospy.init_node("flood", anonymous=True)
    rostest.rosrun("desert_sim", "flood", Flood)
