#!/usr/bin/env python3
"""desert_sim.TerrainClient and desert_sim.Simulation of Python beside a node."""
import math
import os
import shutil
import threading
import unittest
import xmlrpc.client
from unittest import mock

import actionlib
import desert_sim
import numpy
import rosgraph
import rospy
import rostest
from desert_sim.msg import (ElevationUpdate, Forecast, ForecastTerrainAction, ForecastTerrainFeedback,
                            ForecastTerrainResult, LayerGrid)
from desert_sim.testing import PATIENCE, wait_until
from nav_msgs.msg import OccupancyGrid
from std_msgs.msg import Empty

THRESHOLD = 0.01  # of the elevation
MIDDLE, SIZE = (74, 28), (128, 96)  # of the terrain [m]


class Client(unittest.TestCase):
    def setUp(self):
        self.desert = desert_sim.Simulation(timeout=60 * PATIENCE)
        self.desert.pause()
        self.desert.load_scenario("start.yaml")

    @classmethod
    def setUpClass(cls):
        cls.folder = rospy.get_param("/desert_sim/data_dir")
        desert_sim.Simulation(timeout=60 * PATIENCE).status()
        os.makedirs(cls.folder, exist_ok=True)
        shutil.copy(rospy.get_param("/desert_sim/scenario"), cls.folder + "/start.yaml")

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder, ignore_errors=True)

    def client(self, *layers, **options):
        """One that asks for no keyframe because a first one takes its time; those that have to ask get other pauses."""
        client = desert_sim.TerrainClient(layers=layers or ["elevation"],
                                          **{"shortest_pause": 3600, "longest_pause": 3600, **options})
        self.addCleanup(client.close)
        self.assertTrue(client.wait_for_terrain(60 * PATIENCE))
        return client

    def whole(self, layer):
        return self.desert.submap(MIDDLE, SIZE, [layer])[layer]

    def expect_same(self, client, layer, threshold):
        """The client has what the node has, as far as the threshold of updates allows."""
        held, there = client[layer], self.whole(layer)
        self.assertTrue(held.same_geometry(there))
        self.assertEqual((held.unit, held.step, held.frame), (there.unit, there.step, "terrain"))
        self.assertLessEqual(numpy.abs(held.values.astype(float) - there.values).max(), threshold)


