#!/usr/bin/env python3
"""desert_sim.testing: what somebody else's test finds. The planner under test is one of this process."""
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import unittest
from concurrent.futures import ThreadPoolExecutor
from unittest import mock

import cv2
import desert_sim.testing
import numpy
import rospy
import rostest
from desert_sim.msg import RoverStatus
from desert_sim.testing import PATIENCE, wait_until
from desert_sim.testing.paths import deviation
from geometry_msgs.msg import PoseStamped, Twist
from nav_msgs.msg import Odometry, Path

# Rock with a wall of sand 3 m high across it, but for a gap in the north.
WALLED = {"grid": {"width": 48, "height": 32, "cell_size": 0.5, "boundary": "open"}, "wind": {"speed": 0},
          "terrain": [{"uniform": {"layer": "bedrock", "value": 1}},
                      {"column": {"layer": "bedrock", "x": 12, "y": 6, "size_x": 1, "size_y": 12, "height": 3}}]}
START, GOAL, GAP = (7, 10), (16, 10), (12, 14.5)
ALWAYS = 600  # s, a reaction that what is under test never exceeds


class Follower:
    """A planner that answers each pose with a command along its way, and publishes that way when it is made or changed."""

    def __init__(self, *way):
        self.way = [START, *way]
        self.paths = rospy.Publisher("/planner/plan", Path, queue_size=1, latch=True)
        self.commands = rospy.Publisher("/rover/cmd_vel", Twist, queue_size=1)
        self.publish()
        wait_until(lambda: self.commands.get_num_connections() > 0, "nobody takes commands")
        self.poses = rospy.Subscriber("/rover/ground_truth", Odometry, self.drive)

    def publish(self):
        path = Path()
        for x, y in self.way:
            path.poses.append(PoseStamped())
            path.poses[-1].pose.position.x, path.poses[-1].pose.position.y = x, y
        self.paths.publish(path)

    def drive(self, odometry):
        x, y, _, yaw = desert_sim.rover.pose_of(odometry)
        while len(self.way) > 1 and math.hypot(self.way[1][0] - x, self.way[1][1] - y) < 0.3:
            self.way.pop(0)
        if len(self.way) < 2:
            return
        turn = math.remainder(math.atan2(self.way[1][1] - y, self.way[1][0] - x) - yaw, 2 * math.pi)
        command = Twist()
        command.linear.x, command.angular.z = 0.3 * max(0, math.cos(turn)) ** 2, 2 * turn
        self.commands.publish(command)

    def close(self):
        for end in (self.poses, self.paths, self.commands):
            end.unregister()


class HopelessRover(desert_sim.Rover):
    """Waits no longer for its pose once its status says why there is none."""

    def pose(self):
        wait_until(lambda: "off the terrain" in self.status().reason, "the rover does not say why it has no pose")
        self.timeout = 0
        return super().pose()


