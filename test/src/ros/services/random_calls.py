#!/usr/bin/env python3
"""Two clients at once make random calls of every service, paint, and publish on every topic that a node listens to. Whatever
is accepted, in whichever order, can be repeated: after each round the journal replays to the state of the node, no material
is lost, a checkpoint that is saved can be loaded and saved again as the same bytes, and a saved scenario or terrain can be
loaded. DESERT_ROUNDS says how many rounds, of some pairs of calls each: one of each client, both under way together."""
from concurrent.futures import ThreadPoolExecutor
import difflib
import os
import random
import re
import shutil
import threading

from desert_sim.msg import SimulationStatus
from desert_sim.srv import LoadCheckpoint, LoadScenario, LoadTerrain, SaveCheckpoint, SaveScenario, SaveTerrain, Step
from node_tests import OASIS, Scenarios
from random_caller import Caller, NODE, SCENARIOS, TOPICS
import rosgraph
import rospy
import rostest
from std_srvs.srv import Trigger

ROUNDS = int(os.environ.get("DESERT_ROUNDS", "30"))
ROUNDS_OF_A_NODE = 15  # each replays the node's journal from its beginning
CLIENTS = ("first", "second")


class Pair:
    """Two clients that call at the same time: what one is asked for begins when both are ready, and the next when both have
    been answered. So a call of one lies between the calls of the other before and after it, whatever the node's order."""

    def __init__(self, clients):
        self.clients, self.both_accepted = clients, 0
        self.threads = ThreadPoolExecutor(len(clients))

    def at_once(self, *calls):
        """Each call is a function of what it calls before it asks the node."""
        barrier = threading.Barrier(sum(1 for call in calls if call))

        def guarded(call):
            try:
                return call(barrier.wait)
            except BaseException:
                barrier.abort()  # the other does not wait for ever
                raise

        answers = [self.threads.submit(guarded, call) for call in calls if call]
        faults = [answer.exception() for answer in answers if answer.exception()]
        for fault in sorted(faults, key=lambda f: isinstance(f, threading.BrokenBarrierError)):
            raise fault
        self.both_accepted += len(answers) > 1 and all(answer.result() for answer in answers)
        for client in self.clients:
            client.take_names()

    def log(self):
        return "\n".join("---- %s client:\n%s" % (c.name, "\n".join(c.log[-30:])) for c in self.clients)

    def close(self):
        self.threads.shutdown()
        for client in self.clients:
            client.close()


def between(journal, strokes):
    """How many dabs of a stroke the journal has after the first and before the last of another one: [of each]."""
    order = [name for name in re.findall(r"command: edit_terrain,.*?stroke: \"(\w+ \d+)\"", journal) if name in strokes]
    ends = {name: (order.index(name), len(order) - 1 - order[::-1].index(name)) for name in strokes}
    return [sum(1 for n, name in enumerate(order) if name != other and ends[other][0] < n < ends[other][1]) for other in strokes]


