#!/usr/bin/env python3
"""Autosaves, and going on from them: kill -9 at random moments, torn files, journals."""
import os
import random
import shutil
import signal

from desert_sim.msg import SimulationStatus
from desert_sim.srv import EditPlants, EditTerrain, LoadScenario, SetWind, Step
from desert_sim.testing import wait_until
from geometry_msgs.msg import Point
from map_client import Listener
from node_tests import CORNER, OASIS, Scenarios, autosaves, saved_steps, step_of
import rospy
import rostest
from std_srvs.srv import Trigger

KILLS = int(os.environ.get("DESERT_KILLS", "4"))
AUTOSAVED = {"scenario": CORNER, "autosave_period": 0.02, "resume": True}


def number(path):
    return int(path[:-len(".ckpt")].rpartition("-")[2])


class Resume(Scenarios):
    def saved(self, name, steps, **more):
        """A node that was killed after it had saved that many steps."""
        node = self.start(name, dict(AUTOSAVED, data_dir=self.folder, **more))
        node.call("step", Step, steps)
        wait_until(lambda: steps in saved_steps(self.folder), "no autosave of step %d" % steps)
        node.end(signal.SIGKILL)
        return node

    def again(self, name, **more):
        node = self.start(name, dict(dict(AUTOSAVED, data_dir=self.folder), **more))
        return node, node.latest("status", SimulationStatus).step

    # ---- killed while it runs ------------------------------------------------------------------

    def newest_number(self):
        return max([number(path) for path in autosaves(self.folder)], default=0)

    def kill(self, node):
        """Kills it at a random moment of its run. A step that it had saved by then, and a copy of its newest autosave."""
        with Listener(node.path + "/status", SimulationStatus) as status:
            saved = status.first().step
            newest = self.newest_number()
            # The copy of the next one may have been made already; that of the one after it has not.
            wait_until(lambda: self.newest_number() >= newest + 2, "no autosaves")
            more = status.messages[-1].step + random.randint(0, 20)
            status.wait_for(lambda m: m.step >= more, "it does not run")
        node.end(signal.SIGKILL)
        self.assertLessEqual(len(autosaves(self.folder)), 4,
                             "the last two, the one that the journal began with, and one that was not tidied up yet")
        return saved, shutil.copy(max(autosaves(self.folder), key=number), self.path("newest.ckpt"))

    def run_again(self, name, saved, **more):
        """The node that is started after it was killed."""
        node, step = self.again(name, paused=False, status_rate=100, **more)
        self.assertGreaterEqual(step, saved, "it goes on where it was")
        return node

    def test_killed_again_and_again(self):
        node = self.run_again("killed", 0, step_rate=200)
        for _ in range((KILLS + 1) // 2):
            saved, _ = self.kill(node)
            node = self.run_again("killed", saved, step_rate=200)
        node.call("pause", Trigger)
        reached = node.call("step", Step, 0)
        self.assertEqual(reached.state_hash, self.run_without_ros(CORNER, "--steps", str(reached.step)),
                         "nothing was lost or done twice")

    def test_the_journal_of_a_killed_node_leads_to_its_autosave(self):
        journal = self.path("journal.yaml")
        more = {"scenario": OASIS, "step_rate": 100, "journal": journal}
        node = self.run_again("oasis", 0, **more)
        for n in range((KILLS + 1) // 2):
            brush = {"shape": "circle", "center": Point(random.uniform(0, 30), random.uniform(10, 35), 0), "radius": 4}
            self.assertTrue(node.call("edit_plants", EditPlants, operation="plant", species="bush", density=0.1, size=0.2,
                                      seed=n, **brush).success)
            self.assertTrue(node.call("edit_terrain", EditTerrain, layer="water", merge="max", value=0.5, **brush).success)
            saved, newest = self.kill(node)
            node = self.run_again("oasis", saved, **more)
            reached = self.path("reached.ckpt")
            self.run_without_ros(OASIS, "--replay", journal + ".previous", "--checkpoint", reached)
            self.assertLessEqual(step_of(reached), step_of(newest), "the journal ends with its last command")
            steps = str(step_of(newest))
            self.assertEqual(self.run_without_ros("--resume", reached, "--steps", steps),
                             self.run_without_ros("--resume", newest, "--steps", steps))

    # ---- paused --------------------------------------------------------------------------------

    def test_a_torn_file_is_skipped_and_nothing_whole_is_a_start(self):
        self.saved("torn", 5)
        whole = autosaves(self.folder)[-1]
        for n, share in ((7, 0.5), (8, 0.99), (9, 0)):
            torn = "%s-%010d.ckpt" % (whole[:-len("-0000000001.ckpt")], n)
            shutil.copy(whole, torn)
            os.truncate(torn, int(share * os.path.getsize(whole)))
        with open(whole + ".part", "w") as part:
            part.write("killed while it wrote")
        node, step = self.again("torn")
        self.assertEqual(step, 5)
        node.end(signal.SIGKILL)
        self.assertEqual(node.output.count("cannot be loaded"), 3, node.output)
        self.assertIn("0000000009.ckpt", node.output)
        for path in autosaves(self.folder):
            os.truncate(path, 100)
        node, step = self.again("torn")
        self.assertEqual(step, 0)
        self.assertEqual(node.end()[0], 0)
        self.assertIn("No complete autosave", node.output)

    def test_the_last_two_are_kept(self):
        node = self.start("tidy", dict(AUTOSAVED, data_dir=self.folder))
        for _ in range(5):
            newest = autosaves(self.folder)[-1:]
            node.call("step", Step, 1)
            wait_until(lambda: autosaves(self.folder)[-1:] != newest, "no autosave")
        wait_until(lambda: len(autosaves(self.folder)) == 2, "old ones stay")

    def test_ends_while_it_saves(self):
        node = self.start("saving", dict(AUTOSAVED, data_dir=self.folder, autosave_period=0.01, paused=False, step_rate=0))
        wait_until(lambda: any(saved_steps(self.folder)), "no autosave of a step")
        self.assertEqual(node.end()[0], 0, node.output)
        self.assertGreater(self.again("saving")[1], 0, "the last one is whole")

    def test_a_place_that_cannot_be_written_does_not_stop_it(self):
        with open(self.path("autosave"), "w") as file:
            file.write("not a folder")
        node = self.start("placeless", dict(AUTOSAVED, data_dir=self.folder))
        wait_until(lambda: "The autosave failed: " in node.output, "no error")
        self.assertEqual(node.call("step", Step, 2).step, 2)
        os.remove(self.path("autosave"))
        node.call("step", Step, 1)
        wait_until(lambda: autosaves(self.folder), "it does not try again")

    def test_only_its_own_scenario_is_resumed(self):
        self.saved("own", 3)
        node, step = self.again("own", seed=8)
        self.assertEqual(step, 0, "of other settings")
        node.end(signal.SIGKILL)
        node, step = self.again("own")
        self.assertEqual(step, 3)
        node.end(signal.SIGKILL)
        self.assertEqual(self.again("own", resume=False)[1], 0, "without resume it starts anew")

    def test_a_loaded_scenario_is_resumed_with_its_start(self):
        node = self.start("loaded", dict(AUTOSAVED, data_dir=self.folder))
        self.path("other.yaml", "grid: {width: 9, height: 7}\nterrain: [noise: {layer: sand, high: 2}]\n")
        start = node.call("load_scenario", LoadScenario, name="other.yaml").state_hash
        live = node.call("step", Step, 3).state_hash
        wait_until(lambda: 3 in saved_steps(self.folder), "no autosave of step 3")
        node.end(signal.SIGKILL)
        node, step = self.again("loaded")
        self.assertEqual(step, 3)
        self.assertEqual(node.latest("status", SimulationStatus).scenario, "other")
        self.assertEqual(node.call("step", Step, 0).state_hash, live)
        self.assertTrue(node.call("reset", Trigger).success)
        self.assertEqual(node.call("step", Step, 0).state_hash, start, "the start of the scenario that was loaded")
        node.end()
        self.assertIn("scenario other was loaded: 9 x 7 cells", node.output)

    def test_the_journal_of_a_resumed_node_replays(self):
        journal = self.path("journal.yaml")
        self.saved("replayed", 4, journal=journal)
        node, step = self.again("replayed", journal=journal)
        self.assertEqual(step, 4)
        self.assertTrue(node.call("set_wind", SetWind, speed=8, direction_deg=70).success)
        live = node.call("step", Step, 6).state_hash
        for path in autosaves(self.folder):
            os.remove(path)
        self.assertEqual(node.end()[0], 0)
        self.assertEqual(self.run_without_ros(CORNER, "--replay", journal), live)

    def test_the_previous_journal_still_replays(self):
        journal = self.path("journal.yaml")
        self.saved("previous", 4, journal=journal)
        node, _ = self.again("previous", journal=journal)
        live = node.call("step", Step, 6).state_hash
        wait_until(lambda: 10 in saved_steps(self.folder), "no autosave of step 10")
        self.assertEqual(node.end()[0], 0)
        node, step = self.again("previous", journal=journal)
        self.assertEqual(step, 10)
        node.end(signal.SIGKILL)
        self.assertEqual(self.run_without_ros(CORNER, "--replay", journal + ".previous"), live)

    def test_a_chosen_name_does_not_win(self):
        self.saved("chosen", 3)
        newest = autosaves(self.folder)[-1]
        for number in ("9999999999", "zzz"):
            shutil.copy(newest, newest.rpartition("-")[0] + "-" + number + ".ckpt")
        node, _ = self.again("chosen")
        node.call("step", Step, 4)
        wait_until(lambda: 7 in saved_steps(self.folder), "no autosave of step 7")
        node.end(signal.SIGKILL)
        self.assertEqual(self.again("chosen")[1], 7)


if __name__ == "__main__":
    rospy.init_node("resume", disable_signals=True)
    rostest.rosrun("desert_sim", "resume", Resume)
