#!/usr/bin/env python3
"""Starts and ends nodes: parameters, refused input, shutdown, failure, journal and replay."""
import http.client
import resource
import signal
import socket
import threading
import urllib.parse
import xmlrpc.client

from desert_sim.msg import ElevationGrid, SimulationStatus, WindScheduleSegment
from desert_sim.srv import EditTerrain, EditTerrainRequest, LoadCheckpoint, SaveCheckpoint
from desert_sim.srv import SetWind, SetWindSchedule, SetWindScheduleRequest, Step
from desert_sim.testing import PATIENCE, wait_until
from geometry_msgs.msg import Point
from node_tests import CORNER, Scenarios, held
import rosgraph
from rosgraph_msgs.msg import Clock
import rospy
import rostest
from sensor_msgs.msg import Image
from std_srvs.srv import Trigger


class Lifecycle(Scenarios):
    # ---- refused input -------------------------------------------------------------------------

    def expect_refused(self, *cases):
        """Nodes with these parameters all end, and what they print has these texts."""
        nodes = [self.start("refused_%d" % n, private) for n, (private, *_) in enumerate(cases)]
        for node, (private, *texts) in zip(nodes, cases):
            status, output = node.wait()
            self.assertEqual(status, 2, output)
            for text in texts:
                self.assertIn(text, output, private)

    def test_bad_input_is_named(self):
        bad = self.path("bad.yaml", "grid: {width: -3, cel_size: 1}\nwind: {speed: .nan}\n")
        self.expect_refused(
            ({"scenario": bad}, "bad.yaml", "grid.width", "-3", "[1, 65536]", "cel_size", "wind.speed", "nan"),
            ({"scenario": "no_such_desert"}, "no_such_desert", "barchan"),
            ({}, "no scenario"),
            ({"scenario": CORNER, "step_rate": -1, "bakend": "cpu", "update_tile": 0.5, "backend": "tpu"},
             "step_rate", "-1", "bakend: unknown parameter", "update_tile", "'tpu'", "auto, cpu, cuda"),
            ({"scenario": "barchan", "settings": "[grid.width=48, "}, "settings", "[grid.width=48", "is not a list"),
            ({"scenario": "barchan", "settings": "[[grid.width=48]]"}, "settings.0", "a list"))

    def test_bad_maps_are_refused_at_the_start(self):
        self.expect_refused(
            ({"scenario": CORNER, "grid_map_layers": ["elevation", "lava"], "local_map_layers": [],
              "grid_map_length_x": 10.0, "robot_frame": ""},
             "grid_map_layers: 'lava' is not one of: elevation, bedrock", "normal_z",
             "local_map_layers: an empty list where a list of layers", "grid_map_length_y", "robot_frame"),
            ({"scenario": CORNER, "local_map_length_x": 1e6, "local_map_length_y": 1e6},
             "local_map_length_x and local_map_length_y: 500000 x 500000 cells", "67108864"))

    def test_cuda_without_a_device_is_refused_or_taken(self):
        node = self.start("wants_cuda", {"scenario": CORNER, "backend": "cuda"})
        statuses = []
        rospy.Subscriber("/wants_cuda/status", SimulationStatus, statuses.append)
        wait_until(lambda: statuses or not node.running, "it neither says anything nor ends")
        if statuses:
            self.assertEqual(statuses[0].backend, "cuda")
            return
        status, output = node.wait()
        self.assertEqual(status, 2, output)
        self.assertIn("cuda", output.lower())

    def test_a_second_clock_is_refused(self):
        clock = rospy.Publisher("/clock", Clock, queue_size=1)
        try:
            self.expect_refused(({"scenario": CORNER, "publish_clock": True}, "publish_clock", "/lifecycle",
                                 "already publishes /clock"))
        finally:
            clock.unregister()

    # ---- scenarios -----------------------------------------------------------------------------

    def test_bare_name_is_a_scenario_of_the_package(self):
        node = self.start("named", {"scenario": "barchan", "settings": ["grid.width=48", "grid.height=32"]})
        grid = node.latest("elevation", ElevationGrid)
        self.assertEqual((grid.width, grid.height), (48, 32))
        self.assertEqual(node.latest("status", SimulationStatus).scenario, "barchan")

    def test_settings_are_a_list_or_its_text(self):
        text = "[grid.width=48, grid.height=32]"
        nodes = [self.start("set", {"scenario": "barchan", "settings": ["grid.width=48", "grid.height=32"]}),
                 self.start("set_by_text", {"scenario": "barchan", "settings": text}),
                 self.start("set_by_hand", {"scenario": "barchan"}, arguments=["_settings:=" + text])]
        for node in nodes:
            grid = node.latest("elevation", ElevationGrid)
            self.assertEqual((grid.width, grid.height), (48, 32))

    def test_scenario_of_parameters(self):
        node = self.start("in_parameters", {
            "grid": {"width": 40, "height": 24, "cell_size": 0.5},
            "terrain": [{"uniform": {"layer": "sand", "value": 3}}],
            "wind": {"speed": 7.5}})
        grid = node.latest("elevation", ElevationGrid)
        self.assertEqual((grid.width, grid.height, grid.cell_size), (40, 24, 0.5))
        self.assertAlmostEqual(grid.elevation[0], 3, places=5)
        self.assertAlmostEqual(node.latest("status", SimulationStatus).wind_above.x, 7.5, places=5)

    def test_parameters_override_keys_of_a_file(self):
        node = self.start("overridden", {"scenario": CORNER, "grid": {"width": 32}, "wind": {"speed": 3}})
        grid = node.latest("elevation", ElevationGrid)
        self.assertEqual((grid.width, grid.height), (32, 48))
        self.assertAlmostEqual(node.latest("status", SimulationStatus).wind_above.x, 3)

    def test_script_does_what_it_does_without_ros(self):
        """Commands and parameters at a time, which ~status announces; a wrong one is named."""
        script = self.path("script.yaml", "- {time: 2, command: edit_terrain, x: 60, y: 10, radius: 9, value: 1.5}\n"
                                          "- {time: 4, every: 3, command: set_wind, speed: 7, direction_deg: 40}\n"
                                          "- {time: 5, set: {saltation.lift: 0.4}}\n")
        node = self.start("scripted", {"scenario": CORNER, "script": script})
        self.assertIn("at 2 s: edit_terrain", node.latest("status", SimulationStatus).changes)
        live = node.call("step", Step, 12).state_hash
        self.assertEqual(self.run_without_ros(CORNER, "--script", script, "--steps", "12"), live)
        self.assertNotEqual(self.run_without_ros(CORNER, "--steps", "12"), live)
        wrong = self.path("wrong.yaml", "- {time: 2, command: edit_terrain, layer: lava}\n")
        self.expect_refused(({"scenario": CORNER, "script": wrong}, "at 2 s", "edit_terrain", "'lava'"),
                            ({"scenario": CORNER, "script": "missing.yaml"}, "missing.yaml"))

    # ---- clients -------------------------------------------------------------------------------

    def test_clients_wait_for_a_node_that_stands_still(self):
        """More connect to its XML-RPC server than the backlog of roscpp lets wait."""
        node = self.start("still", {"scenario": CORNER})
        node.latest("status", SimulationStatus)
        address = urllib.parse.urlsplit(rosgraph.Master("/lifecycle").lookupNode("/still"))
        with held(node.process):
            waiting = [socket.create_connection((address.hostname, address.port), timeout=20 * PATIENCE) for _ in range(64)]
        for connection in waiting:
            client = http.client.HTTPConnection(address.netloc)
            client.sock = connection
            client.request("POST", "/RPC2", xmlrpc.client.dumps(("/lifecycle",), "getPid"), {"Content-Type": "text/xml"})
            (code, _, pid), = xmlrpc.client.loads(client.getresponse().read())[0]
            self.assertEqual((code, pid), (1, node.process.pid))
            client.close()

    def test_another_node_of_its_name_ends_a_node_that_starts(self):
        """What is advertised while ROS shuts down is no publisher, and roscpp would end who publishes by it."""
        master = rosgraph.Master("/lifecycle")

        def is_known(name):
            try:
                return master.lookupNode(name)
            except rosgraph.MasterError:
                return None

        for program, private in (("desert_sim_node", {"scenario": CORNER}), ("desert_rover_node", {}), ("desert_planner_node", {})):
            first = self.of_program("twice", private, program)
            wait_until(lambda: is_known("/twice"), "the master knows the node")
            second = self.of_program("twice", private, program)
            status, output = first.wait()
            self.assertEqual(status, 0, output)
            self.assertEqual(second.end()[0], 0, second.output)

    # ---- shutdown and failure ------------------------------------------------------------------

    def test_ends_while_it_runs_and_serves(self):
        """Neither the run nor what it serves would end by itself."""
        node = self.start("ending", {"scenario": CORNER, "step_rate": 0, "status_rate": 100})
        statuses = []
        rospy.Subscriber("/ending/status", SimulationStatus, statuses.append)
        wait_until(lambda: statuses, "no status")
        answers = []

        def wait_for_steps():
            try:
                answers.append(node.call("step", Step, 4000000000))
            except rospy.ServiceException as e:  # the connection was closed before the answer came
                answers.append(e)

        client = threading.Thread(target=wait_for_steps)
        client.start()
        wait_until(lambda: statuses[-1].step > 0, "it does not serve")  # and nothing else makes steps
        self.assertTrue(node.call("resume", Trigger).success)
        wait_until(lambda: statuses[-1].state == "running", "it does not run")
        self.assertEqual(answers, [])
        self.assertEqual(node.end()[0], 0, node.output)
        client.join(60 * PATIENCE)
        self.assertEqual(len(answers), 1, "the client that waits is let go")

    def test_failure_is_told_and_ends_the_node(self):
        # A journal that cannot be written to its end: once it runs, the process may not write files larger than this.
        node = self.start("failing", {"scenario": CORNER, "journal": self.path("journal.yaml")},
                          preexec=lambda: signal.signal(signal.SIGXFSZ, signal.SIG_IGN))
        told = []
        rospy.Subscriber("/failing/status", SimulationStatus, told.append)
        wait_until(lambda: told, "no status")
        resource.prlimit(node.process.pid, resource.RLIMIT_FSIZE, (400, 400))
        for speed in range(20):
            try:
                if not node.call("set_wind", SetWind, speed=speed).success:
                    break
            except rospy.ServiceException:
                break
        status, output = node.wait()
        self.assertEqual(status, 3, output)
        self.assertIn("journal", output)
        wait_until(lambda: told[-1].state == "error", "subscribers are not told")
        self.assertIn("journal", told[-1].message)

    # ---- journal -------------------------------------------------------------------------------

    def drive(self, node):
        """Some of everything that is journalled; the state hash at the end."""
        brush = EditTerrainRequest(layer="sand", shape="circle", merge="add", radius=9, inner=0.3, value=1.7)
        brush.center.x, brush.center.y = 61.3, 12.9
        gusts = SetWindScheduleRequest(kind="timeline", repeat=True, segments=[
            WindScheduleSegment(direction_deg=40, speed=6, duration=4, ramp=2), WindScheduleSegment(speed=3, duration=3)])
        node.call("step", Step, 5)
        self.assertTrue(node.call("set_wind", SetWind, speed=7.3, direction_deg=-33.3, ramp=4).success)
        node.call("step", Step, 4)
        self.assertTrue(node.call("edit_terrain", EditTerrain, brush).success)
        self.assertFalse(node.call("edit_terrain", EditTerrain, layer="lava").success)
        levelled = EditTerrainRequest(layer="sand", shape="polygon", merge="smooth", smooth_radius=5, smooth_passes=2,
                                      falloff=3, conserve=True, ring_width=8,
                                      points=[Point(100.1, -15.3, 0), Point(131.7, -12.9, 0), Point(117.3, 11.1, 0)])
        self.assertTrue(node.call("edit_terrain", EditTerrain, levelled).success)
        stamp = EditTerrainRequest(layer="bedrock", shape="patch", merge="add", radius=11.3, radius_y=7, angle_deg=23,
                                   image=Image(width=3, height=2, step=3, encoding="mono8", data=bytes(range(0, 240, 40))),
                                   image_scale=1.9)
        stamp.center.x, stamp.center.y = 40.7, 30.1
        self.assertTrue(node.call("edit_terrain", EditTerrain, stamp).success)
        node.call("step", Step, 3)
        self.assertTrue(node.call("save_checkpoint", SaveCheckpoint, "middle.ckpt").success)
        self.assertTrue(node.call("set_wind_schedule", SetWindSchedule, gusts).success)
        node.call("step", Step, 6)
        self.assertTrue(node.call("reset", Trigger).success)
        node.call("step", Step, 2)
        self.assertTrue(node.call("load_checkpoint", LoadCheckpoint, "middle.ckpt").success)
        return node.call("step", Step, 7).state_hash

    def replay(self, journal):
        return self.run_without_ros(CORNER, "--replay", journal)

    def test_journal_replays_to_the_same_hash(self):
        journal = self.path("made/for/it/journal.yaml")
        node = self.start("journalled", {"scenario": CORNER, "journal": journal, "data_dir": self.folder})
        live = self.drive(node)
        self.assertEqual(node.end()[0], 0)
        self.assertEqual(self.replay(journal), live)

    def test_journal_of_a_running_node_replays_too(self):
        journal = self.path("journal.yaml")
        node = self.start("journalled", {"scenario": CORNER, "journal": journal, "paused": False, "step_rate": 200})
        for speed in range(1, 9):
            self.assertTrue(node.call("set_wind", SetWind, speed=speed, direction_deg=20 * speed).success)
            reached = node.call("step", Step, 0).step
            wait_until(lambda: node.call("step", Step, 0).step > reached, "no steps")  # noqa: B023
        self.assertTrue(node.call("pause", Trigger).success)
        live = node.call("step", Step, 0).state_hash
        self.assertEqual(node.end()[0], 0)
        self.assertEqual(self.replay(journal), live)

    def test_a_killed_node_leaves_its_journal_and_starts_anew(self):
        journal = self.path("journal.yaml")
        setup = {"scenario": CORNER, "journal": journal, "data_dir": self.folder}
        node = self.start("killed", setup)
        self.drive(node)
        at_load = node.call("load_checkpoint", LoadCheckpoint, "middle.ckpt").state_hash
        node.end(signal.SIGKILL)
        again = self.start("killed", setup)
        self.assertEqual(again.latest("status", SimulationStatus).step, 0)
        self.assertEqual(again.end()[0], 0)
        # The journal of the first ends with its last command.
        self.assertEqual(self.replay(journal + ".previous"), at_load)


if __name__ == "__main__":
    rospy.init_node("lifecycle", disable_signals=True)
    rostest.rosrun("desert_sim", "lifecycle", Lifecycle)
