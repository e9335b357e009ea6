#!/usr/bin/env python3
"""A node at full speed on two cores with three subscribers, services called and forecasts begun all the time, for ten
minutes: memory and latency must not grow, nothing may be lost, the books must close. After `. build/devel/setup.bash`:

    test/bench/soak.py [--minutes 10] [--size 512]

It fails (exit status 1) if
  - resident memory in the last quarter is more than 5 % (and 8 MiB) above that of the second one (medians);
  - the 99th percentile of updates' latency in the second half is more than twice that in the first half (medians of the
    tenths' percentiles: what else the machine does in one of them counts little);
  - the node has more threads or open files at the end than after the first quarter (by more than 4);
  - the journal has more than 1 KiB for each command;
  - a subscriber missed a message, or was sent nothing in a tenth of the time;
  - a subscriber refused a message, a call was refused, or the mass residual is not 0.
Memory, latency and what subscribers missed are judged in runs of two minutes and more: before, an allocator's pools still
fill, and a busy machine holds a process up for longer than a tenth of the time.
"""
import argparse
import itertools
import os
import sys
import tempfile
import time

import rospy
from actionlib import ActionClient
from desert_sim.msg import ForecastTerrainAction, ForecastTerrainGoal
from desert_sim.srv import EditTerrain, EditTerrainRequest, GetSubmap, QueryTerrain, SetWind, Step
from geometry_msgs.msg import Point
from live_node import LiveNode, median, quantile
from std_srvs.srv import TriggerResponse

JUDGED = 2  # minutes
PARTS = 10


class Calls:
    """Services in turn, over connections that stay."""

    def __init__(self, size):
        self.center, self.turn, self.commands = size / 2, itertools.count(), 0
        proxies = {name: rospy.ServiceProxy("/desert_sim/" + name, kind, persistent=True) for name, kind in (
            ("set_wind", SetWind), ("edit_terrain", EditTerrain), ("query_terrain", QueryTerrain), ("step", Step),
            ("get_submap", GetSubmap))}
        # Not SimpleActionClient: an answer that comes before its send_goal() has returned is lost to it.
        self.forecasts, self.goal = ActionClient("/desert_sim/forecast", ForecastTerrainAction), None
        self.call = [
            self.forecast,
            lambda: proxies["set_wind"](speed=3 + next(self.turn) % 3, direction_deg=0),
            lambda: proxies["edit_terrain"](self.brush("add")),
            lambda: proxies["query_terrain"](points=[Point(self.center, self.center, 0)] * 100),
            lambda: proxies["edit_terrain"](self.brush("sub")),
            lambda: proxies["get_submap"](center=Point(self.center, self.center, 0), length_x=40, length_y=40,
                                          layers=["elevation", "slope"]),
            lambda: proxies["step"](2)]
        self.order = itertools.cycle(range(len(self.call)))

    def forecast(self):
        """Begins one, which preempts the one before."""
        self.goal = self.forecasts.send_goal(ForecastTerrainGoal(horizon=1000, moments=5))
        return TriggerResponse(success=True)

    def brush(self, merge):
        request = EditTerrainRequest(layer="sand", shape="circle", merge=merge, radius=6, inner=0.5, value=0.5)
        request.center.x = request.center.y = self.center
        return request

    def next(self):
        """What went wrong, if anything."""
        n = next(self.order)
        self.commands += n in (1, 2, 4)
        answer = self.call[n]()
        return "" if answer.success else answer.message


