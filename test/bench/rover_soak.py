#!/usr/bin/env python3
"""Many rovers on one living desert for an hour, on two cores: they drive about at random, a tenth of what they are told is
malformed, one of the first half is killed with SIGKILL and started anew in each tenth of the time, and each that cannot go
on is put down elsewhere. Some are led by planners from goal to goal instead, every other one through forecasts. After
`. build/devel/setup.bash`:

    test/bench/rover_soak.py [--minutes 60] [--rovers 10] [--planners 2] [--size 512]

It fails (exit status 1) if
  - resident memory of the simulation, of a planner or of a rover that was never killed is, in the last quarter, more than 5 %
    (and 8 MiB) above that of the second one (medians), or they have more threads or open files at the end than after a quarter;
  - a node ends by itself, a rover or a planner is silent for ten seconds, or a malformed request is taken;
  - a planner ends a goal otherwise than by arriving and says no reason, reaches no end at all, or repairs a field wrongly;
  - a rover stands though it is told to drive, and does not say why: "nothing is stuck but wheels";
  - wheels are more than a centimetre off the ground that the rover has of the terrain;
  - the mass residual is not 0.
Memory is judged in runs of four minutes and more: before, an allocator's pools still fill.
"""
import argparse
import collections
import os
import sys
import tempfile
import time

from live_node import LiveNode, cpu_seconds, median
from soaked_rovers import PlannedRover, Rover, Usage

JUDGED = 4  # minutes
PARTS = 10


class Soak:
    def __init__(self, arguments):
        self.minutes, self.size, self.count, self.faults = arguments.minutes, arguments.size, arguments.rovers, []
        self.planners, self.usage = arguments.planners, Usage()

    def expect(self, fine, what):
        if not fine:
            self.faults.append(what)

    def run(self):
        with tempfile.TemporaryDirectory() as folder:
            private = {"scenario": "rover_barchans", "paused": False, "keyframe_rate": 0.0, "update_rate": 10.0,
                       "journal": os.path.join(folder, "journal"),
                       "settings": ["grid.width=%d" % self.size, "grid.height=%d" % self.size]}
            with LiveNode(private, subscribers=0) as live:
                self.rovers = [Rover("r%d" % n, self.size, n) for n in range(self.count - self.planners)]
                self.planned = [PlannedRover("p%d" % n, self.size, self.count + n, ("forecast", "field")[n % 2])
                                for n in range(self.planners)]
                self.rovers += self.planned
                try:
                    self.drive(live)
                finally:
                    for rover in self.rovers:
                        rover.end()
        self.judge()

    def drive(self, live):
        before = live.status()
        for part in range(PARTS):
            poses = sum(rover.poses for rover in self.rovers)
            cpu, begin = self.cpu(live), time.monotonic()
            self.run_part(live, begin + 60 * self.minutes / PARTS)
            took = time.monotonic() - begin
            cpu = [(b - a) / took for a, b in zip(cpu, self.cpu(live))]
            print("%5.1f min  simulation %6.1f MiB %4.1f %%, rovers %6.1f MiB %4.1f %% each (medians), %.1f poses/s each" % (
                (part + 1) * self.minutes / PARTS, self.usage.memory[-1] / 2**20, 100 * cpu[0],
                median([rover.usage.memory[-1] for rover in self.rovers]) / 2**20, 100 * median(cpu[1:]),
                (sum(rover.poses for rover in self.rovers) - poses) / took / self.count), flush=True)
            self.rovers[part % max(1, self.count // 2)].kill()  # half of them live through all
            time.sleep(min(5, 6 * self.minutes))
        after = live.status()
        seconds = (after.header.stamp - before.header.stamp).to_sec()
        print("%d steps, %.2f a second (wanted: %.2f)" % (after.step - before.step, (after.step - before.step) / seconds,
                                                          after.step_rate))
        for volume in after.volumes:
            self.expect(volume.residual == 0, "residual of %s: %g" % (volume.material, volume.residual))

    def cpu(self, live):
        return [cpu_seconds("/proc/%d/stat" % process.pid)
                for process in [live.node.process] + [rover.process for rover in self.rovers]]

    def run_part(self, live, end):
        while time.monotonic() < end:
            for rover in self.rovers:
                for name, process, usage in rover.nodes():
                    if process.poll() is not None:
                        raise RuntimeError("%s ended with %d" % (name, process.poll()))
                    usage.look(process.pid)
                rover.act()
                self.faults += rover.faults()
            self.usage.look(live.node.process.pid)
            time.sleep(0.2)  # less than cmd_vel_timeout

    def judge(self):
        states = sum((rover.states for rover in self.rovers), collections.Counter())
        print("states: %s; put down elsewhere %d times; largest contact error %.2g m" % (
            ", ".join("%s %.1f %%" % (state, 100 * n / sum(states.values())) for state, n in states.most_common()),
            sum(rover.put_down for rover in self.rovers), max(rover.contact_error for rover in self.rovers)))
        for rover in self.rovers:
            self.expect(not rover.unexplained, "%s stood %d times without a reason" % (rover.name, rover.unexplained))
            self.expect(not rover.taken_though_malformed, "%s took %d malformed requests" % (
                rover.name, rover.taken_though_malformed))
            self.expect(rover.contact_error < 0.01, "%s: contact error %g m" % (rover.name, rover.contact_error))
            self.expect(rover.poses > 0, "%s sent no pose" % rover.name)
        for rover in self.planned:
            print("%s: goals %s; %d replans; %d malformed goals refused" % (
                rover.name, ", ".join("%s %d" % end for end in rover.ends.most_common()), rover.replans, rover.refused))
        if self.minutes < JUDGED:
            return
        nodes = [("simulation", None, self.usage)]
        for rover in self.rovers:
            nodes += [] if rover.killed else rover.nodes()
        for rover in self.planned:
            self.expect(rover.ends, "%s's planner came to no end" % rover.name)
            self.expect(rover.refused, "%s's planner refused nothing" % rover.name)
        for name, _, usage in nodes:
            line, grown = usage.judged(name)
            print(line)
            self.faults += grown


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", type=float, default=60)
    parser.add_argument("--rovers", type=int, default=10)
    parser.add_argument("--planners", type=int, default=2, help="of the rovers, led by planners")
    parser.add_argument("--size", type=int, default=512)
    soak = Soak(parser.parse_args())
    soak.run()
    for fault in sorted(set(soak.faults)):
        print("FAILED: " + fault)
    return 1 if soak.faults else 0


if __name__ == "__main__":
    sys.exit(main())
