#!/usr/bin/env python3
"""How far the wheels of a rover on living dunes are from where the ground holds them. A node with a scenario for rovers and
a rover that drives at 10 cm/s run live for two minutes; then the node makes the same steps again, and the ground of each
is compared with the poses that were published while it lasted. After `. build/devel/setup.bash`:

    test/bench/contact_error.py [--scenario rover_barchans] [--set run.acceleration=0.09]... [--row 64] [--seconds 120]
                                [--speed 0.1] [--publishers config/rover_publishers.yaml] [--limit 0.01]

For each pose on ground_truth and each wheel

    error = (lowest point of the wheel) + (its sinkage) - (height at which a disc stands on the ground)

with the wheels by pose, joint_states and robot_description, and the sinkage by ~status of the same moment. The ground is
that of the newest state whose stamp is not after the pose's; a second line has it as straight in time from this state to
the next one. It is asked of ~get_submap, bilinear between the centres of cells, and is not what the rover was sent. What
is left is the time until the rover has a state, what updates leave out (update_threshold), and what the suspension does
not reach in a step.

It drives on the highest dune of a row (y = --row), a sixth of the time each: down its slip face, up the windward slope,
along the slip face, along its foot, along the crest, and up the slip face. The exit status is 1 if an error is beyond
--limit [m], or if half of the 50 poses a second are missing.
"""
import argparse
import math
import os
import subprocess
import sys
import time

import numpy as np
import rospy
import yaml
from desert_sim.msg import ElevationUpdate, RoverStatus
from desert_sim.srv import GetSubmap, QueryTerrain, SetRoverPose, Step
from geometry_msgs.msg import Point, Pose2D, Twist
from live_node import PACKAGE, LiveNode, Trigger, program
from nav_msgs.msg import Odometry
from robot_model import RobotModel
from sensor_msgs.msg import JointState

RATE = 50  # poses a second, the default of the rover's parameter
SETTLING = 0.5  # seconds at the begin of a leg, while the rover is put there and its first command is on the way


def service(name, kind, **fields):
    rospy.wait_for_service(name, 30)
    answer = rospy.ServiceProxy(name, kind)(**fields)
    if not answer.success:
        raise SystemExit("%s: %s" % (name, answer.message))
    return answer


class Recording:
    """What the rover published, and when the desert reached its states."""

    def __init__(self):
        self.poses, self.joints, self.status, self.states = [], {}, [], {}
        rospy.Subscriber("ground_truth", Odometry, self.poses.append)
        rospy.Subscriber("joint_states", JointState, lambda m: self.joints.setdefault(m.header.stamp, m))
        rospy.Subscriber("desert_rover/status", RoverStatus, self.status.append)
        rospy.Subscriber("desert_sim/elevation_updates", ElevationUpdate,
                         lambda m: self.states.setdefault(m.step, m.header.stamp.to_sec()))

    def complete_poses(self, legs):
        """Lists (leg, pose, joints, status) of poses in legs, begin and end [s] by name."""
        status = sorted(self.status, key=lambda m: m.header.stamp)
        told = np.array([m.header.stamp.to_sec() for m in status])
        found = []
        for pose, following in zip(self.poses, self.poses[1:]):
            t = pose.header.stamp.to_sec()
            leg = next((name for name, (begin, end) in legs.items() if begin <= t < end), None)
            n = np.searchsorted(told, t)  # a status is told after its pose and before the next one
            if leg and pose.header.stamp in self.joints and n < len(told) and told[n] < following.header.stamp.to_sec():
                found.append((leg, pose, self.joints[pose.header.stamp], status[n]))
        return found


class Rover:
    """A desert_rover_node that tells its status with each pose."""

    def __init__(self):
        rospy.set_param("/desert_rover", {"status_rate": 1000.0, "lidar": {"rate": 0}, "depth_camera": {"rate": 0}})
        self.command = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        self.process = subprocess.Popen([program("desert_rover_node"), "__name:=desert_rover"])
        self.wait(lambda m: m.state == RoverStatus.IDLE)

    @staticmethod
    def wait(wanted, seconds=30):
        end = time.monotonic() + seconds
        while not wanted(rospy.wait_for_message("desert_rover/status", RoverStatus, seconds)):
            if time.monotonic() > end:
                raise SystemExit("the rover does not start")

    def drive(self, place, speed, seconds):
        """From (x, y, yaw) on; the interval that counts [s]."""
        service("desert_rover/set_pose", SetRoverPose, pose=Pose2D(*place))
        command = Twist()
        command.linear.x = speed
        begin = rospy.Time.now().to_sec()
        while rospy.Time.now().to_sec() < begin + seconds:
            self.command.publish(command)
            time.sleep(0.1)
        return begin + min(SETTLING, seconds / 2), rospy.Time.now().to_sec()

    def close(self):
        self.process.terminate()
        self.process.wait(20)