class Updates(Client):
    def drive(self, client, until_step=4):
        """Wind, edits and steps, each followed to the client."""
        for turn in range(until_step):
            self.desert.edit("sand", "circle", "add", 0.02 + 2 * turn, center=(40 + 20 * turn, 20), radius=9)
            step = self.desert.step(3).step
            self.assertTrue(client.wait_for_step(step, 60 * PATIENCE), "updates of the step")
        return step

    def test_they_are_put_together(self):
        client = self.client("elevation", "sand_depth", "traversability")
        begin = {layer: client[layer] for layer in client.layers}
        step = self.drive(client)
        for layer, threshold in (("elevation", THRESHOLD + 1e-6), ("sand_depth", 0), ("traversability", 0)):
            self.assertEqual(client[layer].step, step)
            self.expect_same(client, layer, threshold)
            counts = client.statistics(layer)
            self.assertEqual((counts.gaps, counts.refused, counts.requests), (0, 0, 0), counts)
            self.assertGreater(counts.updates, 0)
            self.assertEqual(begin[layer].step, 0, "a map of one moment never changes")
            self.assertGreater(numpy.abs(begin[layer].values - client[layer].values).max(), 0.1)
        self.assertTrue(client.up_to_date and client.connected)
        numpy.testing.assert_array_equal(client["traversability"].cost() == 100, client["traversability"].values <= 0)

    def test_on_change_is_told_each_cell_in_order(self):
        told = []
        client = self.client(on_change=told.append)
        self.drive(client)
        wait_until(lambda: told[-1].map is client.map, "the last change is told, too")
        self.assertTrue(told[0].replaced)
        values = numpy.full((48, 64), numpy.nan, numpy.float32)
        for change in told:
            values[change.cells.slices] = change.map.values[change.cells.slices]
            numpy.testing.assert_array_equal(values, change.map.values, "a change outside the rectangle was not told")
        self.assertEqual([c.map.step for c in told], sorted(c.map.step for c in told))
        self.assertFalse(any(change.cells.empty for change in told))

    def test_what_is_lost_is_noticed_and_fetched(self):
        client = self.client("elevation", "sand_depth", shortest_pause=0.5, longest_pause=10)
        self.drive(client, 1)
        # A sender that is not the node: an update that nobody can continue from.
        intruder = rospy.Publisher("/desert_sim/elevation_updates", ElevationUpdate, queue_size=1)
        self.addCleanup(intruder.unregister)
        wait_until(lambda: intruder.get_num_connections() > 0, "the client does not listen")
        held = client.map
        lost = ElevationUpdate(keyframe=held.keyframe, sequence=held.sequence + 5, step=held.step, sim_time=held.sim_time)
        lost.header.frame_id, lost.header.stamp = "terrain", rospy.Time.now()
        intruder.publish(lost)
        wait_until(lambda: client.statistics().gaps == 1, "the gap is not noticed")
        self.assertIn("is missing", client.statistics().last_gap)
        wait_until(lambda: client.up_to_date, "no keyframe was fetched")
        self.assertGreaterEqual(client.statistics().requests, 1)
        self.assertEqual(client.statistics("sand_depth").gaps, 0)
        self.drive(client, 3)
        self.expect_same(client, "elevation", THRESHOLD + 1e-6)

    def test_a_node_that_does_not_listen_to_requests_is_told_of_them_again(self):
        """As after it was refused by a publisher that had just gone and come again: it does not connect by itself then."""
        self.client()
        requests = rospy.Publisher("/desert_sim/request_keyframe", Empty, queue_size=1)
        self.addCleanup(requests.unregister)
        wait_until(requests.get_num_connections, "the node does not listen to requests")
        node = xmlrpc.client.ServerProxy(rosgraph.Master(rospy.get_name()).lookupNode("/desert_sim"))
        node.publisherUpdate("/master", requests.resolved_name, [])
        wait_until(lambda: requests.get_num_connections() == 0, "the node still listens")
        self.client(shortest_pause=0.05, longest_pause=0.05)  # needs a keyframe, and shares the connection of the first

    def test_another_terrain_comes_whole(self):
        told = []
        client = self.client(on_change=told.append)
        self.drive(client, 1)
        shutil.copy(rospy.get_param("/desert_sim/scenario").replace("corner", "other"), self.folder + "/other.yaml")
        self.desert.load_scenario("other.yaml")
        wait_until(lambda: client.map.values.shape != (48, 64), "the other terrain")
        wait_until(lambda: told[-1].map is client.map, "it is told, too")
        self.assertTrue(told[-1].replaced)
        self.assertEqual(client.map.step, 0)

    def test_two_clients_and_layers_that_come_and_go(self):
        # rospy has one connection for both: to the node the second is no new subscriber, and has to ask for a keyframe.
        first, second = self.client(), self.client(shortest_pause=0.05, longest_pause=0.5)
        step = self.desert.step(1).step
        self.assertTrue(first.wait_for_step(step, 60 * PATIENCE) and second.wait_for_step(step, 60 * PATIENCE))
        first.subscribe_layer("slope")
        self.assertTrue(first.wait_for_terrain(60 * PATIENCE))
        self.assertEqual(first.layers, ["elevation", "slope"])
        slope = first["slope"]
        self.assertEqual((slope.unit, slope.layer), ("rad", "slope"))
        first.unsubscribe_layer("slope")
        self.assertIsNone(first.layer_map("slope"))
        with self.assertRaises(KeyError):
            first["slope"]
        first.close()
        step = self.desert.step(1).step
        self.assertTrue(second.wait_for_step(step, 60 * PATIENCE), "the other one goes on")

    def test_queries_from_many_threads(self):
        client, wrong = self.client("elevation", "sand_depth"), []

        def ask():
            while not done.is_set():
                ground = client.map
                column, row = ground.world_to_cell(127, -9)
                if ground.values[row, column] != ground.cell_value(127, -9) or math.isnan(client.value("sand_depth", 74, 28)):
                    wrong.append(ground.step)

        done = threading.Event()
        threads = [threading.Thread(target=ask) for _ in range(4)]
        for thread in threads:
            thread.start()
        self.drive(client, 2)
        done.set()
        for thread in threads:
            thread.join(60 * PATIENCE)
            self.assertFalse(thread.is_alive())
        self.assertEqual(wrong, [])

    def test_options_that_are_not_valid(self):
        with self.assertRaisesRegex(ValueError, "layer 'lava' is not one of: elevation, bedrock"):
            desert_sim.TerrainClient(layers=["lava"])
        with self.assertRaisesRegex(ValueError, "a list of names"):
            desert_sim.TerrainClient(layers="elevation")
        with self.assertRaisesRegex(ValueError, "update_queue is 0"):
            desert_sim.TerrainClient(update_queue=0)
        with self.assertRaisesRegex(ValueError, "longest_pause"):
            desert_sim.TerrainClient(shortest_pause=2, longest_pause=1)
        client = self.client()
        with self.assertRaisesRegex(ValueError, "'lava'"):
            client.value("lava", 1, 1)

    def test_a_node_that_is_not_there(self):
        client = desert_sim.TerrainClient("/nowhere")
        self.addCleanup(client.close)
        self.assertFalse(client.wait_for_terrain(0.1))
        self.assertIsNone(client.map)
        self.assertTrue(math.isnan(client.elevation(1, 2)))
        self.assertEqual(client.elevation(numpy.zeros(3), 2.0).shape, (3,))
        self.assertFalse(client.connected or client.up_to_date)


