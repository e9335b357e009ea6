#!/usr/bin/env python3
"""Random calls of every service and messages on every topic that a node listens to. Whatever is accepted can be repeated:
after each round, the checkpoint that is saved can be loaded and saved again as the same bytes, a saved terrain can be
loaded, and at the end the journal replays to the same state. DESERT_ROUNDS says how many rounds, of some calls each."""
import difflib
import os
import random
import re
import shutil

from actionlib_msgs.msg import GoalID
from desert_sim.msg import ForecastTerrainActionGoal, SimulationStatus
from desert_sim.srv import LoadCheckpoint, LoadTerrain, SaveCheckpoint, SaveTerrain, Step
from desert_sim.testing import wait_until
from dynamic_reconfigure.msg import BoolParameter, ConfigDescription, DoubleParameter, IntParameter, StrParameter
from geometry_msgs.msg import Point, Vector3Stamped
from map_client import GetGridMap
from node_tests import CORNER, OASIS, Scenarios
from random_messages import RandomMessages
import rosgraph
import rospy
import rosservice
import rostest
from std_msgs.msg import Empty, String
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage

ROUNDS = int(os.environ.get("DESERT_ROUNDS", "30"))
ROUNDS_OF_A_NODE = 100
NODE = "random"
SCENARIOS = {"oasis.yaml": OASIS, "corner.yaml": CORNER, "garden.yaml": os.path.join(os.path.dirname(OASIS), "garden.yaml")}
TOPICS = {"/%s/cmd_wind" % NODE: Vector3Stamped, "/%s/request_keyframe" % NODE: Empty, "/tf": TFMessage,
          "/tf_static": TFMessage, "/%s/layers/request_keyframe" % NODE: String, "/%s/forecast/goal" % NODE: ForecastTerrainActionGoal,
          "/%s/forecast/cancel" % NODE: GoalID}
WEIGHTS = {"edit_terrain": 6, "edit_plants": 5, "edit_wind": 3, "set_weather": 3, "set_parameters": 4, "step": 4,
           "undo": 3, "redo": 2}  # others: 1
OF_EVERY_NODE = {"get_loggers", "set_logger_level"}


def tidy(goal):
    """Leaves out of a forecast's goal what its members and its wind do not use."""
    if goal.members <= 1:
        goal.gust_speed = goal.gust_direction_deg = goal.gust_time = goal.seed = 0
    if goal.wind_kind == "constant" or not goal.wind:
        goal.wind = goal.wind[:1]
        goal.wind_kind = goal.wind_kind if goal.wind else ""
        goal.wind_repeat, goal.wind_hold_time, goal.wind_seed = False, 0, 0
    elif goal.wind_kind == "rose":
        goal.wind_repeat = False
    else:
        goal.wind_hold_time = goal.wind_seed = 0
    for segment in goal.wind:
        if goal.wind_kind != "timeline":
            segment.duration = 0
        if goal.wind_kind == "rose":
            segment.ramp = 0
        else:
            segment.probability = 0


def leave_out_unused(request, refusal):
    """Clears the field that a refusal names because nothing uses it; whether there is one."""
    found = re.search(r"([a-z_]+)(?:\[(\d+)\]\.([a-z_]+))?: is set, but ", refusal)
    if not found:
        return False
    name, index, member = found.groups()
    owner, name = (request, name) if index is None else (getattr(request, name)[int(index)], member)
    setattr(owner, name, type(getattr(owner, name))())
    return True


