#!/usr/bin/env python3
"""Many rovers on one living desert for an hour, on two cores: they drive about at random, a tenth of what they are told is
malformed, one of the first half is killed with SIGKILL and started anew in each tenth of the
time, and each that cannot go on is put
down elsewhere. After `. build/devel/setup.bash`:

    test/bench/rover_soak.py [--minutes 60] [--rovers 10] [--size 512]

It fails (exit status 1) if
  - resident memory of the simulation or of a rover that was never killed is, in the last quarter, more than 5 % (and 8 MiB)
    above that of the second one (medians), or they have more threads or open files at the end than after a quarter;
  - a node ends by itself, a rover is silent for ten seconds, or a malformed request is taken;
  - a rover stands though it is told to drive, and does not say why: "nothing is stuck but wheels";
  - wheels are more than a centimetre off the ground that the rover has of the terrain;
  - the mass residual is not 0.
Memory is judged in runs of four minutes and more: before, an allocator's pools still fill.
"""
import argparse
import collections
import math
import os
import random
import subprocess
import sys
import tempfile
import threading
import time

import rospy
from desert_sim.msg import RoverStatus
from desert_sim.srv import SetRoverPose
from geometry_msgs.msg import Pose2D, Twist
from live_node import LiveNode, cpu_seconds, median, program
from nav_msgs.msg import Odometry

JUDGED = 4  # minutes
PARTS = 10
SILENCE = 10  # seconds
GIVE_UP = 20  # seconds in one place in the same state
MALFORMED = 0.1


def resident(pid):
    with open("/proc/%d/statm" % pid) as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGESIZE")


class Rover:
    """One rover's node, and what drives it."""

    def __init__(self, name, size, seed):
        self.name, self.size, self.draw = name, size, random.Random(seed)
        self.lock, self.states, self.poses = threading.Lock(), collections.Counter(), 0
        self.status, self.heard, self.since, self.killed = None, time.monotonic(), None, False
        self.memory, self.threads, self.open_files, self.unexplained, self.contact_error = [], [], [], 0, 0.0
        self.taken_though_malformed, self.put_down, self.place, self.moved = 0, 0, None, time.monotonic()
        self.commands = rospy.Publisher("/%s/cmd_vel" % name, Twist, queue_size=1)
        rospy.Subscriber("/%s/desert_rover/status" % name, RoverStatus, self.take_status, queue_size=10)
        rospy.Subscriber("/%s/odom" % name, Odometry, self.take_odometry, queue_size=10)
        rospy.set_param("/%s/desert_rover" % name, {
            "x": self.somewhere(), "y": self.somewhere(), "tf_prefix": name, "rover": {"seed": seed}})
        self.twist, self.until = Twist(), 0
        self.start()

    def start(self):
        self.process = subprocess.Popen([program("desert_rover_node"), "__ns:=/" + self.name], stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL)  # warnings of what was refused
        self.heard, self.since = time.monotonic(), None

    def somewhere(self):
        return self.draw.uniform(0.1, 0.9) * self.size / 2

    def take_odometry(self, _):
        with self.lock:
            self.poses += 1

    def take_status(self, status):
        with self.lock:
            self.heard = time.monotonic()
            self.states[status.state] += 1
            if self.since is None or self.status is None or self.status.state != status.state:
                self.since = self.heard
            self.status = status
            self.contact_error = max(self.contact_error, status.contact_error)
            way = status.way_made
            if self.place is None or abs(way - self.place) > 0.02:
                self.place, self.moved = way, self.heard
            # A rover that is told to go ahead makes way, or is in a state that says why it does not.
            if abs(status.command.linear.x) < 0.05:
                self.moved = self.heard
            if self.heard - self.moved > 5 and status.state in (RoverStatus.IDLE, RoverStatus.DRIVING) and status.mean_slip < 0.9:
                self.unexplained += 1

    def act(self):
        """Told anew now and then, malformed sometimes; put down elsewhere where it cannot go on."""
        now = time.monotonic()
        if now > self.until:
            self.until = now + self.draw.uniform(5, 20)
            self.twist = Twist()
            self.twist.linear.x = self.draw.choice([-0.15, 0.15, 0.3, 0.3])
            self.twist.angular.z = self.draw.choice([0, 0, -0.2, 0.2])
        if self.draw.random() < MALFORMED:
            bad = Twist()
            bad.linear.x = self.draw.choice([math.nan, math.inf, -math.inf])
            self.commands.publish(bad)
        else:
            self.commands.publish(self.twist)
        if self.draw.random() < MALFORMED / 5:
            self.set_pose(Pose2D(self.draw.choice([math.nan, -1e9, 1e300]), 0, 0), wanted=False)
        with self.lock:
            state, since = (self.status.state if self.status else None), self.since
        stands = state not in (None, RoverStatus.IDLE, RoverStatus.DRIVING)
        if stands and since is not None and now - since > GIVE_UP:
            if self.set_pose(Pose2D(self.somewhere(), self.somewhere(), self.draw.uniform(-3, 3)), wanted=True):
                self.put_down += 1
                with self.lock:
                    self.since = now

    def set_pose(self, pose, wanted):
        try:
            answer = rospy.ServiceProxy("/%s/desert_rover/set_pose" % self.name, SetRoverPose)(pose)
        except rospy.ServiceException:  # it has just been killed, or has no terrain yet
            return False
        self.taken_though_malformed += answer.success and not wanted
        return answer.success

    def look(self):
        process = "/proc/%d" % self.process.pid
        self.memory.append(resident(self.process.pid))
        self.threads.append(len(os.listdir(process + "/task")))
        self.open_files.append(len(os.listdir(process + "/fd")))

    def kill(self):
        self.process.kill()
        self.process.wait()
        self.killed = True
        self.start()

    def end(self):
        if self.process.poll() is None:
            self.process.terminate()
            self.process.wait(20)


