#!/usr/bin/env python3
"""run.acceleration ties the desert's clock to ROS time: one that a test moves, and the desert's own. (Whether it keeps pace
with the wall's is measured by two_clocks_timing.py.)"""
from desert_sim.msg import ElevationGrid, ElevationUpdate, SimulationStatus
from desert_sim.srv import Step
from desert_sim.testing import PATIENCE, wait_until
from dynamic_reconfigure.client import Client, DynamicReconfigureCallbackException
from map_client import Listener
from node_tests import CORNER, ScriptedClock, Scenarios
from rosgraph_msgs.msg import Clock
import rospy
import rostest
from std_srvs.srv import Trigger

STEP = 0.0625  # [s]; sums of it are exact
LATE = 1e-4  # [s] of a tick of a clock, so that rounding does not put a step behind it


class TwoClocks(Scenarios):
    def setUp(self):
        super().setUp()
        rospy.set_param("/use_sim_time", False)

    def tearDown(self):
        rospy.set_param("/use_sim_time", False)
        super().tearDown()

    def tied(self, name, acceleration, **private):
        """A node of this acceleration, a client of dynamic_reconfigure, and its statuses."""
        run = {"time_step": STEP, "acceleration": acceleration}
        node = self.start(name, dict({"scenario": CORNER, "run": run, "paused": False, "status_rate": 20}, **private))
        return node, Client("/" + name, timeout=60 * PATIENCE), Listener("/%s/status" % name, SimulationStatus)

    def test_what_status_says_of_it(self):
        _, client, statuses = self.tied("told", 2.0, step_rate=3)
        wait_until(lambda: statuses.last().step > 0, "no step")
        status = statuses.last()
        self.assertEqual(status.sim_time, status.step * status.time_step)
        for time_step, acceleration, step_rate in ((STEP, 2.0, 32), (STEP, 0.5, 8), (STEP / 4, 0.5, 32)):
            client.update_configuration({"run__acceleration": acceleration, "run__time_step": time_step})
            wait_until(lambda: statuses.last().step_rate == step_rate, "the rate")  # noqa: B023
            wait_until(lambda: statuses.last().time_step == time_step, "the step")  # noqa: B023
            self.assertEqual(statuses.last().acceleration, acceleration)
        client.update_configuration({"run__acceleration": 0.0})
        wait_until(lambda: statuses.last().step_rate == 3, "step_rate rules again")
        self.assertEqual(statuses.last().acceleration, 0)

    def test_who_cannot_keep_pace_says_so(self):
        _, _, statuses = self.tied("late", 600.0, settings=["grid.width=512", "grid.height=512"])
        wait_until(lambda: statuses.last().lag > 1, "lag is told")
        self.assertEqual(statuses.last().step_rate, 9600)
        self.assertLess(statuses.last().steps_per_second, 9600)

    def test_refusals(self):
        node, client, _ = self.tied("refusing", 0.5, paused=True)

        def refused(changes, text):
            before = node.call("step", Step, 0).state_hash, client.update_configuration({})
            with self.assertRaises(DynamicReconfigureCallbackException):
                client.update_configuration(changes)
            wait_until(lambda: text in node.output, "%s: '%s' is not in %s" % (changes, text, node.output))
            self.assertEqual((node.call("step", Step, 0).state_hash, client.update_configuration({})), before)

        refused({"step_rate": 20.0, "wind__speed": 6.0},
                "step_rate: 20 steps/s has no effect while run.acceleration = 0.5 and run.time_step = 0.0625 s make "
                "8 steps/s (allowed: any rate once run.acceleration is 0)")
        refused({"run__acceleration": -0.5}, "run.acceleration: -0.5 is not in [0, 1e+06]")
        refused({"run__acceleration": 1e6}, "run.acceleration: 1e+06 needs 1.6e+07 steps of 0.0625 s per second "
                "(allowed: 0, or 1e-06 to 625, which is 10000 steps per second)")
        refused({"run__time_step": 200000.0}, "run.time_step: 200000 is not in [0.0001, 100000] s")
        rospy.set_param("/refusing/step_rate", 25)
        self.assertIn("step_rate=25 (25 steps/s has no effect while", node.call("reload_parameters", Trigger).message)
        both = client.update_configuration({"step_rate": 20.0, "run__acceleration": 0.0})
        self.assertEqual((both["step_rate"], both["run__acceleration"]), (20, 0))

    def test_a_scripted_clock_is_followed_exactly(self):
        """By so many steps a second that a desert which followed another clock would make more whenever the test looks."""
        rospy.set_param("/use_sim_time", True)
        clock = ScriptedClock()
        self.addCleanup(clock.close)
        node, client, statuses = self.tied("scripted", 32.0, status_rate=200)  # 512 steps a second

        def reaches(step, sim_time, what):
            """It comes so far, and no further."""
            wait_until(lambda: statuses.last().step >= step, what)
            seen = len(statuses.messages)
            wait_until(lambda: len(statuses.messages) >= seen + 2, "no status")
            for status in statuses.messages[seen:]:
                self.assertEqual((status.step, status.sim_time), (step, sim_time), what)

        wait_until(lambda: statuses.last().state == "waiting", "no clock yet")
        clock.show(1000)
        reaches(1, STEP, "the first step is due at once")
        self.assertEqual(statuses.last().state, "running")
        for n in range(1, 8):
            clock.show(1000 + n / 64 + LATE)
            reaches(1 + 8 * n, (1 + 8 * n) * STEP, "the steps of a tick of the clock")
            self.assertEqual(statuses.last().header.stamp, clock.now)
        clock.show(1000.125)
        reaches(65, 65 * STEP, "an eighth of a second at 512 steps a second")

        client.update_configuration({"run__acceleration": 64.0})  # a whole interval is left: of the new length
        clock.show(1000.25)
        reaches(193, 193 * STEP, "an eighth of a second at 1024 steps a second")
        client.update_configuration({"run__time_step": 4 * STEP})
        for n in range(1, 9):
            clock.show(1000.25 + n / 32 + LATE)
            reaches(193 + 8 * n, (193 + 32 * n) * STEP, "longer steps, the same pace")

        self.assertTrue(node.call("pause", Trigger).success)
        clock.show(1010)
        reaches(257, 449 * STEP, "paused")
        self.assertTrue(node.call("resume", Trigger).success)
        reaches(258, 453 * STEP, "goes on at once, and a pause is no lag")
        self.assertEqual(statuses.last().lag, 0)
        clock.show(1110)
        reaches(258 + 257, (453 + 4 * 257) * STEP, "a jump ahead is caught up for a second")
        self.assertAlmostEqual(statuses.last().lag, 99, delta=0.01, msg="and the rest is told as lag")

    def test_lockstep_shows_each_state(self):
        node, client, _ = self.tied("lockstep", 0.5, paused=True, keyframe_rate=0, update_rate=0, update_threshold=0.0)
        keyframes = Listener("/lockstep/elevation", ElevationGrid)
        self.assertEqual((keyframes.last().step, keyframes.last().sim_time), (0, 0))
        updates = Listener("/lockstep/elevation_updates", ElevationUpdate)
        wait_until(lambda: len(keyframes.messages) == 2, "what is sent for a new subscriber of the updates")
        for n in range(1, 6):
            answer = node.call("step", Step, 1)
            self.assertEqual((answer.step, answer.sim_time), (n, n * STEP))
            wait_until(lambda: updates.messages and updates.messages[-1].step == n, "the state after step %d" % n)
            self.assertEqual(updates.messages[-1].sim_time, n * STEP)
        self.assertEqual([m.step for m in updates.messages], [1, 2, 3, 4, 5])
        client.update_configuration({"run__time_step": 1.0})
        self.assertEqual(node.call("step", Step, 4).sim_time, 5 * STEP + 4)
        wait_until(lambda: updates.messages[-1].step == 9, "of several steps the last one")
        self.assertEqual(updates.messages[-1].sim_time, 5 * STEP + 4)

    def test_a_journal_of_changes_replays_to_the_same_hash(self):
        journal = self.path("journal.yaml")
        settings = ["run.time_step=%s" % STEP, "run.acceleration=8"]
        node = self.start("journalled", {"scenario": CORNER, "settings": settings, "journal": journal, "paused": False})
        client = Client("/journalled", timeout=60 * PATIENCE)
        for acceleration, step in ((30.0, STEP), (30.0, 0.3), (20.0, 0.05), (100.0, 1.7)):
            client.update_configuration({"run__acceleration": acceleration, "run__time_step": step})
            reached = node.call("step", Step, 0).step
            wait_until(lambda: node.call("step", Step, 0).step >= reached + 2, "no steps")  # noqa: B023
        self.assertTrue(node.call("pause", Trigger).success)
        live = node.call("step", Step, 3)
        self.assertEqual(node.end()[0], 0)
        words = [word for setting in settings for word in ("--set", setting)]
        self.assertEqual(self.run_without_ros(CORNER, "--replay", journal, *words), live.state_hash)

    def test_its_own_clock_is_the_time_that_the_robots_live_in(self):
        rospy.set_param("/use_sim_time", True)
        clock = Listener("/clock", Clock)
        node, client, statuses = self.tied("owner", 0.5, paused=True, publish_clock=True)

        def shows(seconds):
            wait_until(lambda: clock.messages and clock.messages[-1].clock.to_sec() == seconds, "%s s on /clock" % seconds)

        clock.wait_for(lambda m: m.clock == rospy.Time(0, 1), "the start")  # says how many messages came
        node.call("step", Step, 4)
        shows(4 * STEP / 0.5)
        self.assertEqual([m.clock.to_sec() for m in clock.messages[-4:]], [0.125, 0.25, 0.375, 0.5], "one message a step")
        client.update_configuration({"run__acceleration": 0.25})
        node.call("step", Step, 2)
        shows(0.5 + 2 * STEP / 0.25)
        wait_until(lambda: statuses.last().step == 6, "the status")
        self.assertEqual((statuses.last().header.stamp.to_sec(), statuses.last().sim_time), (1.0, 6 * STEP))
        client.update_configuration({"run__acceleration": 4.0})
        self.assertTrue(node.call("resume", Trigger).success)
        first = clock.last().clock
        wait_until(lambda: (clock.last().clock - first).to_sec() >= 0.2, "time stands")


if __name__ == "__main__":
    rospy.init_node("two_clocks", disable_signals=True)
    rostest.rosrun("desert_sim", "two_clocks", TwoClocks)