class Calls(Client):
    def test_layers_are_those_of_the_node(self):
        self.assertEqual(tuple(self.desert.submap(MIDDLE, (2, 2))), desert_sim.LAYERS)

    def test_steps(self):
        before = self.desert.step(0)
        after = self.desert.step(3)
        self.assertEqual(after.step, before.step + 3)
        self.assertNotEqual(after.state_hash, before.state_hash)
        self.assertEqual(self.desert.status().step, after.step)
        self.assertEqual(self.desert.status().state, "paused")
        self.desert.resume()
        wait_until(lambda: self.desert.status().step > after.step, "it does not run")
        self.desert.pause()
        self.desert.reset()
        self.assertEqual(self.desert.step(0).state_hash, before.state_hash)

    def test_refusals_have_the_nodes_reason(self):
        before = self.desert.step(0).state_hash
        for call, reason in ((lambda: self.desert.edit("lava", "circle", "add", 1, center=(40, 20), radius=4), "lava"),
                             (lambda: self.desert.set_wind(float("nan")), "speed"),
                             (lambda: self.desert.submap((0, 0), (1e4, 1)), "is not inside the terrain"),
                             (lambda: self.desert.query([(math.inf, 0)]), "points"),
                             (lambda: self.desert.load_checkpoint("none.ckpt"), "none.ckpt"),
                             (lambda: self.desert.set_parameters({"wind.speed": 1e9}), "wind.speed"),
                             (lambda: self.desert.set_parameters({"grid.width": 9}), "cannot change"),
                             (lambda: self.desert.undo("no such stroke"), "there is no stroke that can be undone"),
                             (lambda: self.desert.set_weather(sea="black"), "sea")):
            with self.assertRaises(desert_sim.SimulationError) as refused:
                call()
            self.assertIn(reason, refused.exception.reason)
            self.assertIn(refused.exception.service + ": ", str(refused.exception))
            name = refused.exception.service.rsplit("/", 1)[1]
            self.assertEqual(str(refused.exception).count(name + ": "), 1, refused.exception)
            self.assertTrue(refused.exception.service.startswith("/desert_sim/"))
        self.assertEqual(self.desert.step(0).state_hash, before)
        with self.assertRaisesRegex(TypeError, "'radus' is not one of.*did you mean 'radius'"):
            self.desert.edit("sand", "circle", "add", 1, center=(40, 20), radus=4)
        with self.assertRaisesRegex(desert_sim.SimulationError, "/nowhere/step: there is no such service"):
            desert_sim.Simulation("/nowhere", timeout=0.2).step()

    def test_edit_and_undo(self):
        before = self.desert.step(0).state_hash
        answer = self.desert.edit("sand", "capsule", "add", 2, points=[(30, 0), (60, 10, 0)], radius=4, stroke="a wall")
        self.assertGreater(answer.volume, 100)
        self.assertNotEqual(self.desert.step(0).state_hash, before)
        self.assertEqual(self.desert.undo("a wall").stroke, "a wall")
        self.assertEqual(self.desert.step(0).state_hash, before)
        self.desert.redo("a wall")
        self.assertNotEqual(self.desert.step(0).state_hash, before)

    def test_wind_and_weather(self):
        self.desert.set_wind(speed=7, direction_deg=90)
        self.assertAlmostEqual(self.desert.status().wind_above.y, 7, 5)
        self.desert.set_wind(vector=(3, -4))
        self.assertAlmostEqual(self.desert.status().wind_above.x, 3, 5)
        self.desert.set_wind_schedule([{"speed": 4, "duration": 5}, {"speed": 6, "direction_deg": 30, "duration": 5}], repeat=True)
        self.desert.edit_wind("add", id=3, kind="vortex", center=(60, 20), radius=5, speed=2, velocity=(1, 0))
        self.desert.edit_wind("change", id=3, kind="vortex", path=[(0, 60, 20), (9, 70, 20), (20, 70, 5)], radius=5, speed=2)
        self.desert.edit_wind("remove", id=3)
        self.desert.set_weather(rain_rate=1e-4, springs=[{"x": 60, "y": 20, "radius": 4, "discharge": 2}])
        self.desert.step(2)
        self.assertGreater(self.whole("water_depth").values.max(), 0)

    def test_parameters(self):
        values = self.desert.set_parameters({"saltation.lift": 0.25, "wind_shadow.enabled": False, "step_rate": 7,
                                             "avalanching.quality": "fast", "wind.radii": [30.5, 90]})
        self.assertEqual([values[name] for name in ("saltation.lift", "wind_shadow.enabled", "step_rate", "avalanching.quality",
                                                    "wind.radii")], [0.25, False, 7, "fast", "[30.5, 90]"])

    def test_query_is_in_the_order_of_the_points(self):
        points = numpy.array([[127, -9], [20, 20], [0, 0]])
        found = self.desert.query(points)
        self.assertEqual(found.in_bounds.tolist(), [True, True, False])
        numpy.testing.assert_allclose(found.elevation, [7.5, 1.5, math.nan], atol=1e-4)
        numpy.testing.assert_allclose(found.sand[:2], [6.5, 0.5], atol=1e-4)
        numpy.testing.assert_allclose(found.normal[1], [0, 0, 1], atol=1e-6)
        self.assertEqual((found.x.tolist(), found.y.tolist()), ([127, 20, 0], [-9, 20, 0]))
        self.assertGreater(found.wind[1, 0], 1)
        self.assertEqual(self.desert.query([]).elevation.shape, (0,))

    def test_forecast(self):
        """The action of the node itself; Forecasts has a server that is made up."""
        start = self.desert.step(2)
        forecast = self.desert.forecast(1.0, moments=2, timeout=60 * PATIENCE)
        self.assertEqual((forecast.step, forecast.times.tolist()), (start.step, [0.5, 1.0]))
        self.assertEqual((forecast.costs.shape, forecast.probability.shape), ((2, 48, 64), (0, 48, 64)))
        self.assertEqual((forecast.passable_until.unit, forecast.passable_from.unit), ("s", "s"))
        with self.assertRaisesRegex(desert_sim.SimulationError, "/desert_sim/forecast: .*horizon: -1 is not in"):
            self.desert.forecast(-1)
        client = self.client()
        for step, state_hash, ground in zip(forecast.steps, forecast.state_hashes, forecast.elevation):
            answer = self.desert.step(step - self.desert.step(0).step)
            self.assertEqual((answer.step, answer.state_hash), (step, state_hash), "the live run comes to the same")
            self.assertTrue(client.wait_for_step(step, 60 * PATIENCE) and ground.same_geometry(client.map))
            numpy.testing.assert_array_equal(ground.values, self.whole("elevation").values)

    def test_files(self):
        start = self.desert.step(2)
        self.assertEqual(self.desert.save_checkpoint("a.ckpt").state_hash, start.state_hash)
        self.desert.step(1)
        self.assertEqual(self.desert.load_checkpoint("a.ckpt").state_hash, start.state_hash)
        answer = self.desert.export_terrain("other/programs.obj")
        self.assertEqual((answer.step, answer.path), (start.step, answer.files[0]))
        self.assertEqual({os.path.relpath(file, self.folder) for file in answer.files},
                         {"other/programs.obj", "other/programs.mtl", "other/programs_ground.png"})
        self.assertTrue(all(os.path.getsize(file) > 0 for file in answer.files))
        with self.assertRaisesRegex(desert_sim.SimulationError, "'.objj' is not an ending .*did you mean '.obj'"):
            self.desert.export_terrain("other/programs.objj")
        self.desert.save_terrain("saved")
        self.desert.load_terrain("saved")
        self.assertEqual(self.desert.step(0).step, 0)