class RandomCalls(Scenarios):
    def file(self, name):
        with open(os.path.join(self.folder, name), "rb") as file:
            return file.read()

    def expect(self, answer):
        self.assertTrue(answer.success, answer.message)
        return answer

    def random_calls(self, pair, draw):
        """Calls of anything; now and then both write or read one file."""
        for _ in range(draw.randrange(3, 9)):
            if draw.random() < 0.15:
                kind = draw.choice(["checkpoint", "terrain", "scenario"])
                verbs = draw.choice([("save", "load"), ("load", "save"), ("save", "save"), ("load", "load")])
                pair.at_once(*(lambda ready, c=client, verb=verb: c.file_call(verb, kind, ready)
                               for client, verb in zip(pair.clients, verbs)))
                continue
            pair.at_once(*(client.publish if draw.random() < 0.15 else client.call for client in pair.clients))
            self.assertIsNone(self.node.process.poll(), self.node.output)

    def paint(self, pair, draw):
        """A stroke of each client, dab by dab at the same time. Where both are taken back and no step is made meanwhile, the
        state is that of before."""
        stands = draw.random() < 0.7
        if stands:
            self.expect(self.node.call("pause", Trigger))
        before = self.node.call("step", Step, 0).state_hash
        strokes = [client.stroke() for client in pair.clients]
        most = max(len(calls) for calls, _ in strokes)
        for n in range(most):
            pair.at_once(*(None if n >= len(calls) else lambda ready, c=client, call=calls[n]: c.paint(*call, ready)
                           for client, (calls, _) in zip(pair.clients, strokes)))
        if stands and not any(there for _, there in strokes):
            self.assertEqual(self.node.call("step", Step, 0).state_hash, before, "both strokes were undone")
            self.taken_back += 1
        names = [calls[0][1].stroke for calls, _ in strokes]
        counts = between(self.file("journal").decode(), names)
        self.assertGreater(min(counts), 0, "no dab of one stroke was taken between those of the other")
        self.dabs_between += sum(counts)

    def expect_repeatable(self, pair):
        """The journal that replays is the one up to the last dab that is painted here, before anything is loaded."""
        for client in pair.clients:
            client.wait_for_winds()  # or they could arrive between the calls
        self.expect(self.node.call("pause", Trigger))
        first = pair.clients[0]
        first.paint(*first.stroke()[0][0], lambda: None)
        name, folder = first.new_name(), first.new_name()
        saved = self.expect(self.node.call("save_checkpoint", SaveCheckpoint, name))
        self.assertEqual(self.expect(self.node.call("save_scenario", SaveScenario, folder)).state_hash, saved.state_hash)
        for volume in self.node.latest("status", SimulationStatus).volumes:
            self.assertEqual(volume.residual, 0, volume)
        shutil.copy(self.path("journal"), self.path("journal.copy"))
        self.assertEqual(self.run_without_ros(OASIS, "--replay", self.path("journal.copy")), saved.state_hash, "replay")
        scene = self.expect(self.node.call("load_scenario", LoadScenario, folder, []))
        self.assertEqual(scene.state_hash, saved.state_hash, "the saved scenario")
        loaded = self.expect(self.node.call("load_checkpoint", LoadCheckpoint, name))
        again = self.expect(self.node.call("save_checkpoint", SaveCheckpoint, "again.ckpt"))
        self.assertEqual((loaded.state_hash, again.state_hash), (saved.state_hash, saved.state_hash))
        headers = [self.file(file)[:20000].split(b"\n...\n")[0].decode("ascii", "replace").split("\n") for file in (name, "again.ckpt")]
        different = "\n".join(difflib.unified_diff(*headers, lineterm="", n=0))
        self.assertTrue(self.file("again.ckpt") == self.file(name), different[:3000])

    def expect_loadable_terrain(self, pair, draw):
        name = pair.clients[1].new_name()
        form = draw.choice(["geotiff", "rosbag", "png16"])
        self.expect(self.node.call("save_terrain", SaveTerrain, name, form))
        self.expect(self.node.call("load_terrain", LoadTerrain, name, False))

    def one_round(self, pair, draw):
        self.paint(pair, draw)
        self.random_calls(pair, draw)
        self.expect_repeatable(pair)
        if draw.random() < 0.2:
            self.expect_loadable_terrain(pair, draw)
        if draw.random() < 0.5:
            self.expect(self.node.call("resume", Trigger))

    def drive(self, seed, rounds):
        """A node of its own, with two clients."""
        for name, path in SCENARIOS.items():
            shutil.copy(path, os.path.join(self.folder, name))
        journal = self.path("journal")
        self.node = self.start(NODE, {"scenario": OASIS, "journal": journal, "data_dir": self.folder, "step_rate": 20})
        names = {"checkpoint": [], "terrain": [], "scenario": []}
        pair = Pair([Caller(self.node, client, seed, names) for client in CLIENTS])
        listened = {topic for topic, nodes in rosgraph.Master("/random_calls").getSystemState()[1] if "/" + NODE in nodes}
        self.assertEqual(listened - {"/clock"}, set(TOPICS), "a topic has no generator")
        self.assertEqual(self.without_generator(pair.clients[0]), set())
        draw = random.Random(seed)
        for n in range(rounds):
            try:
                self.one_round(pair, draw)
            except Exception as fault:
                raise AssertionError("seed %d, round %d: %s\n%s" % (seed, n, fault, pair.log())) from fault
        self.expect(self.node.call("pause", Trigger))
        live = self.expect(self.node.call("step", Step, 1)).state_hash
        pair.close()
        self.assertEqual(self.node.end()[0], 0, self.node.output)
        self.assertEqual(self.run_without_ros(OASIS, "--replay", journal), live, "seed %d: replay at the end" % seed)
        return pair

    def without_generator(self, caller):
        """Services whose requests would be filled with words that mean nothing."""
        known = {"apply_settings", "edit_plants", "edit_terrain", "edit_wind", "export_terrain", "get_grid_map", "get_scenario",
                 "get_submap", "load_checkpoint", "load_scenario", "load_terrain", "new_scenario", "pause", "query_terrain", "redo",
                 "reload_parameters", "reset", "resume", "save_checkpoint", "save_scenario", "save_terrain",
                 "set_parameters", "set_weather", "set_wind", "set_wind_schedule", "step", "undo"}
        return known.symmetric_difference(caller.services)

    def test_what_is_accepted_can_be_repeated(self):
        accepted, refused, together = {}, {}, 0
        self.taken_back = self.dabs_between = 0
        for seed in range((ROUNDS + ROUNDS_OF_A_NODE - 1) // ROUNDS_OF_A_NODE):
            pair = self.drive(seed, min(ROUNDS - seed * ROUNDS_OF_A_NODE, ROUNDS_OF_A_NODE))
            together += pair.both_accepted
            for client in pair.clients:
                for counts, more in ((accepted, client.accepted), (refused, client.refused)):
                    for service, count in more.items():
                        counts[service] = counts.get(service, 0) + count
            shutil.rmtree(self.folder)
            os.mkdir(self.folder)
        print("accepted: %s\nrefused: %s\npairs of which both were accepted: %d; dabs between those of the other client: %d; "
              "pairs of strokes taken back to the state of before: %d" % (accepted, refused, together, self.dabs_between, self.taken_back))
        self.assertGreater(sum(accepted.values()), 0.4 * (sum(accepted.values()) + sum(refused.values())))
        self.assertGreater(together, ROUNDS)


if __name__ == "__main__":
    rospy.init_node("random_calls", disable_signals=True)
    rostest.rosrun("desert_sim", "random_calls", RandomCalls)
