#!/usr/bin/env python3
"""~forecast and its topics: a forecast is what the live run comes to, and the live run is not touched by any."""
import glob
import math
import os
import statistics

from actionlib import GoalStatus
from desert_sim.msg import ElevationGrid, Forecast, ForecastTerrainGoal, SimulationStatus
from desert_sim.msg import WindScheduleSegment
from desert_sim.srv import SetWindSchedule, SetWindScheduleRequest, Step
from desert_sim.testing import wait_until
from dynamic_reconfigure.msg import BoolParameter, Config, DoubleParameter, IntParameter, StrParameter
from dynamic_reconfigure.srv import Reconfigure
from forecast_client import LIMIT, ForecastClient
from nav_msgs.msg import OccupancyGrid
from node_memory import RETURNS_LARGE_BUFFERS, memory_of
from node_tests import CORNER, OASIS, Scenarios
import numpy
import rospy
import rostest
from std_srvs.srv import Trigger

STEPS = 900000  # of which no test sees the end
FORECASTS = 30


class Forecasts(Scenarios):
    def result(self, client, status=GoalStatus.SUCCEEDED):
        self.assertTrue(client.wait_for_result(), "no result")
        self.assertEqual(client.get_state(), status, client.get_goal_status_text())
        result = client.get_result()
        self.assertEqual(result.success, status == GoalStatus.SUCCEEDED)
        self.assertEqual(bool(result.message), status != GoalStatus.SUCCEEDED)
        return result

    def ask(self, node, status=GoalStatus.SUCCEEDED, client=None, **fields):
        client = client or ForecastClient("/" + node.name)
        client.send_goal(ForecastTerrainGoal(**fields))
        return self.result(client, status)

    def running(self, node):
        """The client of a goal that runs, without an end, at ten steps a second."""
        client = ForecastClient("/" + node.name)
        client.send_goal(ForecastTerrainGoal(horizon=STEPS / 10, moments=5))
        client.wait_until_running()
        return client

    def expect_running(self, client):
        """It goes on being told of."""
        told = len(client.feedback)
        wait_until(lambda: client.ended.is_set() or len(client.feedback) > told, "no more feedback", LIMIT)
        self.assertFalse(client.ended.is_set(), client.get_goal_status_text())

    def expect_of_live_run(self, node, forecast):
        """Steps to each moment, where the state is the one that was forecast."""
        step = forecast.step
        for n, moment in enumerate(forecast.steps):
            answer = node.call("step", Step, moment - step)
            step = moment
            self.assertEqual((answer.step, answer.state_hash), (moment, forecast.state_hashes[n]))
        live, costs = node.latest("elevation", ElevationGrid), node.latest("costmap", OccupancyGrid)
        self.assertEqual((live.step, live.elevation), (step, forecast.elevation[-1].data))
        self.assertEqual((costs.data, costs.info.origin), (forecast.costs[-1].data, forecast.costs[-1].info.origin))

    # ---- what it tells -------------------------------------------------------------------------

    def test_it_is_what_the_live_run_comes_to(self):
        node = self.start("forecasting", {"scenario": OASIS, "step_rate": 10})
        node.call("step", Step, 3)
        before = node.latest("status", SimulationStatus)
        forecast = self.ask(node, horizon=1.25, moments=5).forecast
        self.assertEqual((forecast.step, forecast.sim_time, forecast.header.frame_id), (3, before.sim_time, "map"))
        self.assertEqual(forecast.header.stamp, before.header.stamp)
        self.assertEqual(forecast.times, (0.25, 0.5, 0.75, 1.0, 1.25))
        self.assertEqual(forecast.steps, (5, 8, 10, 13, 15), "ten steps a second")
        self.assertEqual(forecast.seconds_per_sim_second, 0.1 / before.time_step)
        self.assertEqual(forecast.members, 1)
        self.assertEqual(forecast.probability, [])
        self.assertEqual(forecast.elevation[2].step, 10)
        for map_, unit in ((forecast.passable_until, "s"), (forecast.passable_from, "s"), (forecast.elevation[0], "m")):
            self.assertEqual((map_.width, map_.height, map_.cell_size, map_.unit), (40, 32, 1, unit))
            self.assertEqual((map_.origin.position.x, map_.origin.position.y, map_.origin.orientation.w), (-4, 6, 1))
        self.expect_of_live_run(node, forecast)

    def test_times_of_passable_cells_follow_from_the_costs(self):
        node = self.start("closing", {"scenario": OASIS, "step_rate": 2, "settings": ["wind.speed=9", "looseness.enabled=true"]})
        costs = [numpy.array(node.latest("costmap", OccupancyGrid).data)]
        forecast = self.ask(node, horizon=20, moments=5).forecast
        costs += [numpy.array(each.data) for each in forecast.costs]
        times = [0.0, *forecast.times]
        until, since = numpy.array(forecast.passable_until.data), numpy.array(forecast.passable_from.data)
        for i in range(len(until)):
            passable = [0 <= c[i] < 100 for c in costs]
            closed = passable.index(False) if False in passable else None
            self.assertEqual(until[i], math.inf if closed is None else times[max(0, closed - 1)])
            last = len(passable) - passable[::-1].index(False) if False in passable else 0
            self.assertEqual(since[i], math.inf if last == len(times) else times[last])
        self.assertGreater(numpy.isfinite(until).sum(), 0)

    def test_wind_and_parameters_of_a_request(self):
        node = self.start("windy", {"scenario": OASIS, "step_rate": 4})
        before = node.latest("status", SimulationStatus)
        segments = [WindScheduleSegment(direction_deg=90, speed=8, duration=2), WindScheduleSegment(speed=6, duration=1)]
        parameters = Config(doubles=[DoubleParameter("rain__rate", 1e-4), DoubleParameter("run__time_step", 0.5)])
        forecast = self.ask(node, horizon=5, moments=2, wind_kind="timeline", wind=segments, wind_repeat=True,
                            parameters=parameters).forecast
        self.assertEqual(node.latest("status", SimulationStatus).wind_above, before.wind_above)
        node.call("set_parameters", Reconfigure, parameters)
        answer = node.call("set_wind_schedule", SetWindSchedule, SetWindScheduleRequest(
            kind="timeline", segments=segments, repeat=True))
        self.assertTrue(answer.success, answer.message)
        self.expect_of_live_run(node, forecast)

    def test_an_ensemble_tells_shares_of_its_members(self):
        node = self.start("gusty", {"scenario": OASIS, "step_rate": 2, "settings": ["wind.speed=9", "looseness.enabled=true"]})
        fields = dict(horizon=5, moments=2, members=4, gust_speed=0.5, gust_direction_deg=60, gust_time=3, seed=5)
        forecast = self.ask(node, **fields).forecast
        self.assertEqual((forecast.members, len(forecast.probability)), (4, 2))
        share = numpy.array(forecast.probability[-1].data)
        self.assertLessEqual(set(4 * share), {0, 1, 2, 3, 4})
        first = numpy.array([0 <= cost < 100 for cost in forecast.costs[-1].data])
        self.assertTrue(((share >= first / 4) & (share <= (first + 3) / 4)).all(), "the first member is one of them")
        self.assertEqual(self.ask(node, **fields).forecast.probability, forecast.probability)
        self.expect_of_live_run(node, forecast)

    # ---- goals ---------------------------------------------------------------------------------

    def test_what_is_refused_says_why_and_ends_no_forecast(self):
        node = self.start("refusing", {"scenario": OASIS, "step_rate": 10})
        client, first = ForecastClient("/" + node.name), self.running(node)
        segment = WindScheduleSegment(speed=5, duration=1)
        for fields, texts in (
                (dict(horizon=math.nan), ["horizon", "nan"]), (dict(horizon=-1), ["horizon", "-1"]),
                (dict(moments=0), ["moments", ": 0", "[1, 100]"]), (dict(moments=2**32 - 1), ["moments", "[1, 100]"]),
                (dict(members=65, gust_time=1), ["members", ": 65", "[1, 64]"]),
                (dict(members=2, gust_time=1, gust_speed=math.inf), ["gust_speed", "inf", "[0, 1]"]),
                (dict(members=2), ["gust_time", ": 0"]),
                (dict(wind_kind="rose"), ["wind", "no segments", "rose"]),
                (dict(wind_kind="storm", wind=[segment]), ["wind_kind", "storm", "constant"]),
                (dict(wind_kind="constant", wind=[segment] * 2), ["wind", "2 segments", "constant"]),
                (dict(wind_kind="constant", wind=[WindScheduleSegment(speed=200)]), ["speed", "200", "[0, 100]"]),
                (dict(wind_kind="timeline", wind=[WindScheduleSegment(speed=5)]), ["duration", ": 0"]),
                (dict(wind_kind="timeline", wind=[segment] * 5000), ["5000", "4096"]),
                (dict(parameters=Config(doubles=[DoubleParameter("rain__rate", -1)])), ["rain.rate", "-1"]),
                (dict(parameters=Config(doubles=[DoubleParameter("lava__rate", 1)])), ["lava.rate", "unknown"]),
                (dict(parameters=Config(doubles=[DoubleParameter("wind_rate", 1)])), ["wind_rate", "no parameter of the desert"]),
                (dict(parameters=Config(bools=[BoolParameter("vegetation__enabled", False)])), ["vegetation.enabled", "end the plants"]),
                (dict(parameters=Config(ints=[IntParameter("vegetation__max_plants", 9)])), ["vegetation.max_plants", "cannot change"]),
                (dict(parameters=Config(strs=[StrParameter("water__sea", "lava")])), ["water.sea", "lava"])):
            message = self.ask(node, GoalStatus.REJECTED, client, **dict({"horizon": 1, "moments": 1}, **fields)).message
            for text in texts:
                self.assertIn(text, message)
        self.expect_running(first)
        for fields, text in ((dict(horizon=0.05), "1 to 1000000 steps"), (dict(horizon=2e5), "1 to 1000000 steps")):
            self.assertIn(text, self.ask(node, GoalStatus.REJECTED, client, **dict({"moments": 1}, **fields)).message)

    def test_cancelled_and_preempted_goals(self):
        node = self.start("busy", {"scenario": OASIS, "step_rate": 10})
        client = self.running(node)
        client.cancel_goal()
        self.assertIn("cancelled", self.result(client, GoalStatus.PREEMPTED).message)
        told = client.feedback
        self.assertEqual(sorted(f.progress for f in told), [f.progress for f in told])
        self.assertTrue(all(0 <= f.progress <= 1 and f.member == 0 and f.time <= STEPS / 10 for f in told))
        first = self.running(node)
        second = self.running(node)
        self.assertIn("preempted by a newer goal", self.result(first, GoalStatus.PREEMPTED).message)
        self.ask(node, horizon=1, moments=1)
        self.result(second, GoalStatus.PREEMPTED)

    def test_a_reset_or_the_end_of_the_node_ends_a_forecast(self):
        node = self.start("reset", {"scenario": OASIS, "step_rate": 10})
        client = self.running(node)
        self.assertTrue(node.call("reset", Trigger).success)
        self.assertIn("a reset or a load", self.result(client, GoalStatus.ABORTED).message)
        client = self.running(node)
        self.assertEqual(node.end()[0], 0, node.output)

    # ---- topics --------------------------------------------------------------------------------

    def test_topics_at_a_rate(self):
        """The thread that serves goals looks after each whether a forecast of the topics is due."""
        node = self.start("regular", {"scenario": OASIS, "step_rate": 10, "forecast_rate": 1000, "forecast_horizon": 0.5,
                                      "forecast_moments": 2})
        client, maps, costs = ForecastClient("/regular"), [], []

        def serve_goals(count):
            for _ in range(count):
                self.ask(node, client=client, horizon=0.1, moments=1)

        def expect_of_step(step):
            wait_until(lambda: maps[-1].step == step, "no forecast of step %d" % step, LIMIT)

        rospy.Subscriber("/regular/forecast/maps", Forecast, maps.append)
        wait_until(lambda: maps, "a new subscriber gets nothing", LIMIT)
        rospy.Subscriber("/regular/forecast/costmap", OccupancyGrid, costs.append)
        wait_until(lambda: costs, "a new subscriber of the costs gets nothing", LIMIT)
        self.assertEqual((maps[0].step, maps[0].steps, len(maps[0].costs)), (0, (2, 5), 2))
        self.assertEqual(costs[0].data, maps[0].costs[-1].data)
        for step in range(1, 4):
            node.call("step", Step, 1)
            expect_of_step(step)
            serve_goals(1)
        serve_goals(3)
        node.call("set_parameters", Reconfigure, Config(doubles=[DoubleParameter("forecast_rate", 0)]))
        node.call("step", Step, 1)
        serve_goals(2)
        node.call("step", Step, 1)
        node.call("set_parameters", Reconfigure, Config(doubles=[DoubleParameter("forecast_rate", 1000)]))
        expect_of_step(5)
        # The state that the terrain began with, for its first and for two new subscribers; the others once.
        self.assertLessEqual([m.step for m in maps].count(0), 3, "a state that stays is shown to new subscribers alone")
        self.assertEqual([m.step for m in maps if m.step > 0], [1, 2, 3, 5], "with a rate of 0 there are none")

    def test_goals_come_before_topics(self):
        node = self.start("urgent", {"scenario": OASIS, "step_rate": 10, "forecast_rate": 1000, "forecast_horizon": STEPS / 10})
        maps = []
        rospy.Subscriber("/urgent/forecast/maps", Forecast, maps.append)
        wait_until(lambda: self.threads_that_forecast(node), "no forecast for the topics is begun", LIMIT)
        self.assertEqual(len(self.ask(node, horizon=1, moments=1).forecast.times), 1)
        node.call("set_parameters", Reconfigure, Config(doubles=[DoubleParameter("forecast_horizon", 0.5)]))
        self.ask(node, horizon=1, moments=1)  # ends one that has begun before
        wait_until(lambda: maps, "no forecast after the goals", LIMIT)
        self.assertEqual(maps[0].times[-1], 0.5, "the first one that could come to its end")

    @staticmethod
    def threads_that_forecast(node):
        """Those that make the steps of a forecast have a name of their own."""
        names = []
        for path in glob.glob("/proc/%d/task/*/comm" % node.process.pid):
            try:
                with open(path) as file:
                    names.append(file.read().strip())
            except FileNotFoundError:
                continue  # it has ended since the folder was listed
        return names.count("forecast")

    # ---- the live run --------------------------------------------------------------------------

    def expect_steps_beside(self, node, client):
        """The live run goes on while the goal does."""
        first = node.latest("status", SimulationStatus).step
        wait_until(lambda: node.latest("status", SimulationStatus).step >= first + 20, "the live run stands still")
        self.expect_running(client)

    def test_cancelled_forecasts_leave_the_live_run_as_it_was(self):
        """forecast_timing.py measures its rate beside a hundred of them."""
        journal = self.path("journal")
        node = self.start("untouched", {"scenario": CORNER, "paused": False, "step_rate": 100, "journal": journal},
                          environment=RETURNS_LARGE_BUFFERS)
        client, memory = ForecastClient("/untouched"), []
        waits = [lambda: None, client.wait_until_known, client.wait_until_running]
        for n in range(FORECASTS):
            client.send_goal(ForecastTerrainGoal(horizon=STEPS / 100, moments=10, members=2, gust_time=1))
            waits[n % len(waits)]()
            if n == 2:
                self.expect_steps_beside(node, client)
            client.cancel_goal()
            self.assertTrue(client.wait_for_result(), "no result")
            self.assertIn(client.get_state(), (GoalStatus.PREEMPTED, GoalStatus.RECALLED))
            memory.append(memory_of(node))
        print("memory: %.1f MB after ten, %.1f MB after %d" % (memory[9] / 1e6, memory[-1] / 1e6, FORECASTS))
        quarantine = 64e6 if "ASAN_OPTIONS" in os.environ else 0  # of freed memory (scripts/_sanitize.sh)
        self.assertLess(statistics.median(memory[-10:]) - statistics.median(memory[10:20]), 10e6 + quarantine)
        self.assertTrue(node.call("pause", Trigger).success)
        live = node.call("step", Step, 0).state_hash
        self.assertEqual(node.end()[0], 0, node.output)
        self.assertEqual(self.run_without_ros(CORNER, "--replay", journal), live)


if __name__ == "__main__":
    rospy.init_node("forecast_test", disable_signals=True)
    rostest.rosrun("desert_sim", "forecast", Forecasts)