class Caller:
    """Calls the services of one node."""

    def __init__(self, node, draw, folder):
        self.node, self.draw, self.random, self.folder = node, draw, RandomMessages(draw), folder
        self.checkpoints, self.terrains, self.scenarios, self.saved = ["none.ckpt"], ["none"], [], 0
        self.accepted, self.refused, self.log = {}, {}, []
        self.winds, self.on_its_way = 0, False
        self.publishers = {topic: rospy.Publisher(topic, kind, queue_size=10, latch=False) for topic, kind in TOPICS.items()}
        self.description = node.latest("parameter_descriptions", ConfigDescription)
        rospy.wait_for_service("/%s/reload_parameters" % NODE)  # the last to be advertised
        prefix = "/%s/" % NODE
        names = [name[len(prefix):] for name in rosservice.get_service_list(node=prefix[:-1])]
        self.services = sorted(name for name in names if name not in OF_EVERY_NODE and "/" not in name)
        classes = {"get_grid_map": GetGridMap}
        self.proxies = {name: rospy.ServiceProxy(
            prefix + name, classes.get(name) or rosservice.get_service_class_by_name(prefix + name), persistent=True)
            for name in self.services}
        wait_until(lambda: all(p.get_num_connections() for p in self.publishers.values()), "the node does not listen")

    def close(self):
        for publisher in self.publishers.values():
            publisher.unregister()
        for proxy in self.proxies.values():
            proxy.close()

    def new_name(self):
        self.saved += 1
        return "saved_%d" % self.saved

    def request(self, service):
        request = self.random.filled(self.proxies[service].request_class())
        if service == "set_parameters":
            request.config = self.config(request.config)
        elif service == "load_scenario":
            request.name = self.draw.choice([*SCENARIOS, *self.scenarios, "none.yaml"])
            request.settings = self.settings()
        elif service == "apply_settings":
            request.settings = self.draw.sample(
                ["saltation.lift=0.7", "species.0.max_radius=0.8", "species.1.spawn=9", "species.0.stem=-1", "species=[]",
                 "species.2={preset: palm}", "vegetation.enabled=true", "grid.width=9"], self.draw.choice([1, 1, 2]))
            request.ramp = self.draw.choice([0, 0, 5, -1])
        elif service == "new_scenario":
            request.yaml = self.draw.choice(["grid: {width: 17, height: 12}\nterrain: [noise: {layer: sand, high: 2}]\n",
                                             "# \"a comment\"\nterrain:\n  - uniform: {layer: sand, value: 1}\n", "terrain: {"])
            request.settings = ["grid.height=14", "grid.width=18", *self.settings()]
            request.name = self.draw.choice(["", "text", "../text"])
        elif service == "load_checkpoint":
            request.name = self.draw.choice(self.checkpoints)
        elif service == "load_terrain":
            request.name = self.draw.choice(self.terrains)
        elif service in ("save_checkpoint", "save_scenario", "save_terrain"):
            request.name = self.draw.choice([self.new_name()] * 8 + ["..", "/tmp/x", "none.ckpt/x"])
        elif service in ("edit_terrain", "edit_plants"):
            count = {"capsule": 2, "polygon": self.draw.randrange(3, 6)}.get(request.shape, 0)
            request.points = [self.random.filled(Point()) for _ in range(count)] if not self.random.rarely() else []
        elif service == "reload_parameters":
            rospy.set_param("/%s/wind" % NODE, {"speed": self.draw.choice([3.0, 5.5, -1.0])})
        return request

    def settings(self):
        return self.draw.sample(["wind.speed=7.25", "saltation.lift=0.5", "wind.direction_deg=-400", "run.steps=12", "salt=1"],
                                self.draw.choice([0, 0, 0, 1, 2]))

    def config(self, config):
        """Some parameters at or between their limits."""
        config.bools, config.ints, config.strs, config.doubles, config.groups = [], [], [], [], []
        lists = ((self.description.min.doubles, self.description.max.doubles, config.doubles, DoubleParameter),
                 (self.description.min.ints, self.description.max.ints, config.ints, IntParameter))
        for _ in range(self.draw.randrange(1, 4)):
            lowest, highest, values, kind = self.draw.choice(lists)
            n = self.draw.randrange(len(lowest))
            low, high = lowest[n].value, highest[n].value
            value = self.draw.choice([low, high, low + self.draw.random() * (high - low), low + self.draw.random() * min(1, high - low)])
            if lowest[n].name == "step_rate":
                value = 20
            if lowest[n].name == "run__time_step":  # a step of many minutes takes as long as its parts do
                value = self.draw.choice([low, 0.3, 2])
            values.append(kind(lowest[n].name, int(value) if kind is IntParameter else value))
        if self.draw.random() < 0.3:
            config.bools.append(BoolParameter(self.draw.choice(self.description.dflt.bools).name, self.draw.random() < 0.5))
        parameters = [p for group in self.description.groups for p in group.parameters if p.type == "str" and p.edit_method]
        if self.draw.random() < 0.3:
            parameter = self.draw.choice(parameters)
            config.strs.append(StrParameter(parameter.name, self.draw.choice(re.findall(r"'value': '(\w*)'", parameter.edit_method))))
        return config

    def publish(self):
        topic = self.draw.choice(sorted(TOPICS))
        message = self.random.filled(TOPICS[topic]())
        if isinstance(message, ForecastTerrainActionGoal):
            message.goal_id.id = "goal %d" % len(self.log)  # actionlib overhears one that it knows
            message.goal.parameters = self.config(message.goal.parameters)
            if not self.random.rarely():
                tidy(message.goal)
        self.log.append("%s %s" % (topic, str(message)[:300]))
        self.publishers[topic].publish(message)
        self.on_its_way = self.on_its_way or isinstance(message, Vector3Stamped)

    def wait_for_winds(self):
        """Messages are not answered. Those on ~cmd_wind, which alone change the state, have been heard when one that was
        published after them blows."""
        if not self.on_its_way:
            return
        self.winds += 1
        last = Vector3Stamped()
        last.vector.x, last.vector.y = 2 + 0.01 * self.winds, 1
        self.publishers["/%s/cmd_wind" % NODE].publish(last)

        def blows():
            wind = self.node.latest("status", SimulationStatus).wind_above
            return abs(wind.x - last.vector.x) < 1e-3 and abs(wind.y - last.vector.y) < 1e-3

        wait_until(blows, "what was published at last on ~cmd_wind does not blow")
        self.on_its_way = False

    def call(self):
        """One random call; it is answered, or fails with the reason."""
        service = self.draw.choices(self.services, [WEIGHTS.get(name, 1) for name in self.services])[0]
        request = self.request(service)
        accepted, reason = self.answer(service, request)
        if not self.random.rarely():
            while leave_out_unused(request, reason):
                accepted, reason = self.answer(service, request)
        count = self.accepted if accepted else self.refused
        count[service] = count.get(service, 0) + 1
        if accepted and service == "save_checkpoint":
            self.checkpoints.append(request.name)
        if accepted and service == "save_scenario":
            self.scenarios.append(request.name)
        if accepted and service == "save_terrain":
            self.terrains.append(request.name)

    def answer(self, service, request):
        """Whether the request is accepted, and the reason if it is not."""
        self.log.append("%s %s" % (service, str(request)[:1500]))
        try:
            answer = self.proxies[service](request)
            accepted, reason = getattr(answer, "success", True), getattr(answer, "message", "")
        except rospy.ServiceException as e:
            assert service in ("set_parameters", "get_grid_map"), "%s: %s" % (service, e)
            accepted, reason = False, str(e)
            assert "transport error" not in reason, reason
            self.proxies[service].close()
            self.proxies[service] = rospy.ServiceProxy(self.proxies[service].resolved_name, self.proxies[service].service_class, persistent=True)
        assert accepted or reason, service
        assert len(reason) < 2200, reason
        self.log.append("  -> %s %s" % (accepted, reason[:200]))
        return accepted, reason