class Soak:
    def __init__(self, minutes, size):
        self.minutes, self.size, self.faults = minutes, size, []
        self.memory, self.open_files, self.threads, self.sent = [], [], [], []

    def expect(self, fine, what):
        if not fine:
            self.faults.append(what)

    def look(self, live):
        process = "/proc/%d" % live.node.process.pid
        self.memory.append(live.memory())
        self.open_files.append(len(os.listdir(process + "/fd")))
        self.threads.append(len(os.listdir(process + "/task")))

    def run(self):
        with tempfile.TemporaryDirectory() as folder:
            journal = os.path.join(folder, "journal")
            private = {"scenario": "barchan", "paused": False, "step_rate": 0, "keyframe_rate": 1.0, "update_rate": 10.0,
                       "update_threshold": 0.01, "journal": journal,
                       "settings": ["grid.width=%d" % self.size, "grid.height=%d" % self.size]}
            with LiveNode(private) as live:
                calls = Calls(self.size)
                live.subscribe()
                time.sleep(2)
                live.sent()
                before = live.status()
                for part in range(PARTS):
                    self.run_part(live, calls)
                    print("%4.1f min  %6.1f MiB  %s" % (
                        (part + 1) * self.minutes / PARTS, self.memory[-1] / 2**20, self.described(self.sent[-1])), flush=True)
                self.judge_end(before, live.status(), calls.commands, os.path.getsize(journal))
        self.judge()

    def run_part(self, live, calls):
        end = time.monotonic() + 60 * self.minutes / PARTS
        while time.monotonic() < end:
            refusal = calls.next()
            self.expect(not refusal, "a call was refused: " + refusal)
            self.look(live)
            time.sleep(0.5)
        self.sent.append(live.sent())

    @staticmethod
    def latencies(sent):
        return [1e3 * latency for subscriber in sent for latency in subscriber["latencies"]]

    def described(self, sent):
        latencies = self.latencies(sent)
        return "%5d updates, latency %.1f ms median, %.1f p99, %.1f max" % (
            len(latencies), median(latencies), quantile(latencies, 0.99), max(latencies, default=float("nan")))

    def judge_end(self, before, after, commands, journal):
        print("%d steps, %.1f a second; journal: %d bytes for %d commands" % (
            after.step - before.step, (after.step - before.step) / (after.header.stamp - before.header.stamp).to_sec(),
            journal, commands))
        self.expect(journal < 1024 * (commands + 1), "the journal has %d bytes for %d commands" % (journal, commands))
        for volume in after.volumes:
            self.expect(volume.residual == 0, "residual of %s: %g" % (volume.material, volume.residual))

    def judge(self):
        quarter = len(self.memory) // 4
        for name, counts in (("threads", self.threads), ("open files", self.open_files)):
            print("%s: %d, %d at the end" % (name, counts[quarter], counts[-1]))
            self.expect(counts[-1] <= counts[quarter] + 4, "%s grew from %d to %d" % (name, counts[quarter], counts[-1]))
        for subscriber in sum(self.sent, []):
            self.expect(subscriber["refused"] == 0, "%d refused messages" % subscriber["refused"])
        self.expect(any(subscriber["updates"] for subscriber in sum(self.sent, [])), "no updates at all")
        early, late = median(self.memory[quarter:2 * quarter]), median(self.memory[-quarter:])
        percentiles = [quantile(self.latencies(sent), 0.99) for sent in self.sent]
        first, second = median(percentiles[:PARTS // 2]), median(percentiles[PARTS // 2:])
        print("memory: %.1f MiB in the second quarter, %.1f in the last one; 99th percentile of the latency: %.1f ms in the "
              "first half, %.1f in the second" % (early / 2**20, late / 2**20, first, second))
        if self.minutes < JUDGED:
            return
        for part, sent in enumerate(self.sent):
            for subscriber in sent:
                self.expect(subscriber["updates"] > 0, "part %d: a subscriber was sent no updates" % part)
                self.expect(subscriber["gaps"] == 0, "part %d: %d gaps" % (part, subscriber["gaps"]))
        self.expect(late - early < max(0.05 * early, 8 * 2**20), "memory grew from %d to %d bytes" % (early, late))
        self.expect(second < 2 * first, "the 99th percentile of the latency grew from %.1f to %.1f ms" % (first, second))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", type=float, default=10)
    parser.add_argument("--size", type=int, default=512)
    arguments = parser.parse_args()
    soak = Soak(arguments.minutes, arguments.size)
    soak.run()
    for fault in soak.faults:
        print("FAILED: " + fault)
    return 1 if soak.faults else 0


if __name__ == "__main__":
    sys.exit(main())
