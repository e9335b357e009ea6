#!/usr/bin/env python3
"""Parameters of a live node: dynamic_reconfigure with its own clients, and ~reload_parameters."""
import signal
import threading
import time

from desert_sim.msg import ElevationGrid, SimulationStatus
from desert_sim.srv import SetWind, Step
from desert_sim.testing import PATIENCE, wait_until
from dynamic_reconfigure.client import Client
from dynamic_reconfigure.msg import DoubleParameter
from dynamic_reconfigure.srv import Reconfigure as ReconfigureService
from map_client import Listener
from node_tests import CORNER, Scenarios, saved_steps
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

    def values(self, client):
        return {name: value for name, value in client.get_configuration(timeout=60 * PATIENCE).items() if name != "groups"}

    def refused(self, node, client, changes, text):
        before = node.call("step", Step, 0).state_hash, self.values(client)
        with self.assertRaises(Exception):
            client.update_configuration(changes)
        self.assertEqual((node.call("step", Step, 0).state_hash, self.values(client)), before)
        end = time.monotonic() + 5 * PATIENCE
        while text not in node.output and time.monotonic() < end:
            time.sleep(0.05)
        self.assertIn(text, node.output)

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
        before = self.values(client)
        after = client.update_configuration(dict(CHANGES))
        for name, value in CHANGES.items():
            self.assertNotEqual(before[name], value, name)
            self.assertEqual(after[name], value, name)
        live = node.call("step", Step, 12).state_hash
        self.assertEqual(live, self.run_without_ros(CORNER, "--steps", "12", *as_settings(CHANGES)))
        self.assertNotEqual(live, self.run_without_ros(CORNER, "--steps", "12"))

    def test_refused_changes_nothing(self):
        node, client = self.client("refusing")
        self.refused(node, client, {"wind__speed": 6.0, "saltation__lift": -1.0}, "saltation.lift: = -1 is not in [0, 10] m")
        self.refused(node, client, {"saltation__lift": float("nan")}, "saltation.lift: = .nan")
        self.refused(node, client, {"avalanching__quality": "best"}, "'best' is not one of: fast, good, converged")
        self.refused(node, client, {"wind__radii": "[1, 2, 3, 4, 5]"}, "wind.radii: must be a list of 1 to 4 numbers")
        self.refused(node, client, {"wind_shadow__start_deg": 80.0}, "wind_shadow.full_deg: must not be below start_deg")
        self.refused(node, client, {"wind_shadow__distance": 1000.0, "wind__regime": "rose"}, "needs at least one segment")

    def test_step_rate(self):
        node, client = self.client("paced", paused=False, step_rate=2)
        self.assertEqual(self.values(client)["step_rate"], 2)
        self.assertEqual(client.update_configuration({"step_rate": 12.0})["step_rate"], 12)
        end = time.monotonic() + 60 * PATIENCE  # a busy machine may not make all of the 12
        while not 6 < node.latest("status", SimulationStatus).steps_per_second < 18 and time.monotonic() < end:
            pass
        status = node.latest("status", SimulationStatus)
        self.assertTrue(6 < status.steps_per_second < 18, status.steps_per_second)
        self.assertEqual(status.step_rate, 12)
        rospy.set_param("/paced/step_rate", 15)
        self.assertIn("applied: step_rate=15", node.call("reload_parameters", Trigger).message)
        self.assertEqual(node.latest("status", SimulationStatus).step_rate, 15)
        self.assertTrue(node.call("pause", Trigger).success)
        end = time.monotonic() + 60 * PATIENCE  # the client hears of it by a message
        while self.values(client)["step_rate"] != 15 and time.monotonic() < end:
            time.sleep(0.05)
        self.refused(node, client, {"step_rate": -1.0, "wind__speed": 6.0}, "step_rate: = -1 is not in [0, 1e+06] steps/s")

    def test_publishers(self):
        node, client = self.client("published", paused=False, step_rate=50, keyframe_rate=0.02, local_map_length_x=8.0)
        description = {p["name"]: p for p in client.get_parameter_descriptions(timeout=60 * PATIENCE)}
        self.assertEqual([description["update_threshold"][key] for key in ("type", "min", "max", "default")],
                         ["double", 0, 1000, 0.005])
        publishers = client.get_group_descriptions()["groups"]["publishers"]["parameters"]
        self.assertIn("costmap_update_threshold", [p["name"] for p in publishers])
        keyframes, clouds = [], []
        rospy.Subscriber("/published/elevation", ElevationGrid, keyframes.append)
        rospy.Subscriber("/published/points", PointCloud2, clouds.append)
        self.wait_for(lambda: keyframes and clouds, "the present state")
        after = client.update_configuration({"keyframe_rate": 20.0, "points_count": 100, "robot_frame": "/rover"})
        self.assertEqual((after["keyframe_rate"], after["points_count"], after["robot_frame"]), (20, 100, "rover"))
        seen = len(keyframes)
        self.wait_for(lambda: len(keyframes) > seen + 10, "keyframes at the new rate")
        self.wait_for(lambda: clouds[-1].width * clouds[-1].height <= 100, "fewer points")
        for changes, text in (({"keyframe_rate": -2.0, "points_count": 7}, "keyframe_rate: = -2 is not in [0, 1000] Hz"),
                              ({"update_threshold": float("nan")}, "update_threshold: = .nan"),
                              ({"robot_frame": "no frame"}, "'no frame' is not a valid frame name"),
                              ({"grid_map_length_x": 4.0}, "grid_map_length_y must both be 0"),
                              ({"local_map_length_x": 1e6, "local_map_length_y": 1e6}, "are too many (allowed: at most 67108864 values)")):
            before = self.values(client)
            with self.assertRaises(Exception):
                client.update_configuration(changes)
            self.assertEqual(self.values(client), before)
            self.wait_for(lambda: text in node.output, text)  # noqa: B023 it is called at once

    def wait_for(self, happened, what):
        end = time.monotonic() + 60 * PATIENCE
        while not happened():
            self.assertLess(time.monotonic(), end, what)
            time.sleep(0.02)

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
        start = self.values(client)
        node.call("step", Step, 4)
        client.update_configuration(dict(CHANGES))
        node.call("step", Step, 3)
        self.assertTrue(node.call("reset", Trigger).success)
        end = time.monotonic() + 5 * PATIENCE
        while self.values(client) != start and time.monotonic() < end:
            time.sleep(0.05)
        self.assertEqual(self.values(client), start)
        client.update_configuration({"wind__direction_deg": 77.7, "saltation__lift": 0.123})
        live = node.call("step", Step, 5).state_hash
        self.assertEqual(node.end()[0], 0)
        self.assertEqual(self.run_without_ros(CORNER, "--replay", journal), live)

    def test_other_commands_show(self):
        node, client = self.client("shown")
        self.assertTrue(node.call("set_wind", SetWind, speed=9.5, direction_deg=-45).success)
        end = time.monotonic() + 5 * PATIENCE
        while self.values(client)["wind__speed"] != 9.5 and time.monotonic() < end:
            time.sleep(0.05)
        values = self.values(client)
        self.assertEqual((values["wind__speed"], values["wind__direction_deg"]), (9.5, -45))
        client.update_configuration({"wind__speed": 4.0})
        self.assertEqual(self.values(client)["wind__direction_deg"], -45, "the rest of the wind stays")

    def test_a_killed_node_keeps_them(self):
        private = {"autosave_period": 0.1, "resume": True, "data_dir": self.folder}
        node, client = self.client("kept", **private)
        client.update_configuration({"saltation__lift": 0.321})
        node.call("step", Step, 1)
        wait_until(lambda: 1 in saved_steps(self.folder), "no autosave of step 1")
        node.end(signal.SIGKILL)
        _, again = self.client("kept", **private)
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
            thread.join(60)
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
        self.wait_for(lambda: self.values(client)["update_rate"] == 3, "shown")
        self.assertEqual(self.values(client)["keyframe_rate"], 7, "what no file changed stays")
        with Listener("/reloaded/grid_map") as maps:
            self.assertEqual(maps.first().layers, ["slope"])

    def test_reload_leaves_what_did_not_change_in_the_files(self):
        node, _ = self.client("partly")
        self.assertTrue(node.call("set_wind", SetWind, speed=9.5).success)
        rospy.set_param("/partly/saltation", {"lift": 0.75})
        self.assertIn("applied: saltation.lift=0.75", node.call("reload_parameters", Trigger).message)
        self.assertEqual(self.wind(node), 9.5)

    def test_reload_of_bad_input_changes_nothing(self):
        node, client = self.client("unmoved")
        before = self.values(client)
        rospy.set_param("/unmoved/wind", {"speed": 8.5})
        rospy.set_param("/unmoved/saltation", {"lift": -3})
        answer = node.call("reload_parameters", Trigger)
        self.assertFalse(answer.success)
        self.assertIn("saltation.lift", answer.message)
        self.assertIn("[0, 10] m", answer.message)
        self.assertEqual(self.values(client), before)


if __name__ == "__main__":
    rospy.init_node("reconfigure", disable_signals=True)
    rostest.rosrun("desert_sim", "reconfigure", Reconfigure)