class RandomCalls(Scenarios):
    def file(self, name):
        with open(os.path.join(self.folder, name), "rb") as file:
            return file.read()

    def expect(self, answer, caller):
        self.assertTrue(answer.success, "%s\n%s" % (answer.message, "\n".join(caller.log[-30:])))
        return answer

    def expect_repeatable(self, node, caller):
        caller.wait_for_winds()  # or they could arrive between the calls
        self.expect(node.call("pause", Trigger), caller)
        name = caller.new_name()
        saved = self.expect(node.call("save_checkpoint", SaveCheckpoint, name), caller)
        loaded = self.expect(node.call("load_checkpoint", LoadCheckpoint, name), caller)
        again = self.expect(node.call("save_checkpoint", SaveCheckpoint, "again.ckpt"), caller)
        calls = "\n".join(caller.log[-30:])
        self.assertEqual((loaded.state_hash, again.state_hash), (saved.state_hash, saved.state_hash), calls)
        headers = [self.file(file)[:20000].split(b"\n...\n")[0].decode("ascii", "replace").split("\n") for file in (name, "again.ckpt")]
        different = "\n".join(difflib.unified_diff(*headers, lineterm="", n=0))
        self.assertTrue(self.file("again.ckpt") == self.file(name), "%s\n%s" % (different[:3000], calls))

    def expect_loadable_terrain(self, node, caller):
        name = caller.new_name()
        form = caller.draw.choice(["geotiff", "rosbag"])
        self.expect(node.call("save_terrain", SaveTerrain, name, form), caller)
        self.expect(node.call("load_terrain", LoadTerrain, name, False), caller)

    def drive(self, seed, rounds):
        """A node of its own; the counts of calls."""
        for name, path in SCENARIOS.items():
            shutil.copy(path, os.path.join(self.folder, name))
        journal = self.path("journal_%d" % seed)
        node = self.start(NODE, {"scenario": OASIS, "journal": journal, "data_dir": self.folder, "step_rate": 20})
        caller = Caller(node, random.Random(seed), self.folder)
        listened = {topic for topic, nodes in rosgraph.Master("/random_calls").getSystemState()[1] if "/" + NODE in nodes}
        self.assertEqual(listened - {"/clock"}, set(TOPICS), "a topic has no generator")
        self.assertEqual(self.without_generator(caller), set())
        for _ in range(rounds):
            for _ in range(caller.draw.randrange(3, 9)):
                caller.publish() if caller.draw.random() < 0.15 else caller.call()
                self.assertIsNone(node.process.poll(), node.output)
            self.expect_repeatable(node, caller)
            if caller.draw.random() < 0.2:
                self.expect_loadable_terrain(node, caller)
        self.expect(node.call("pause", Trigger), caller)
        live = self.expect(node.call("step", Step, 1), caller).state_hash
        caller.close()
        self.assertEqual(node.end()[0], 0, node.output)
        self.assertEqual(self.run_without_ros(OASIS, "--replay", journal), live)
        return caller

    def without_generator(self, caller):
        """Services whose requests would be filled with words that mean nothing."""
        known = {"apply_settings", "edit_plants", "edit_terrain", "edit_wind", "get_grid_map", "get_scenario", "get_submap",
                 "load_checkpoint", "load_scenario", "load_terrain", "new_scenario", "pause", "query_terrain", "redo",
                 "reload_parameters", "reset", "resume", "save_checkpoint", "save_scenario", "save_terrain",
                 "set_parameters", "set_weather", "set_wind", "set_wind_schedule", "step", "undo"}
        return known.symmetric_difference(caller.services)

    def test_what_is_accepted_can_be_repeated(self):
        accepted, refused = {}, {}
        for seed in range((ROUNDS + ROUNDS_OF_A_NODE - 1) // ROUNDS_OF_A_NODE):
            caller = self.drive(seed, min(ROUNDS - seed * ROUNDS_OF_A_NODE, ROUNDS_OF_A_NODE))
            for counts, more in ((accepted, caller.accepted), (refused, caller.refused)):
                for service, count in more.items():
                    counts[service] = counts.get(service, 0) + count
            shutil.rmtree(self.folder)
            os.mkdir(self.folder)
        print("accepted: %s\nrefused: %s" % (accepted, refused))
        self.assertGreater(sum(accepted.values()), 0.4 * (sum(accepted.values()) + sum(refused.values())))


if __name__ == "__main__":
    rospy.init_node("random_calls", disable_signals=True)
    rostest.rosrun("desert_sim", "random_calls", RandomCalls)
