#!/usr/bin/env python3
"""Parameters of a live node: dynamic_reconfigure with its own clients, and ~reload_parameters."""
import signal
import threading

from desert_sim.msg import ElevationGrid, SimulationStatus
from desert_sim.srv import SetWind, Step
from desert_sim.testing import PATIENCE, wait_until
from dynamic_reconfigure.client import Client, DynamicReconfigureCallbackException
from dynamic_reconfigure.msg import Config, DoubleParameter
from dynamic_reconfigure.srv import Reconfigure as ReconfigureService
from map_client import Listener
from node_tests import CORNER, ScriptedClock, Scenarios, saved_steps
import rospy
import rostest
from sensor_msgs.msg import PointCloud2
from std_srvs.srv import Trigger

# Some of all kinds, and each that needs other memory than the scenario's.
CHANGES = {
    "wind__speed": 7.3, "wind__projection": False, "wind__coarsening": 2, "wind__radii": "[30.5, 90]",
    "wind__weights": "[0.7, 0.3]", "wind__deflections": "[4, 16]", "wind_shadow__enabled": False,
    "echo_dunes__enabled": True, "saltation__lift": 0.3, "abrasion__rate": 0.01, "reptation__method": "steepest",
    "avalanching__scheme": "sweeps", "avalanching__quality": "fast", "run__check_every": 1}


def as_settings(changes):
    """For desert_run."""
    texts = {name: str(value).lower() if isinstance(value, bool) else str(value) for name, value in changes.items()}
    return [word for name, text in texts.items() for word in ("--set", name.replace("__", ".") + "=" + text)]