class Dune:
    """The highest one of a row, and where a rover begins each leg on it."""

    def __init__(self, row):
        self.row = row

    def profile(self):
        places = [Point(x, self.row, 0) for x in np.arange(0, 2000, 0.25)]
        samples = [s for s in service("desert_sim/query_terrain", QueryTerrain, points=places).samples if s.in_bounds]
        return np.array([s.position.x for s in samples]), np.array([s.sand for s in samples])

    def start(self, leg):
        x, sand = self.profile()
        crest = int(sand.argmax())
        bare = np.flatnonzero(sand < 0.1)
        windward, foot = x[bare[bare < crest].max()], x[bare[bare > crest].min()]
        face = (x[crest] + foot) / 2
        north = math.pi / 2
        return {"down the slip face": (x[crest] + 0.5, self.row, 0),
                "up the windward slope": (windward - 0.5, self.row, 0),
                "along the slip face": (face, self.row - 1, north),
                "along its foot": (foot - 0.5, self.row - 1, north),
                "along the crest": (x[crest] - 0.5, self.row - 1, north),
                "up the slip face": (foot + 0.5, self.row, math.pi)}[leg]

    LEGS = ("down the slip face", "up the windward slope", "along the slip face", "along its foot", "along the crest",
            "up the slip face")


class Truth:
    """The same steps once more, and how high a wheel stands on the ground of each."""

    RIM = np.sin(np.linspace(-0.5, 0.5, 121) * math.pi)

    def __init__(self):
        service("desert_sim/pause", Trigger)
        self.end = service("desert_sim/step", Step, steps=0)
        service("desert_sim/reset", Trigger)
        self.now = service("desert_sim/step", Step, steps=0)

    def go_to(self, step):
        if step > self.now.step:
            self.now = service("desert_sim/step", Step, steps=step - self.now.step)

    def check_end(self):
        """Whether the states were those of the live run."""
        self.go_to(self.end.step)
        if self.now.state_hash != self.end.state_hash:
            raise SystemExit("step %d was %s live and is %s now" % (self.end.step, self.end.state_hash, self.now.state_hash))

    def support(self, x, y, yaw, radius):
        """Of discs with hubs over (x, y) along yaw: max over u of h(x + u cos yaw, y + u sin yaw) + (r^2 - u^2)^1/2 - r."""
        u = radius * self.RIM
        px, py = x[:, None] + np.cos(yaw)[:, None] * u, y[:, None] + np.sin(yaw)[:, None] * u
        low, high = (px.min() - 2, py.min() - 2), (px.max() + 2, py.max() + 2)
        m = service("desert_sim/get_submap", GetSubmap, center=Point((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, 0),
                    length_x=high[0] - low[0], length_y=high[1] - low[1], layers=["elevation"]).map
        if m.step != self.now.step:
            raise SystemExit("asked for step %d, got step %d" % (self.now.step, m.step))
        h = np.array(m.layers[0].data).reshape(m.height, m.width)
        cx, cy = (px - m.origin.position.x) / m.cell_size - 0.5, (py - m.origin.position.y) / m.cell_size - 0.5
        i, j = np.floor(cx).astype(int), np.floor(cy).astype(int)
        a, b = cx - i, cy - j
        ground = (1 - b) * ((1 - a) * h[j, i] + a * h[j, i + 1]) + b * ((1 - a) * h[j + 1, i] + a * h[j + 1, i + 1])
        return (ground + np.sqrt(radius**2 - u**2)).max(axis=1) - radius


def judge(complete, model, stamps, truth):
    """Errors against the newest state and between states, and how fast the ground rose [m, m, m/s]: one row a pose, one
    column a wheel."""
    poses = np.array([[p.position.x, p.position.y, p.position.z, p.orientation.x, p.orientation.y, p.orientation.z,
                       p.orientation.w] for p in (pose.pose.pose for _, pose, _, _ in complete)])
    t = np.array([pose.header.stamp.to_sec() for _, pose, _, _ in complete])
    joints = {name: np.array([m.position[m.name.index(name)] for _, _, m, _ in complete]) for name in complete[0][2].name}
    x, y, z, w = poses[:, 3:].T
    yaw = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    wheels = list(model.wheels)
    hubs = np.stack([model.hubs(wheel, poses, joints) for wheel in wheels], axis=1)
    radius = model.wheels[wheels[0]][0]
    sunk = np.array([[m.sinkage[m.wheels.index(wheel)] for wheel in wheels] for _, _, _, m in complete])
    held = hubs[:, :, 2] - radius + sunk
    state = np.searchsorted(stamps, t, side="right") - 1  # its index is its step
    ground = np.empty((2,) + held.shape)
    for step in range(int(state.min()), int(state.max()) + 2):
        for following in (0, 1):
            of_step = np.flatnonzero(state + following == step)
            if len(of_step):
                truth.go_to(step)
                hub = hubs[of_step].reshape(-1, 3)
                support = truth.support(hub[:, 0], hub[:, 1], np.repeat(yaw[of_step], len(wheels)), radius)
                ground[following, of_step] = support.reshape(-1, len(wheels))
    length = (stamps[state + 1] - stamps[state])[:, None]
    rise = (ground[1] - ground[0]) / length
    between = ground[0] + rise * (t - stamps[state])[:, None]
    return held - ground[0], held - between, rise


def described(errors):
    sizes = 1000 * np.abs(errors)
    return "median %5.2f  p95 %5.2f  p99 %5.2f  largest %5.2f mm" % (*np.percentile(sizes, (50, 95, 99)), sizes.max())


def run(arguments):
    with open(arguments.publishers) as file:
        publishers = yaml.safe_load(file)
    private = dict(publishers, scenario=arguments.scenario, settings=arguments.set, paused=False)
    with LiveNode(private, subscribers=0) as live:
        rover = Rover()
        try:
            recording, dune, legs = Recording(), Dune(arguments.row), {}
            for leg in dune.LEGS:
                legs[leg] = rover.drive(dune.start(leg), arguments.speed, arguments.seconds / len(dune.LEGS))
            time.sleep(1)  # for the state after the last pose
            model = RobotModel(rospy.get_param("robot_description"))
        finally:
            rover.close()
        lag = live.status().lag
        truth = Truth()
        steps = sorted(recording.states)
        stamps = np.interp(np.arange(steps[-1] + 1), steps, [recording.states[step] for step in steps])
        complete = recording.complete_poses(legs)
        newest, between, rise = judge(complete, model, stamps, truth)
        truth.check_end()
    return legs, complete, stamps, lag, newest, between, rise


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenario", default="rover_barchans")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="of the scenario")
    parser.add_argument("--publishers", default=os.path.join(PACKAGE, "config", "rover_publishers.yaml"))
    parser.add_argument("--row", type=float, default=64, help="y of the dune [m]")
    parser.add_argument("--seconds", type=float, default=120)
    parser.add_argument("--speed", type=float, default=0.1, help="[m/s]")
    parser.add_argument("--limit", type=float, default=0.01, help="[m]")
    arguments = parser.parse_args()
    legs, complete, stamps, lag, newest, between, rise = run(arguments)
    seconds = sum(end - begin for begin, end in legs.values())
    rate = len(complete) / seconds
    age = [1000 * (pose.header.stamp.to_sec() - stamps[status.terrain_step]) for _, pose, _, status in complete]
    print("%s: %d poses of %d wheels in %.0f s (%.1f a second); %d states of the desert, lag %.2f s" % (
        arguments.scenario, len(complete), newest.shape[1], seconds, rate, len(stamps), lag))
    print("  the ground under the wheels moves by %.1f mm/s (median), %.1f (p95), %.1f (largest)" % tuple(
        1000 * q for q in (*np.percentile(np.abs(rise), (50, 95)), np.abs(rise).max())))
    print("  age of the rover's ground at a pose: median %.0f, p95 %.0f, largest %.0f ms" % (
        *np.percentile(age, (50, 95)), max(age)))
    print("  error, to the newest state %s" % described(newest))
    print("  error, between two states  %s" % described(between))
    of_leg = np.array([leg for leg, _, _, _ in complete])
    for leg in legs:
        states = sorted({status.state for name, _, _, status in complete if name == leg})
        print("    %-22s %s; %s" % (leg, described(newest[of_leg == leg]), ", ".join(states)))
    faults = []
    if np.abs(newest).max() > arguments.limit:
        faults.append("an error is beyond %g m" % arguments.limit)
    if rate < RATE / 2:
        faults.append("only %.1f poses a second" % rate)
    for fault in faults:
        print("FAILED: " + fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
