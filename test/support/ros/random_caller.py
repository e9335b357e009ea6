"""A client that makes random calls of every service of a node, publishes on every topic that it listens to, and paints."""
import os
import random
import re

from actionlib_msgs.msg import GoalID
from desert_sim.msg import ForecastTerrainActionGoal, SimulationStatus
from desert_sim.srv import EditTerrainRequest, UndoRequest
from desert_sim.testing import wait_until
from dynamic_reconfigure.msg import BoolParameter, ConfigDescription, DoubleParameter, IntParameter, StrParameter
from geometry_msgs.msg import Point, Vector3Stamped
from map_client import GetGridMap
from node_tests import CORNER, OASIS
from random_messages import RandomMessages
import rospy
import rosservice
from std_msgs.msg import Empty, String
from tf2_msgs.msg import TFMessage

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
    """One client of a node, with connections of its own. What it draws depends on its seed alone, and on what the node has
    accepted. `names` are those that may be loaded; what it has saved itself joins them when take_names() is called."""

    def __init__(self, node, name, seed, names):
        self.node, self.name, self.draw, self.names = node, name, random.Random("%s %s" % (name, seed)), names
        self.random = RandomMessages(self.draw)
        self.saved, self.new_names, self.strokes = 0, [], 0
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
        return "%s_%d" % (self.name, self.saved)

    def take_names(self):
        for kind, name in self.new_names:
            self.names[kind].append(name)
        self.new_names.clear()

    def request(self, service):
        request = self.random.filled(self.proxies[service].request_class())
        if service == "set_parameters":
            request.config = self.config(request.config)
        elif service == "load_scenario":
            request.name = self.draw.choice([*SCENARIOS, *self.names["scenario"], "none.yaml"])
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
            request.name = self.draw.choice(["none.ckpt", *self.names["checkpoint"]])
        elif service == "load_terrain":
            request.name = self.draw.choice(["none", *self.names["terrain"]])
        elif service in ("save_checkpoint", "save_scenario", "save_terrain"):
            request.name = self.draw.choice([self.new_name()] * 8 + ["..", "/tmp/x", "none.ckpt/x"])
        elif service == "export_terrain":
            name = self.draw.choice([self.new_name(), *["of_both_export"] * 4, "../x", "none.ckpt/x"])
            request.name = name + self.draw.choice([*request.ENDINGS.split(), ".dae"])
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

    def publish(self, at_once):
        """One random message on one of the topics, which nobody answers."""
        topic = self.draw.choice(sorted(TOPICS))
        message = self.random.filled(TOPICS[topic]())
        if isinstance(message, ForecastTerrainActionGoal):
            message.goal_id.id = "%s %d" % (self.name, len(self.log))  # actionlib overhears one that it knows
            message.goal.parameters = self.config(message.goal.parameters)
            if not self.random.rarely():
                tidy(message.goal)
        self.log.append("%s %s" % (topic, str(message)[:300]))
        at_once()
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

    def call(self, at_once):
        """One random call; it is answered, or fails with the reason. `at_once` is called when the request is made."""
        service = self.draw.choices(self.services, [WEIGHTS.get(name, 1) for name in self.services])[0]
        request = self.request(service)
        at_once()
        accepted, reason = self.answer(service, request)
        if not self.random.rarely():
            while leave_out_unused(request, reason):
                accepted, reason = self.answer(service, request)
        self.count(service, request, accepted)
        return accepted

    def file_call(self, verb, kind, at_once):
        """Saves or loads what both clients save and load under one name."""
        service = "%s_%s" % (verb, kind)
        request = self.proxies[service].request_class(name="of_both_" + kind)
        if service == "save_terrain":
            request.format = self.draw.choice(["geotiff", "rosbag", "png16"])
        at_once()
        accepted, _ = self.answer(service, request)
        self.count(service, request, accepted)
        return accepted

    def count(self, service, request, accepted):
        count = self.accepted if accepted else self.refused
        count[service] = count.get(service, 0) + 1
        verb, _, kind = service.partition("_")
        if accepted and verb == "save" and request.name not in self.names[kind]:
            self.new_names.append((kind, request.name))

    def stroke(self):
        """Calls that paint a stroke with many small dabs, which every scenario here has room for, and take it back and
        give it again: (service, request). Whether it is there at last."""
        self.strokes += 1
        name = "%s %d" % (self.name, self.strokes)
        layer = self.draw.choice(["sand", "bedrock", "obstacle", "erosion_resistance"])
        calls = []
        for _ in range(self.draw.randrange(3, 9)):
            dab = EditTerrainRequest(layer=layer, shape="circle", merge="add", stroke=name, radius=self.draw.uniform(1.5, 3))
            dab.center = Point(self.draw.uniform(11, 16), self.draw.uniform(8, 12), 0)
            dab.value = self.draw.uniform(0.01, 0.1)
            calls.append(("edit_terrain", dab))
        turns = self.draw.choice([0, 1, 1, 2, 3])
        calls += [("redo" if n % 2 else "undo", UndoRequest(name)) for n in range(turns)]
        return calls, turns % 2 == 0

    def paint(self, service, request, at_once):
        at_once()
        accepted, reason = self.answer(service, request)
        assert accepted, reason
        self.count(service, request, accepted)
        return accepted

    def answer(self, service, request):
        """Whether the request is accepted, and the reason if it is not."""
        self.log.append("%s %s" % (service, " ".join(str(request).split())[:1500]))
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