class Kit(unittest.TestCase):
    """Tests that need no desert of their own share one that runs, to which a Desert(None) is as to any other."""

    @classmethod
    def setUpClass(cls):
        cls.walled = desert_sim.testing.Desert(WALLED, node="walled")
        cls.walled.__enter__()
        cls.walled.terrain.close()  # a client beside it would share its connections, and have to ask for a keyframe

    @classmethod
    def tearDownClass(cls):
        cls.walled.__exit__(None, None, None)

    def setUp(self):
        self.walled.simulation.reset()
        self.pictures = tempfile.mkdtemp(prefix="desert_sim_pictures_")
        self.addCleanup(shutil.rmtree, self.pictures)

    def desert(self, scenario=None, **options):
        if scenario is None:
            options["node"] = "walled"
        return desert_sim.testing.Desert(scenario, pictures=self.pictures, **options)

    def planner(self, *way):
        planner = Follower(*way)
        self.addCleanup(planner.close)
        return planner

    def expect_picture(self, failure):
        """The message of an AssertionError names a picture, which has been drawn."""
        path = re.search(r"picture: (\S+\.png)", str(failure)).group(1)
        self.assertEqual(os.path.dirname(path), self.pictures)
        image = cv2.imread(path)
        self.assertGreater(len(set(map(tuple, image.reshape(-1, 3)))), 50, "colours")
        return image

    def test_a_seed_gives_the_same_bits(self):
        def hash_of(node, seed):
            with self.desert("barchan", seed=seed, settings=["grid.width=48", "grid.height=40"], node=node) as desert:
                self.assertEqual(desert.terrain.map.values.shape, (40, 48))
                return desert.step(3).state_hash

        with ThreadPoolExecutor() as at_once:
            one, same, other = at_once.map(hash_of, ("one", "same", "other"), (5, 5, 6))
        self.assertEqual(one, same)
        self.assertNotEqual(one, other)

    def test_costs_and_edits(self):
        with self.desert() as desert:
            self.assertEqual(desert.simulation.status().state, "paused")
            desert.expect_cost(*START, at_most=0)
            desert.expect_cost(12, 6, at_least=0)
            desert.expect_cost(11.2, 6, at_least=100)
            desert.edit("obstacle", "circle", "replace", 1, center=(5, 5), radius=1, inner=1)
            desert.expect_cost(5, 5, at_least=100)
            with self.assertRaisesRegex(AssertionError, r"the cost at \(5, 5\) is 100 \(expected: 0 ... 99\)") as failed:
                desert.expect_cost(5, 5, at_most=99)
            image = self.expect_picture(failed.exception)
            self.assertEqual(image.shape[1] / 48, image.shape[0] / 32)

    def test_a_rover_arrives_as_its_planner_wants(self):
        with self.desert(rover=START, reaction=ALWAYS, seconds_per_step=0.4) as desert:
            self.planner(GAP, GOAL)
            steps = desert.expect_rover_arrives(GOAL, within=175)
            self.assertGreater(steps * 0.12, math.dist(START, GAP) + math.dist(GAP, GOAL) - 1, "0.3 m/s is its limit")
            self.assertLessEqual(desert.rover.distance_to(*GOAL), 0.5)
            self.assertEqual(desert.simulation.step(0).step, steps)
            self.assertEqual(desert.rover.status().state, RoverStatus.DRIVING)

    def test_a_rover_that_does_not_arrive_is_shown(self):
        with self.desert(rover=START, reaction=ALWAYS, seconds_per_step=0.4) as desert:
            self.planner(GOAL)  # through the wall
            with self.assertRaisesRegex(AssertionError, r"after 50 steps the rover is at \(1[01]\..* m from \(16, 10\) .*it is "
                                                        r"blocked: .* commands; picture: ") as failed:
                desert.expect_rover_arrives(GOAL, within=50)
            image = self.expect_picture(failed.exception).astype(int)
            white = (image > 240).all(2)
            self.assertGreater(white[:, image.shape[1] * 15 // 48:image.shape[1] * 20 // 48].sum(), 50, "its way")

    def test_a_planner_that_plans_anew(self):
        with self.desert(rover=START, reaction=ALWAYS) as desert:
            planner = self.planner(GOAL)

            def wall():
                desert.edit("obstacle", "rectangle", "replace", 1, center=(10, 10), radius=0.5, radius_y=2, inner=1)

            def plan_anew(change):
                if not change.replaced and len(planner.way) == 2:
                    planner.way[1:1] = [(9, 14)]
                    planner.publish()

            with desert_sim.TerrainClient("walled", layers=["traversability"], on_change=plan_anew) as terrain:
                self.assertTrue(terrain.wait_for_terrain(60 * PATIENCE))
                with desert.expect_replanned("/planner/plan", within=5):
                    wall()
            desert._reaction = 0.05  # nobody reacts from here on
            with self.assertRaisesRegex(AssertionError, "/planner/plan has 0 paths since the change, .* after 3 steps; picture"):
                with desert.expect_replanned("/planner/plan", within=3):
                    wall()
            with self.assertRaisesRegex(AssertionError, "nobody has published a path on /nowhere within 2 steps") as failed:
                with desert.expect_replanned("/nowhere", within=2):
                    self.fail("the body must not run")
            self.expect_picture(failed.exception)

    def test_whatever_fails_in_the_with_is_shown(self):
        with self.assertRaisesRegex(ZeroDivisionError, "division"):
            with self.desert():
                1 / 0
        self.assertEqual(len(os.listdir(self.pictures)), 1)

    def test_expect_counts_steps(self):
        with self.desert() as desert:
            self.assertEqual(desert.expect(lambda: desert.terrain.map.step >= 4, 10, "four steps"), 4)
            with self.assertRaisesRegex(AssertionError, "ten more: not within 3 steps"):
                desert.expect(lambda: desert.terrain.map.step >= 14, 3, "ten more")

    def test_lockstep_repeats_to_the_bit(self):
        def path(node, rover):
            with self.desert("rover_barchans", seed=3, rover=(12, 20, 20), settings=["grid.width=64", "grid.height=64"],
                             rover_parameters={"rover": {"odometry_noise": 0.02}}, node=node, name=rover) as desert:
                hashes = []
                for n in range(6):
                    hashes.append(desert.rover.command(0.3, 0.1 * (n % 3 - 1)).state_hash)
                    desert.step()
                return hashes, desert.rover.pose()

        with ThreadPoolExecutor() as at_once:
            one, same = at_once.map(path, ("one", "same"), ("one_rover", "same_rover"))
        self.assertEqual(one, same)

    def test_a_node_that_refuses_says_why(self):
        with self.assertRaisesRegex(AssertionError, "/desert_sim has ended:(.|\n)*no_such_desert(.|\n)*barchan"):
            with self.desert("no_such_desert"):
                self.fail("there is no such scenario")
        with self.assertRaisesRegex(desert_sim.SimulationError, "/rover/ground_truth: no message .* no_terrain: .*off the terrain"):
            with mock.patch("desert_sim.testing.desert.Rover", HopelessRover), self.desert(rover=(-3, 5)):
                self.fail("there is no ground")
        with self.assertRaisesRegex(AssertionError, "/rover/desert_rover has ended:(.|\n)*wheel"):
            with self.desert(rover=START, rover_parameters={"rover": {"wheel_radius": -1}}):
                self.fail("there is no such rover")

    def test_a_node_ends_though_its_test_fails(self):
        private = {"scenario": "barchan", "settings": "[grid.width=16, grid.height=16]", "backend": "cpu", "paused": True}
        with self.assertRaises(ZeroDivisionError), desert_sim.testing.Node("failing", private) as node:
            1 / 0
        self.assertFalse(node.running)
        # Without a `with`, it ends with the process of the test.
        script = ("import os, desert_sim.testing as t; t.init_ros(); n = t.Node('leaked', %r); "
                  "n.latest('status', __import__('desert_sim.msg').msg.SimulationStatus); print(n.process.pid, flush=True); 1 / 0"
                  % private)
        done = subprocess.run([sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              universal_newlines=True, timeout=120 * PATIENCE)
        self.assertIn("ZeroDivisionError", done.stderr)
        with self.assertRaises(ProcessLookupError):
            os.kill(int(done.stdout), 0)

    def test_threads_of_a_desert_end_with_it(self):
        before = threading.active_count()
        with self.desert(rover=START):
            pass
        wait_until(lambda: threading.active_count() <= before + 2, "threads go on")


class Deviation(unittest.TestCase):
    def test_of_paths(self):
        straight = desert_sim.testing.paths.points_of(Path())
        self.assertEqual(straight.shape, (0, 2))
        line = numpy.array([(0, 0), (10, 0)], float)
        self.assertEqual(deviation(numpy.array([(1, 0), (5, -2), (12, 0)], float), line), 2)
        self.assertEqual(deviation(straight, line), 0)
        self.assertEqual(deviation(line, straight), math.inf)
        self.assertEqual(deviation(line, line[:1]), 10)


if __name__ == "__main__":
    rospy.init_node("testing_kit", disable_signals=True)
    rostest.rosrun("desert_sim", "testing_kit", "testing_kit")