class Soak:
    def __init__(self, arguments):
        self.minutes, self.size, self.count, self.faults = arguments.minutes, arguments.size, arguments.rovers, []
        self.memory, self.threads, self.open_files = [], [], []

    def expect(self, fine, what):
        if not fine:
            self.faults.append(what)

    def run(self):
        with tempfile.TemporaryDirectory() as folder:
            private = {"scenario": "rover_barchans", "paused": False, "keyframe_rate": 0.0, "update_rate": 10.0,
                       "journal": os.path.join(folder, "journal"),
                       "settings": ["grid.width=%d" % self.size, "grid.height=%d" % self.size]}
            with LiveNode(private, subscribers=0) as live:
                self.rovers = [Rover("r%d" % n, self.size, n) for n in range(self.count)]
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
                (part + 1) * self.minutes / PARTS, self.memory[-1] / 2**20, 100 * cpu[0],
                median([rover.memory[-1] for rover in self.rovers]) / 2**20, 100 * median(cpu[1:]),
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
                status = rover.process.poll()
                if status is not None:
                    self.expect(False, "%s ended with %d" % (rover.name, status))
                    rover.kill()
                rover.act()
                silence = time.monotonic() - rover.heard
                self.expect(silence < SILENCE, "%s is silent for %.0f s" % (rover.name, silence))
                rover.look()
            pid = live.node.process.pid
            self.memory.append(resident(pid))
            self.threads.append(len(os.listdir("/proc/%d/task" % pid)))
            self.open_files.append(len(os.listdir("/proc/%d/fd" % pid)))
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
        if self.minutes < JUDGED:
            return
        lasting = [rover for rover in self.rovers if not rover.killed]
        for name, node in [("simulation", self)] + [(rover.name, rover) for rover in lasting]:
            quarter = len(node.memory) // 4
            early, late = median(node.memory[quarter:2 * quarter]), median(node.memory[-quarter:])
            print("%s: %.1f MiB in the second quarter, %.1f in the last one; threads %d, %d; open files %d, %d" % (
                name, early / 2**20, late / 2**20, node.threads[quarter], node.threads[-1], node.open_files[quarter],
                node.open_files[-1]))
            self.expect(late - early < max(0.05 * early, 8 * 2**20), "%s: memory grew from %d to %d" % (name, early, late))
            self.expect(node.threads[-1] <= node.threads[quarter] + 4, "%s: threads grew" % name)
            self.expect(node.open_files[-1] <= node.open_files[quarter] + 4, "%s: open files grew" % name)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", type=float, default=60)
    parser.add_argument("--rovers", type=int, default=10)
    parser.add_argument("--size", type=int, default=512)
    soak = Soak(parser.parse_args())
    soak.run()
    for fault in sorted(set(soak.faults)):
        print("FAILED: " + fault)
    return 1 if soak.faults else 0


if __name__ == "__main__":
    sys.exit(main())