class FakeForecaster:
    """An action server that tells what it was asked: the cost at moment n is n, or 100 where the goal is refused. A goal
    with a horizon above 1000 s ends when it is cancelled, any other when its feedback was `heard`: a result that overtakes
    it would end the goal before."""

    def __init__(self, name):
        self.goals, self.heard, self.loses_next = [], threading.Event(), False
        self.server = actionlib.SimpleActionServer(name, ForecastTerrainAction, self.run, auto_start=False)
        self.receive = self.server.action_server.internal_goal_callback
        self.server.action_server.internal_goal_callback = self.receive_or_lose
        self.server.start()
        # rospy has one connection of a topic for all of a process: clients that come later have the connections of this one,
        # which both ends know of.
        self.client = actionlib.ActionClient(name, ForecastTerrainAction)
        publishers = (self.client.pub_goal, self.client.pub_cancel, self.server.action_server.feedback_pub,
                      self.server.action_server.result_pub)
        wait_until(lambda: all(publisher.get_num_connections() > 0 for publisher in publishers), "connections of an action")

    def receive_or_lose(self, goal):
        if self.loses_next:
            self.loses_next = False
        else:
            self.receive(goal)

    def run(self, goal):
        self.goals.append(goal)
        if goal.horizon < 0:
            self.server.set_aborted(ForecastTerrainResult(message="horizon: -1 is not above 0"))
            return
        self.server.publish_feedback(ForecastTerrainFeedback(progress=0.5))
        if goal.horizon > 1e3:
            wait_until(self.server.is_preempt_requested, "nobody cancels the goal")
        else:
            wait_until(self.heard.is_set, "nobody hears the feedback")
        result = ForecastTerrainResult(success=True)
        result.forecast = Forecast(step=7, seconds_per_sim_second=22, members=1, times=[goal.horizon / goal.moments] * goal.moments,
                                   steps=list(range(goal.moments)), state_hashes=["0" * 16] * goal.moments)
        cells = {"width": 3, "height": 2}
        for n in range(goal.moments):
            costs = OccupancyGrid(data=[n, -1, 100, 3, 4, 5])
            costs.info.width, costs.info.height = 3, 2
            result.forecast.costs.append(costs)
            result.forecast.elevation.append(self.grid("elevation", [n] * 6, **cells))
        result.forecast.passable_until = self.grid("passable_until", [math.inf, 0, 0, 1, 2, math.inf], **cells)
        result.forecast.passable_from = self.grid("passable_from", [0, math.inf, math.inf, 0, 0, 0], **cells)
        self.server.set_succeeded(result)

    @staticmethod
    def grid(layer, data, **fields):
        grid = LayerGrid(layer=layer, unit="m" if layer == "elevation" else "s", cell_size=2, data=data, keyframe=1, **fields)
        grid.origin.orientation.w = 1
        return grid


