"""A desert for a test, and what may be expected of it."""
import contextlib
import os
import shutil
import sys
import tempfile
import textwrap
import threading

import rospkg
import yaml
from nav_msgs.msg import Path

from ..rover import Rover
from ..services import SimulationError
from ..simulation import Simulation
from ..terrain_client import TerrainClient
from .paths import Inbox, deviation, points_of
from .processes import PATIENCE, Node, init_ros, wait_until

try:
    from ..picture import BLUE, GREEN, RED, WHITE, Picture
except ImportError as missing:  # DESERT_PARTS=client comes without OpenCV: what fails says so in place of a picture
    Picture, NO_PICTURE = None, "%s (python3-opencv)" % missing

BARE = 0.01  # depth of sand that still shows the rock in pictures [m]


class Desert:
    """A paused desert_sim node for the length of a `with`, and a rover on it in lockstep: both move by step() only, so that
    the same calls lead to the same bits.

    scenario          a name of config/scenarios, a YAML file (a path with a slash), a dict of a scenario's sections
                      ({"grid": {...}, "terrain": [...]}), or None: the node that runs already, which is paused
    seed              seed of the scenario; None: the one it has
    rover             None, or where one stands: (x, y) or (x, y, yaw_deg), in metres of the terrain's frame
    settings          keys of the scenario to override: ["grid.width=128", "wind.speed=7"]
    seconds_per_step  time of the rover in a step of the desert [s]
    parameters        more private parameters of the node (config/node_parameters.md), a dict
    rover_parameters  more private parameters of the rover's node (config/rover_parameters.md), a dict
    reaction          how long step() waits for a command to the rover, and expect_replanned() for a path, before it goes on
                      without [s of wall time, times PATIENCE]
    timeout           how long nodes may take to come up, and to answer [s of wall time, times PATIENCE]
    node, name        names of the node and of the rover
    pictures          folder for pictures of failures; None: DESERT_TEST_PICTURES, or the folder of rostest's results

    simulation        Simulation: pause, edit, set_wind, query, submap, ...
    terrain           TerrainClient of the elevation
    rover             Rover, or None

    The ROS master is that of rostest, or of its own (init_ros()). What is expected and does not come raises AssertionError,
    which names a picture: shaded terrain with lethal cells in red, water, the rover's way in white, paths in blue, the goal;
    or says that there is none, because python3-opencv is not installed.
    """

    def __init__(self, scenario, seed=None, rover=None, settings=(), seconds_per_step=0.1, parameters=None,
                 rover_parameters=None, reaction=1.0, timeout=60.0, node="desert_sim", name="rover", pictures=None):
        self._scenario, self._seed, self._start, self._settings = scenario, seed, rover, list(settings)
        self._seconds_per_step = seconds_per_step
        self._reaction, self._timeout = reaction * PATIENCE, timeout * PATIENCE
        self._parameters, self._rover_parameters = parameters or {}, rover_parameters or {}
        self._node, self._name = node, name
        self._pictures = pictures or os.environ.get("DESERT_TEST_PICTURES") or rospkg.get_test_results_dir()
        self._nodes, self._way, self._inboxes, self._pictured = [], [], {}, None
        self.simulation = self.terrain = self.rover = None

    # ---- begin and end

    def __enter__(self):
        init_ros()
        self._folder = tempfile.mkdtemp(prefix="desert_sim_test_")
        try:
            self._begin()
        except BaseException:
            self._end()
            raise
        return self

    def __exit__(self, kind, error, _):
        try:
            if error is not None and error is not self._pictured and self.terrain and self.terrain.map:
                print("desert_sim.testing: %s; %s" % (kind.__name__, self._picture_of("failure")), file=sys.stderr)
        finally:
            self._end()

    def _begin(self):
        self.simulation = Simulation(self._node, timeout=self._timeout)
        if self._scenario is not None:
            self._nodes.append(Node(self._node, self._node_parameters()))
            self._wait_for_node(self._nodes[-1], self.simulation.status)
        self.simulation.pause()
        self.terrain = TerrainClient(self._node, tell_each_step=True)
        assert self.terrain.wait_for_terrain(self._timeout), "%s sends no elevation" % self._node
        if self._start is not None:
            self.rover = Rover(self._name, timeout=self._timeout)
            self._nodes.append(Node(self.rover.node, self._parameters_of_rover(), "desert_rover_node"))
            self._wait_for_node(self._nodes[-1], self.rover.pose)
            self._way.append(self.rover.pose())

    def _end(self):
        for end in (self.terrain, self.rover, *[inbox.subscriber for inbox in self._inboxes.values()]):
            if end is not None:
                end.unregister() if hasattr(end, "unregister") else end.close()
        for node in reversed(self._nodes):
            node.close()
        shutil.rmtree(self._folder, ignore_errors=True)

    def _wait_for_node(self, node, first):
        """Waits for the first sign of a node: `first()` returns it within the timeout, or raises why there is none. If
        the node ends instead, what it has printed says why."""
        done = []
        waiter = threading.Thread(target=lambda: done.append(_result(first)), daemon=True)
        waiter.start()
        wait_until(lambda: done or not node.running, "%s gives no sign of life: %s" % (node.path, node.output),
                   2 * self._timeout / PATIENCE)
        if not node.running:
            raise AssertionError("%s has ended:\n%s" % (node.path, node.wait()[1]))
        if isinstance(done[0], Exception):
            raise done[0]

    def _node_parameters(self):
        folder = rospkg.RosPack().get_path("desert_sim")
        with open(os.path.join(folder, "config", "lockstep_publishers.yaml")) as file:
            parameters = yaml.safe_load(file)
        parameters.update(backend="cpu", threads=1, paused=True, answer_timeout=self._timeout, data_dir=self._folder)
        if isinstance(self._scenario, dict):
            assert not self._settings, "settings override keys of a file; the scenario is a dict"
            parameters.update(self._scenario, **({} if self._seed is None else {"seed": self._seed}))
        else:
            parameters["scenario"] = self._scenario
            parameters["settings"] = self._settings + ([] if self._seed is None else ["seed=%d" % self._seed])
        parameters.update(self._parameters)
        return parameters

    def _parameters_of_rover(self):
        x, y, yaw_deg = (*self._start, 0.0)[:3]
        time_step = self.simulation.status().time_step
        parameters = {"clock": "lockstep", "seconds_per_sim_second": self._seconds_per_step / time_step, "x": float(x),
                      "y": float(y), "yaw_deg": float(yaw_deg), "terrain_node": self.simulation.node,
                      "tf_prefix": self._name, "data_dir": self._folder, "answer_timeout": self._timeout,
                      "lidar": {"rate": 0}, "depth_camera": {"rate": 0}}
        parameters.update(self._rover_parameters)
        return parameters

    # ---- steps and edits

    def step(self, steps=1, wait_for_command=False):
        """Makes so many steps one by one, and the rover drives with them; the last answer of ~step. Its pose and the terrain
        are those of the last step then.

        wait_for_command   whether to wait before each step until the rover has a command since the last one (at most
                           `reaction`), so that a planner that answers each pose with a command is in lockstep, too
        """
        for _ in range(steps):
            if wait_for_command:
                self.rover.wait_for_status(lambda status: status.commands > self._commands_seen, self._reaction)
            answer = self._show(1)
        return answer if steps else self._show(0)

    _commands_seen = 0

    def _show(self, steps):
        """Makes 0 or 1 steps, and waits until terrain and rover are there."""
        if self.rover:
            self._commands_seen = self.rover.status().commands
        answer = self.simulation.step(steps)
        assert self.terrain.wait_for_step(answer.step, self._timeout), "the elevation of step %d does not come" % answer.step
        if self.rover:
            stamp = self.terrain.map.stamp
            came = (self.rover.wait_for_stamp(stamp, self._timeout)
                    and self.rover.wait_for_status(lambda status: status.terrain_stamp >= stamp, self._timeout))
            assert came, "the rover does not come to step %d" % answer.step
            self._way.append(self.rover.pose())
        return answer

    def edit(self, layer, shape, merge, value=0.0, **fields):
        """Simulation.edit(); whoever subscribes to the terrain is shown it before this returns."""
        answer = self.simulation.edit(layer, shape, merge, value, **fields)
        self._show(0)
        return answer

    # ---- expectations: each raises AssertionError that names a picture

    def cost(self, x, y):
        """Cost of the cell at a point as in ~costmap: 0 ... 99, 100 lethal, -1 unknown; for the scenario's rover."""
        ground = self.terrain.map
        cell = ground.cell_to_world(*ground.world_to_cell(x, y))
        layer = self.simulation.submap(cell, (ground.cell_size, ground.cell_size), ["traversability"])["traversability"]
        return int(layer.cost()[0, 0])

    def expect_cost(self, x, y, at_least=0, at_most=100):
        """The cost at a point is in a range; at_least=100 expects a lethal cell."""
        cost = self.cost(x, y)
        if not at_least <= cost <= at_most:
            self._fail("cost", "the cost at (%s, %s) is %d (expected: %d ... %d)" % (x, y, cost, at_least, at_most), (x, y))

    def expect(self, happens, within, what, wait_for_command=False):
        """`happens()` is true now or after at most `within` steps; the number of steps that it took."""
        for steps in range(within + 1):
            if happens():
                return steps
            if steps < within:
                self.step(1, wait_for_command)
        return self._fail("expectation", "%s: not within %d steps" % (what, within))

    def expect_rover_arrives(self, goal, within, tolerance=0.5):
        """The rover comes within `tolerance` [m] of goal (x, y) [m] in at most `within` steps, as something under test commands
        it; the number of steps that it took."""
        for steps in range(within + 1):
            if self.rover.distance_to(*goal) <= tolerance:
                return steps
            if steps < within:
                self.step(1, wait_for_command=True)
        now, status = self.rover.pose(), self.rover.status()
        return self._fail("rover_arrives", "after %d steps the rover is at (%.2f, %.2f), %.2f m from (%s, %s) (expected: at "
                          "most %g m); it is %s%s, and got %d commands" % (
                              within, now.x, now.y, self.rover.distance_to(*goal), *goal, tolerance, status.state,
                              ": " + status.reason if status.reason else "", status.commands), goal)

    @contextlib.contextmanager
    def expect_replanned(self, topic, within, by=1.0):
        """What the body of the `with` changes makes a planner publish another way in at most `within` steps.

            with desert.expect_replanned("/planner/plan", within=20):
                desert.edit("obstacle", "rectangle", "replace", 1, center=(30, 64), radius=1, radius_y=10)

        topic   a nav_msgs/Path that has been published already, or is so within `within` steps
        by      a path is another way if it leads farther than this away from the last one before the change [m]
        """
        inbox = self._inbox(topic)
        for _ in range(within):
            if inbox.messages or inbox.wait_for_more_than(0, self._reaction):
                break
            self.step()
        if not inbox.messages:
            self._fail("replanned", "nobody has published a path on %s within %d steps" % (topic, within))
        before, seen = points_of(inbox.messages[-1]), len(inbox.messages)
        yield
        for steps in range(within + 1):
            inbox.wait_for_more_than(seen, self._reaction)
            if any(deviation(points_of(path), before) > by for path in inbox.messages[seen:]):
                return
            if steps < within:
                self.step()
        since = inbox.messages[seen:]
        self._fail("replanned", "%s has %d paths since the change, and none leads farther than %g m from the one before, after "
                   "%d steps" % (topic, len(since), by, within))

    def _inbox(self, topic):
        if topic not in self._inboxes:
            self._inboxes[topic] = Inbox(topic, Path)
        return self._inboxes[topic]

    # ---- pictures

    def show_path(self, topic):
        """From now on pictures show the last nav_msgs/Path of this topic, too."""
        self._inbox(topic)

    def write_picture(self, path, goal=None, lines=()):
        """picture() as a file."""
        self.picture(goal, lines).write(path)

    def picture(self, goal=None, lines=()):
        """A Picture of the terrain as it is now with costs, the rover's way, and the last paths that were expected. Raises
        RuntimeError without OpenCV."""
        if Picture is None:
            raise RuntimeError("there are no pictures: %s" % NO_PICTURE)
        ground = self.terrain.map
        west, east, south, north = ground.extent
        try:
            layers = self.simulation.submap(((west + east) / 2, (south + north) / 2), (east - west, north - south),
                                            ["traversability", "sand_depth", "water_depth"])
            costs, bare = layers["traversability"].cost(), layers["sand_depth"].values < BARE
            water = layers["water_depth"].values
        except SimulationError as error:  # a picture of a node that has failed is worth having, too
            costs, bare, water, lines = None, None, None, [*lines, str(error)]
        picture = Picture(ground, costs, bare, water)
        for inbox in self._inboxes.values():
            for message in inbox.messages[-1:]:
                picture.line(points_of(message), BLUE)
        picture.line([(pose.x, pose.y) for pose in self._way], WHITE)
        if goal is not None:
            picture.cross(*goal, GREEN)
        if self._way:
            picture.arrow(self._way[-1].x, self._way[-1].y, self._way[-1].yaw, RED)
        picture.text(["step %d" % ground.step, *lines])
        return picture

    def _picture_of(self, what, goal=None, lines=()):
        """What a message says of the picture, which is written here."""
        if Picture is None:
            return "no picture: %s" % NO_PICTURE
        os.makedirs(self._pictures, exist_ok=True)
        test = os.path.splitext(os.path.basename(sys.argv[0]))[0]
        handle, path = tempfile.mkstemp(prefix="%s_%s_step_%d_" % (test, what, self.terrain.map.step), suffix=".png",
                                        dir=self._pictures)
        os.close(handle)
        self.write_picture(path, goal, lines)
        return "picture: " + path

    def _fail(self, what, message, goal=None):
        error = AssertionError("%s; %s" % (message, self._picture_of(what, goal, textwrap.wrap(message, 84))))
        self._pictured = error
        raise error


def _result(function):
    try:
        return function()
    except Exception as error:  # noqa: B902 it is raised again by who waits
        return error
