#!/usr/bin/env python3
"""run.acceleration ties the desert's clock to ROS time: on the wall's clock, on a scripted one, and on its own."""
import time

from desert_sim.msg import ElevationGrid, ElevationUpdate, SimulationStatus
from desert_sim.srv import Step
from desert_sim.testing import PATIENCE, wait_until
from dynamic_reconfigure.client import Client
from node_tests import CORNER, Scenarios
from rosgraph_msgs.msg import Clock
import rospy
import rostest
from std_srvs.srv import Trigger

STEP = 0.0625  # [s]; sums of it are exact


class Collector:
    """All messages of a topic since it was made."""

    def __init__(self, topic, kind):
        self.messages = []
        self.subscriber = rospy.Subscriber(topic, kind, self.messages.append, queue_size=1000)

    def last(self):
        wait_until(lambda: self.messages, "no message on " + self.subscriber.name)
        return self.messages[-1]


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
        return node, Client("/" + name, timeout=60 * PATIENCE), Collector("/%s/status" % name, SimulationStatus)

    def pace(self, statuses, seconds):
        """Simulated seconds per second of ROS time between two states, as their messages tell."""
        first = len(statuses.messages)
        wait_until(lambda: len(statuses.messages) > first + 1, "no status")
        start = statuses.messages[-1]
        wait_until(lambda: (statuses.messages[-1].header.stamp - start.header.stamp).to_sec() >= seconds, "time stands")
        end = statuses.messages[-1]
        return (end.sim_time - start.sim_time) / (end.header.stamp - start.header.stamp).to_sec()

    def test_the_desert_keeps_pace_with_the_wall(self):
        node, client, statuses = self.tied("paced", 2.0, update_rate=1000, update_threshold=0.0, step_rate=3)
        updates = Collector("/paced/elevation_updates", ElevationUpdate)
        self.assertAlmostEqual(self.pace(statuses, 4), 2, delta=0.1)
        status = statuses.last()
        self.assertEqual((status.time_step, status.acceleration, status.step_rate), (STEP, 2, 32))
        self.assertEqual(status.sim_time, status.step * status.time_step)
        self.assertLess(status.lag, 0.5)
        stamps = sorted({m.header.stamp.to_sec() for m in updates.messages})
        gaps = sorted(later - earlier for earlier, later in zip(stamps, stamps[1:]))
        self.assertAlmostEqual(gaps[len(gaps) // 2], 1 / 32, delta=0.01, msg="evenly spread")

        self.assertEqual(client.update_configuration({"run__acceleration": 0.5})["run__acceleration"], 0.5)
        self.assertAlmostEqual(self.pace(statuses, 4), 0.5, delta=0.025 + STEP / 4)
        client.update_configuration({"run__time_step": STEP / 4})
        self.assertAlmostEqual(self.pace(statuses, 4), 0.5, delta=0.025 + STEP / 16)
        self.assertEqual(statuses.last().step_rate, 32)
        client.update_configuration({"run__acceleration": 0.0})
        wait_until(lambda: statuses.last().step_rate == 3, "step_rate rules again")
        self.assertEqual(statuses.last().acceleration, 0)

    def test_who_cannot_keep_pace_says_so(self):
        _, _, statuses = self.tied("late", 600.0)  # 9600 steps a second
        wait_until(lambda: statuses.last().lag > 1, "lag is told")
        self.assertEqual(statuses.last().step_rate, 9600)
        self.assertLess(statuses.last().steps_per_second, 9600)

    def test_refusals(self):
        node, client, _ = self.tied("refusing", 0.5, paused=True)

        def refused(changes, text):
            before = node.call("step", Step, 0).state_hash, client.get_configuration(timeout=60 * PATIENCE)
            with self.assertRaises(Exception):
                client.update_configuration(changes)
            wait_until(lambda: text in node.output, "%s: '%s' is not in %s" % (changes, text, node.output))
            self.assertEqual((node.call("step", Step, 0).state_hash, client.get_configuration(timeout=60 * PATIENCE)), before)

        refused({"step_rate": 20.0, "wind__speed": 6.0}, "step_rate: = 20 steps/s has no effect while run.acceleration = 0.5 "
                "and run.time_step = 0.0625 s make 8 steps/s (allowed: any rate once run.acceleration is 0)")
        refused({"run__acceleration": -0.5}, "run.acceleration: = -0.5 is not in [0, 1e+06]")
        refused({"run__acceleration": 1e6}, "run.acceleration: = 1e+06 needs 1.6e+07 steps of 0.0625 s per second "
                "(allowed: 0, or 1e-06 to 625, which is 10000 steps per second)")
        refused({"run__time_step": 200000.0}, "run.time_step: = 200000 is not in [0.0001, 100000] s")
        rospy.set_param("/refusing/step_rate", 25)
        self.assertIn("step_rate=25 (= 25 steps/s has no effect while", node.call("reload_parameters", Trigger).message)
        both = client.update_configuration({"step_rate": 20.0, "run__acceleration": 0.0})
        self.assertEqual((both["step_rate"], both["run__acceleration"]), (20, 0))

    def test_a_scripted_clock_is_followed_exactly(self):
        rospy.set_param("/use_sim_time", True)
        clock = rospy.Publisher("/clock", Clock, queue_size=10)
        self.addCleanup(clock.unregister)  # a node that is the clock refuses to be the second one
        node, client, statuses = self.tied("scripted", 0.5, status_rate=100)  # 8 steps a second
        now = 1000.0

        def show(seconds):
            nonlocal now
            now += seconds
            clock.publish(Clock(rospy.Time.from_sec(now)))

        def reaches(step, sim_time, what):
            wait_until(lambda: statuses.last().step >= step, what)
            self.assertEqual((statuses.last().step, statuses.last().sim_time), (step, sim_time), what)

        wait_until(lambda: statuses.last().state == "waiting", "no clock yet")
        while statuses.last().state != "running":  # until the node listens
            show(0)
            time.sleep(0.05)
        reaches(1, STEP, "the first step is due at once")
        for n in range(1, 25):
            show(0.125)
            reaches(1 + n, (1 + n) * STEP, "a step a tick of the clock")
            self.assertEqual(statuses.last().header.stamp.to_sec(), now)
        time.sleep(0.3)
        reaches(25, 25 * STEP, "the clock stands, and so do the dunes")

        client.update_configuration({"run__acceleration": 2.0})  # a whole interval is left: of the new length
        show(0.5)
        reaches(41, 41 * STEP, "half a second at 32 steps a second")
        client.update_configuration({"run__time_step": 2 * STEP})
        for n in range(1, 9):
            show(0.125)
            reaches(41 + 2 * n, (41 + 4 * n) * STEP, "longer steps, the same pace")

        self.assertTrue(node.call("pause", Trigger).success)
        show(10)
        reaches(57, 73 * STEP, "paused")
        self.assertTrue(node.call("resume", Trigger).success)
        reaches(58, 75 * STEP, "goes on at once, and a pause is no lag")
        self.assertEqual(statuses.last().lag, 0)
        show(100)
        reaches(58 + 17, (75 + 34) * STEP, "a jump ahead is caught up for a second")
        wait_until(lambda: statuses.last().lag > 90, "and told as lag")

    def test_lockstep_shows_each_state(self):
        node, client, _ = self.tied("lockstep", 0.5, paused=True, update_rate=0, update_threshold=0.0)
        updates = Collector("/lockstep/elevation_updates", ElevationUpdate)
        keyframes = Collector("/lockstep/elevation", ElevationGrid)
        self.assertEqual((keyframes.last().step, keyframes.last().sim_time), (0, 0))
        wait_until(lambda: updates.subscriber.get_num_connections() > 0, "no connection")
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
        for acceleration, step in ((3.0, STEP), (3.0, 0.3), (20.0, 0.05), (1.0, 1.7)):
            client.update_configuration({"run__acceleration": acceleration, "run__time_step": step})
            time.sleep(0.3)
        self.assertTrue(node.call("pause", Trigger).success)
        live = node.call("step", Step, 3)
        self.assertEqual(node.end()[0], 0)
        words = [word for setting in settings for word in ("--set", setting)]
        self.assertEqual(self.run_without_ros(CORNER, "--replay", journal, *words), live.state_hash)

    def test_its_own_clock_is_the_time_that_the_robots_live_in(self):
        rospy.set_param("/use_sim_time", True)
        clock = Collector("/clock", Clock)
        node, client, statuses = self.tied("owner", 0.5, paused=True, publish_clock=True)

        def shows(seconds):
            wait_until(lambda: clock.messages and clock.messages[-1].clock.to_sec() == seconds, "%s s on /clock" % seconds)

        wait_until(lambda: clock.messages and clock.messages[-1].clock == rospy.Time(0, 1), "the start")
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
        first, start = clock.last().clock, time.monotonic()
        wait_until(lambda: (clock.last().clock - first).to_sec() >= 3, "time stands")
        self.assertAlmostEqual(time.monotonic() - start, 3, delta=0.5 * PATIENCE, msg="as fast as the wall's clock")


if __name__ == "__main__":
    rospy.init_node("two_clocks", disable_signals=True)
    rostest.rosrun("desert_sim", "two_clocks", TwoClocks)