class Forecasts(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.fake = FakeForecaster("/fake_desert/forecast")
        cls.desert = desert_sim.Simulation("/fake_desert", timeout=60 * PATIENCE)

    def test_it_comes_as_arrays(self):
        self.fake.heard.clear()
        progress = []

        def hear(share):
            progress.append(share)
            self.fake.heard.set()

        forecast = self.desert.forecast(
            20, moments=2, on_progress=hear, wind_kind="constant", wind=[{"speed": 9, "direction_deg": 30}],
            parameters={"rain.rate": 0.5, "water.enabled": True}, members=4, seed=5)
        goal = self.fake.goals[-1]
        self.assertEqual((goal.horizon, goal.moments, goal.members, goal.seed, goal.wind_kind), (20, 2, 4, 5, "constant"))
        self.assertEqual((goal.wind[0].speed, goal.wind[0].direction_deg), (9, 30))
        self.assertEqual((goal.parameters.doubles[0].name, goal.parameters.doubles[0].value), ("rain__rate", 0.5))
        self.assertEqual((forecast.step, forecast.times.tolist()), (7, [10, 10]))
        self.assertEqual(forecast.costs.tolist(), [[[0, -1, 100], [3, 4, 5]], [[1, -1, 100], [3, 4, 5]]])
        self.assertEqual(forecast.elevation[1].value(3, 2), 1)
        self.assertEqual(forecast.passable_until.values.tolist(), [[math.inf, 0, 0], [1, 2, math.inf]])
        self.assertEqual(forecast.passable_from.cell_value(5, 1), math.inf)
        self.assertEqual(forecast.probability.shape, (0, 2, 3))
        self.assertEqual(progress, [0.5])

    def test_a_goal_that_is_lost_on_its_way_is_sent_again(self):
        self.fake.heard.set()
        self.fake.loses_next, known = True, len(self.fake.goals)
        with mock.patch("desert_sim.forecast._REPEAT_PERIOD", 0.1):
            self.assertEqual(self.desert.forecast(20, moments=1, timeout=60 * PATIENCE).step, 7)
        self.assertFalse(self.fake.loses_next, "none was lost")
        self.assertEqual([goal.horizon for goal in self.fake.goals[known:]], [20])

    def test_refusals_and_delays(self):
        with self.assertRaisesRegex(desert_sim.SimulationError, "/fake_desert/forecast: horizon: -1 is not above 0"):
            self.desert.forecast(-1)
        with self.assertRaisesRegex(desert_sim.SimulationError, "no forecast within 0.3 s: it was cancelled"):
            self.desert.forecast(2e3, timeout=0.3)
        with self.assertRaisesRegex(desert_sim.SimulationError, "there is no such action"):
            desert_sim.Simulation("/nowhere", timeout=0.2).forecast(1)


if __name__ == "__main__":
    rospy.init_node("python_client", disable_signals=True)
    rostest.rosrun("desert_sim", "python_client", "python_client")
