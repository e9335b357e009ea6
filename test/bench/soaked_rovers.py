"""The rovers of rover_soak.py: told to drive about at random, or led by a planner from goal to goal."""
import collections
import math
import os
import random
import subprocess
import threading
import time

import rospy
from desert_sim.msg import PlannerStatus, RoverStatus
from desert_sim.srv import SetRoverPose
from geometry_msgs.msg import Pose2D, PoseStamped, Twist
from live_node import median, program
from nav_msgs.msg import Odometry
from std_srvs.srv import Trigger

SILENCE = 10  # seconds
GIVE_UP = 20  # seconds in one place in the same state
MALFORMED = 0.1


class Usage:
    """Memory [bytes], threads and open files of a process over time."""

    def __init__(self):
        self.memory, self.threads, self.open_files = [], [], []

    def look(self, pid):
        process = "/proc/%d" % pid
        with open(process + "/statm") as file:
            self.memory.append(int(file.read().split()[1]) * os.sysconf("SC_PAGESIZE"))
        self.threads.append(len(os.listdir(process + "/task")))
        self.open_files.append(len(os.listdir(process + "/fd")))

    def judged(self, name):
        """A line about it, and what grew."""
        quarter = len(self.memory) // 4
        early, late = median(self.memory[quarter:2 * quarter]), median(self.memory[-quarter:])
        line = "%s: %.1f MiB in the second quarter, %.1f in the last one; threads %d, %d; open files %d, %d" % (
            name, early / 2**20, late / 2**20, self.threads[quarter], self.threads[-1], self.open_files[quarter],
            self.open_files[-1])
        grown = ["%s: %s grew" % (name, what) for what, grew in (
            ("memory", late - early >= max(0.05 * early, 8 * 2**20)),
            ("threads", self.threads[-1] > self.threads[quarter] + 4),
            ("open files", self.open_files[-1] > self.open_files[quarter] + 4)) if grew]
        return line, grown


class Rover:
    """One rover's node, and what drives it."""

    def __init__(self, name, size, seed):
        self.name, self.size, self.draw = name, size, random.Random(seed)
        self.lock, self.states, self.poses = threading.Lock(), collections.Counter(), 0
        self.status, self.heard, self.since, self.killed = None, time.monotonic(), None, False
        self.usage, self.unexplained, self.contact_error = Usage(), 0, 0.0
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
            able = status.state in (RoverStatus.IDLE, RoverStatus.DRIVING) and status.mean_slip < 0.9
            if able and self.heard - self.moved > 5:
                self.unexplained += 1

    def act(self):
        """Told anew now and then, malformed sometimes."""
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
        self.lift_up(now)

    def lift_up(self, now):
        """Put down elsewhere where it cannot go on."""
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

    def faults(self):
        """What is wrong now."""
        silence = time.monotonic() - self.heard
        return ["%s is silent for %.0f s" % (self.name, silence)] if silence >= SILENCE else []

    def nodes(self):
        """Name, process and usage of each of its nodes."""
        return [(self.name, self.process, self.usage)]

    def kill(self):
        self.process.kill()
        self.process.wait()
        self.killed = True
        self.start()

    def end(self):
        if self.process.poll() is None:
            self.process.terminate()
            self.process.wait(20)


class PlannedRover(Rover):
    """A rover that a planner leads from one place to another; some goals are malformed, some are given up."""

    def __init__(self, name, size, seed, planner):
        self.planner_usage, self.planner_heard, self.planner_status = Usage(), time.monotonic(), None
        self.ends, self.replans, self.refused, self.wrong = collections.Counter(), 0, 0, []
        self.asked, self.malformed, self.new_goal = None, None, 0
        node = "/%s/desert_planner" % name
        rospy.set_param(node, {"planner": planner, "tf_prefix": name, "time_limit": 120, "no_path_patience": 20,
                               "buried_patience": 20, "forecast_period": 20, "forecast_horizon": 60, "pose_age": 5})
        self.goals = rospy.Publisher("/%s/move_base_simple/goal" % name, PoseStamped, queue_size=1)
        rospy.Subscriber(node + "/status", PlannerStatus, self.take_planner_status, queue_size=100)
        super().__init__(name, size, seed)
        self.commands.unregister()  # the planner alone commands

    def start(self):
        super().start()
        if not hasattr(self, "planner"):
            self.planner = subprocess.Popen([program("desert_planner_node"), "__ns:=/" + self.name],
                                            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def take_planner_status(self, status):
        with self.lock:
            self.planner_heard = time.monotonic()
            ended = status.state in (PlannerStatus.ARRIVED, PlannerStatus.NO_PATH, PlannerStatus.STUCK, PlannerStatus.BURIED,
                                     PlannerStatus.TIPPED, PlannerStatus.TIMED_OUT, PlannerStatus.CANCELLED)
            if self.asked is not None and self.is_goal(status, self.asked) and ended:
                self.asked = None
                self.ends[status.state] += 1
                self.replans += status.replans
                if status.state != PlannerStatus.ARRIVED and not status.reason:
                    self.wrong.append("%s: %s without a reason" % (self.name, status.state))
            if self.malformed is not None and status.refusal:
                self.malformed = None
                self.refused += 1
            self.planner_status = status

    @staticmethod
    def is_goal(status, place):
        return math.hypot(status.goal.pose.position.x - place[0], status.goal.pose.position.y - place[1]) < 1e-3

    def send(self, x, y, frame="map"):
        goal = PoseStamped()
        goal.header.frame_id = frame
        goal.pose.position.x, goal.pose.position.y, goal.pose.orientation.w = x, y, 1
        self.goals.publish(goal)

    def act(self):
        """A goal some metres off when the last one has ended, now and then before; malformed ones between."""
        now = time.monotonic()
        with self.lock:
            if self.malformed is not None and now - self.malformed > SILENCE:
                self.malformed = None
                self.wrong.append("%s: a malformed goal was not refused" % self.name)
            idle, status = self.asked is None, self.status
            waits = self.malformed is not None
        connected = self.planner_status is not None and self.goals.get_num_connections() > 0
        if status is None or not connected or waits or now < self.new_goal:
            return
        if self.draw.random() < MALFORMED:
            with self.lock:
                self.malformed = now
            self.send(*self.draw.choice([(math.nan, 0), (1e9, 0), (0, -math.inf)]), self.draw.choice(["map", "nowhere"]))
        elif not idle and self.draw.random() < MALFORMED / 10:
            rospy.ServiceProxy("/%s/desert_planner/cancel" % self.name, Trigger)()
        elif idle:
            place = self.somewhere(), self.somewhere()
            with self.lock:
                self.asked = place
            self.send(*place)
        self.new_goal = now + self.draw.uniform(0.5, 2)
        self.lift_up(now)

    def faults(self):
        with self.lock:
            wrong, self.wrong = self.wrong, []
        silence = time.monotonic() - self.planner_heard
        if silence >= SILENCE:
            wrong.append("%s's planner is silent for %.0f s" % (self.name, silence))
        if self.planner_status is not None and self.planner_status.field_differences:
            wrong.append("%s's planner repaired a field wrongly" % self.name)
        return super().faults() + wrong

    def nodes(self):
        return super().nodes() + [(self.name + "'s planner", self.planner, self.planner_usage)]

    def end(self):
        super().end()
        if self.planner.poll() is None:
            self.planner.terminate()
            self.planner.wait(20)