class Reconfigure(Scenarios):
    def client(self, name, **private):
        node = self.start(name, dict({"scenario": CORNER, "status_rate": 20}, **private))
        return node, Client("/" + name, timeout=60 * PATIENCE)

    def values(self, node):
        """The present ones, which the node answers with."""
        config = node.call("set_parameters", ReconfigureService).config
        return {p.name: p.value for kind in (config.bools, config.ints, config.strs, config.doubles) for p in kind}

    def shows(self, client, name, value):
        """Waits until the client of dynamic_reconfigure has heard of a value; all that it has heard of."""
        wait_until(lambda: client.get_configuration(timeout=60 * PATIENCE)[name] == value, "%s = %s" % (name, value))
        return client.get_configuration()

    def refused(self, node, client, changes, text):
        before = node.call("step", Step, 0).state_hash, self.values(node)
        with self.assertRaises(DynamicReconfigureCallbackException):
            client.update_configuration(changes)
        self.assertEqual((node.call("step", Step, 0).state_hash, self.values(node)), before)
        wait_until(lambda: text in node.output, text)

    def wind(self, node):
        return node.latest("status", SimulationStatus).wind_above.x

    def test_description_is_the_parameter_table(self):
        _, client = self.client("described")
        found = {p["name"]: p for p in client.get_parameter_descriptions(timeout=60 * PATIENCE)}
        speed = found["wind__speed"]
        self.assertEqual((speed["type"], speed["min"], speed["max"], speed["default"]), ("double", 0, 100, 5))
        self.assertIn("[m/s]", speed["description"])
        choices = [c["value"] for c in eval(found["avalanching__quality"]["edit_method"])["enum"]]
        self.assertEqual(choices, ["fast", "good", "converged"])
        self.assertEqual(found["wind_shadow__enabled"]["type"], "bool")
        self.assertEqual(found["avalanching__sweeps"]["type"], "int")
        for fixed in ("grid__width", "run__steps", "seed"):
            self.assertNotIn(fixed, found)
        groups = client.get_group_descriptions()["groups"]
        self.assertIn("wind", groups)
        self.assertIn("lift", [p["name"].split("__")[1] for p in groups["saltation"]["parameters"]])

    def test_changed_live_is_as_if_started_so(self):
        node, client = self.client("changed")
        before = self.values(node)
        after = client.update_configuration(dict(CHANGES))
        for name, value in CHANGES.items():
            self.assertNotEqual(before[name], value, name)
            self.assertEqual(after[name], value, name)
        live = node.call("step", Step, 12).state_hash
        self.assertEqual(live, self.run_without_ros(CORNER, "--steps", "12", *as_settings(CHANGES)))
        self.assertNotEqual(live, self.run_without_ros(CORNER, "--steps", "12"))

    def test_refused_changes_nothing(self):
        node, client = self.client("refusing")
        shown = Listener("/refusing/parameter_updates", Config)
        shown.first("the present values")
        self.refused(node, client, {"wind__speed": 6.0, "saltation__lift": -1.0}, "saltation.lift: -1 is not in [0, 10] m")
        self.refused(node, client, {"saltation__lift": float("nan")}, "saltation.lift: .nan")
        self.refused(node, client, {"avalanching__quality": "best"}, "'best' is not one of: fast, good, converged")
        self.refused(node, client, {"wind__radii": "[1, 2, 3, 4, 5]"}, "wind.radii: must be a list of 1 to 4 numbers")
        self.refused(node, client, {"wind_shadow__start_deg": 80.0}, "wind_shadow.full_deg: must not be below start_deg")
        self.refused(node, client, {"wind_shadow__distance": 1000.0, "wind__regime": "rose"}, "needs at least one segment")
        client.update_configuration({"wind__speed": 6.5})
        with shown:
            shown.wait_for(lambda m: DoubleParameter("wind__speed", 6.5) in m.doubles, "what is not refused")
            for values in shown.messages[:-1]:
                self.assertEqual(values, shown.messages[0], "nothing that was refused is shown")

    def test_step_rate(self):
        """By a clock that the test moves: it shows at which rate steps are made."""
        rospy.set_param("/use_sim_time", True)
        self.addCleanup(rospy.set_param, "/use_sim_time", False)
        clock = ScriptedClock()
        self.addCleanup(clock.close)
        node, client = self.client("paced", paused=False, step_rate=2, status_rate=100)
        status = Listener("/paced/status", SimulationStatus)
        self.addCleanup(status.close)

        def makes(steps, rate, seconds):
            """So many steps until then, and no more: the next statuses say the same."""
            clock.show(seconds)
            status.wait_for(lambda m: m.step >= steps, "%d steps" % steps)
            seen = len(status.messages)
            last = status.wait_for(lambda m: len(status.messages) >= seen + 2, "a status")
            self.assertEqual((last.step, last.step_rate), (steps, rate))

        makes(1, 2, 1000)
        self.assertEqual(self.values(node)["step_rate"], 2)
        makes(3, 2, 1001)
        self.assertEqual(client.update_configuration({"step_rate": 16.0})["step_rate"], 16)
        makes(19, 16, 1002)
        rospy.set_param("/paced/step_rate", 32)
        self.assertIn("applied: step_rate=32", node.call("reload_parameters", Trigger).message)
        makes(51, 32, 1003)
        self.assertTrue(node.call("pause", Trigger).success)
        self.shows(client, "step_rate", 32)
        self.refused(node, client, {"step_rate": -1.0, "wind__speed": 6.0}, "step_rate: -1 is not in [0, 1e+06] steps/s")

    def test_publishers(self):
        node, client = self.client("published", paused=False, step_rate=50, keyframe_rate=0.001, local_map_length_x=8.0)
        description = {p["name"]: p for p in client.get_parameter_descriptions(timeout=60 * PATIENCE)}
        self.assertEqual([description["update_threshold"][key] for key in ("type", "min", "max", "default")],
                         ["double", 0, 1000, 0.005])
        publishers = client.get_group_descriptions()["groups"]["publishers"]["parameters"]
        self.assertIn("costmap_update_threshold", [p["name"] for p in publishers])
        keyframes, clouds = [], []
        rospy.Subscriber("/published/elevation", ElevationGrid, keyframes.append)
        rospy.Subscriber("/published/points", PointCloud2, clouds.append)
        wait_until(lambda: keyframes and clouds, "the present state")
        after = client.update_configuration({"keyframe_rate": 20.0, "points_count": 100, "robot_frame": "/rover"})
        self.assertEqual((after["keyframe_rate"], after["points_count"], after["robot_frame"]), (20, 100, "rover"))
        seen = len(keyframes)
        wait_until(lambda: len(keyframes) > seen + 10, "keyframes at the new rate")
        wait_until(lambda: clouds[-1].width * clouds[-1].height <= 100, "fewer points")
        for changes, text in (({"keyframe_rate": -2.0, "points_count": 7}, "keyframe_rate: -2 is not in [0, 1000] Hz"),
                              ({"update_threshold": float("nan")}, "update_threshold: .nan"),
                              ({"robot_frame": "no frame"}, "'no frame' is not a valid frame name"),
                              ({"grid_map_length_x": 4.0}, "grid_map_length_y must both be 0"),
                              ({"local_map_length_x": 1e6, "local_map_length_y": 1e6},
                               "are too many (allowed: at most 67108864 values)")):
            before = self.values(node)
            with self.assertRaises(DynamicReconfigureCallbackException):
                client.update_configuration(changes)
            self.assertEqual(self.values(node), before)
            wait_until(lambda: text in node.output, text)  # noqa: B023

    def test_what_cannot_change_is_refused_by_name(self):
        node, client = self.client("fixed")
        client.get_parameter_descriptions(timeout=60 * PATIENCE)
        for name, text in (("grid__width", "grid.width: cannot change while the simulation runs: the layers"),
                           ("nothing__such", "nothing.such: unknown parameter")):
            client._param_types[name] = int  # the client itself would not send it
            client.param_description.append({"name": name, "edit_method": ""})
            self.refused(node, client, {name: 32}, text)

    def test_journal_replays_and_a_reset_brings_the_start_back(self):
        journal = self.path("journal.yaml")
        node, client = self.client("journalled", journal=journal)
        start, first = self.values(node), client.get_configuration(timeout=60 * PATIENCE)
        node.call("step", Step, 4)
        client.update_configuration(dict(CHANGES))
        node.call("step", Step, 3)
        self.shows(client, "saltation__lift", CHANGES["saltation__lift"])
        self.assertTrue(node.call("reset", Trigger).success)
        self.assertEqual(self.values(node), start)
        wait_until(lambda: client.get_configuration() == first, "the client has not heard of the reset")
        client.update_configuration({"wind__direction_deg": 77.7, "saltation__lift": 0.123})
        live = node.call("step", Step, 5).state_hash
        self.assertEqual(node.end()[0], 0)
        self.assertEqual(self.run_without_ros(CORNER, "--replay", journal), live)

    def test_other_commands_show(self):
        node, client = self.client("shown")
        self.assertTrue(node.call("set_wind", SetWind, speed=9.5, direction_deg=-45).success)
        self.assertEqual(self.shows(client, "wind__speed", 9.5)["wind__direction_deg"], -45)
        client.update_configuration({"wind__speed": 4.0})
        self.assertEqual(self.shows(client, "wind__speed", 4)["wind__direction_deg"], -45, "the rest of the wind stays")

    def test_a_killed_node_keeps_them(self):
        private = {"autosave_period": 0.02, "resume": True, "data_dir": self.folder}
        node, client = self.client("kept", **private)
        client.update_configuration({"saltation__lift": 0.321})
        node.call("step", Step, 1)
        wait_until(lambda: 1 in saved_steps(self.folder), "no autosave of step 1")
        node.end(signal.SIGKILL)
        again, _ = self.client("kept", **private)
        self.assertEqual(self.values(again)["saltation__lift"], 0.321)

    def test_many_at_once_while_it_runs(self):
        node, client = self.client("busy", paused=False, step_rate=0)
        client.get_configuration(timeout=60 * PATIENCE)
        failures = []

        def change(names):
            try:
                service = rospy.ServiceProxy("/busy/set_parameters", ReconfigureService)
                for n in range(1, 21):
                    request = ReconfigureService._request_class()
                    request.config.doubles = [DoubleParameter(name, n / 20.0) for name in names]
                    service(request)
            except Exception as e:  # the test fails below, not in this thread
                failures.append(e)

        threads = [threading.Thread(target=change, args=(names,)) for names in
                   (["saltation__lift"], ["saltation__bounce_on_sand"], ["reptation__strength"], ["avalanching__transfer"])]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(60 * PATIENCE)
            self.assertFalse(thread.is_alive(), "its calls are not answered")
        self.assertEqual(failures, [])
        status = node.latest("status", SimulationStatus)
        self.assertEqual(status.state, "running")
        self.assertEqual([v.residual for v in status.volumes], [0] * len(status.volumes))
        service = rospy.ServiceProxy("/busy/set_parameters", ReconfigureService)
        now = {p.name: p.value for p in service(ReconfigureService._request_class()).config.doubles}
        self.assertEqual((now["saltation__lift"], now["reptation__strength"]), (1, 1))

    # ---- ~reload_parameters --------------------------------------------------------------------

    def test_reload_applies_what_is_live_and_names_the_rest(self):
        node, client = self.client("reloaded")
        rospy.set_param("/reloaded/wind", {"speed": 8.5})
        rospy.set_param("/reloaded/grid", {"width": 32})
        rospy.set_param("/reloaded/update_rate", 3.0)
        rospy.set_param("/reloaded/grid_map_layers", ["slope"])
        rospy.set_param("/reloaded/threads", 2)
        client.update_configuration({"keyframe_rate": 7.0})
        for applied in ("applied: wind.speed=8.5, update_rate=3, grid_map_layers=[slope]",
                        "no parameter that can change live differs"):
            answer = node.call("reload_parameters", Trigger)
            self.assertTrue(answer.success, answer.message)
            self.assertIn(applied, answer.message)
            self.assertIn("these need a restart of the node: grid.width=32, threads=2", answer.message)
        self.assertEqual(self.wind(node), 8.5)
        self.assertEqual(self.shows(client, "update_rate", 3)["keyframe_rate"], 7, "what no file changed stays")
        with Listener("/reloaded/grid_map") as maps:
            self.assertEqual(maps.first().layers, ["slope"])

    def test_reload_leaves_what_did_not_change_in_the_files(self):
        node, _ = self.client("partly")
        self.assertTrue(node.call("set_wind", SetWind, speed=9.5).success)
        rospy.set_param("/partly/saltation", {"lift": 0.75})
        self.assertIn("applied: saltation.lift=0.75", node.call("reload_parameters", Trigger).message)
        self.assertEqual(self.wind(node), 9.5)

    def test_reload_of_bad_input_changes_nothing(self):
        node, _ = self.client("unmoved")
        before = self.values(node)
        rospy.set_param("/unmoved/wind", {"speed": 8.5})
        rospy.set_param("/unmoved/saltation", {"lift": -3})
        answer = node.call("reload_parameters", Trigger)
        self.assertFalse(answer.success)
        self.assertIn("saltation.lift", answer.message)
        self.assertIn("[0, 10] m", answer.message)
        self.assertEqual(self.values(node), before)


if __name__ == "__main__":
    rospy.init_node("reconfigure", disable_signals=True)
    rostest.rosrun("desert_sim", "reconfigure", Reconfigure)
