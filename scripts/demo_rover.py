#!/usr/bin/env python3
"""A rover crosses a desert whose dunes march over its way, and climbs one of them; or, with --scenario flash_flood, is on its
way along a dry channel when a flood comes down it.

Without --live: desert, rover and planner without a window, in lockstep, faster than time passes. Prints a line every 20 s
of the rover's time, and in the end what came of it; leaves a picture and a film. Exit status 1, with the reason, if the
rover did not arrive.
--live: sets goals to the planner of a desert that runs (launch/demo_rover.launch), round and round.
"""
import argparse
import collections
import math
import random
import signal
import subprocess
import sys
import threading

import numpy
import rospy
from desert_sim import Simulation
from desert_sim.msg import PlannerStatus
from desert_sim.testing import Desert, Node
from geometry_msgs.msg import PoseStamped

FRAMES = 10  # of the film a second, each STEPS_A_FRAME steps
STEPS_A_FRAME = 5
FILM_SIZE = (1280, 720)
ENDS = (PlannerStatus.ARRIVED, PlannerStatus.NO_PATH, PlannerStatus.STUCK, PlannerStatus.BURIED, PlannerStatus.TIPPED,
        PlannerStatus.TIMED_OUT, PlannerStatus.CANCELLED)


# start      (x, y, yaw_deg) [m]
# goals      functions of the Simulation that give (x, y) [m]; the rover goes to one after another
# hours      hours of the desert in a second of the rover
# step       of the rover's time [s]
# rover, planner   parameters of their nodes
# legend     of pictures, beside the rover and its ways
Course = collections.namedtuple("Course", "start goals hours step rover planner legend")


def dunes(seed):
    """To the other side of the barchan in the middle, whose slip face moves over the ground between, and onto its crest."""
    draw = random.Random(seed)
    start, goal = (draw.uniform(100, 108), 42.0, 90.0), (draw.uniform(100, 108), 90.0)
    return Course(start, [lambda _: goal, summit], 1, 0.4, {"rover": {"seed": seed}}, {},
                  [("too steep or too loose", (60, 60, 190))])


def flood(seed):
    """Up a channel, and onto its bank."""
    return Course((236.0, 51.0, 180.0), [lambda _: (150.0, 62.0)], 1 / 3600, 0.5,
                  {"rover_class": "six_wheel_200kg", "rover": {"seed": seed}},
                  {"speed": 0.2, "forecast_speed": 0.2, "radius": 1.5, "forecast_moments": 20},
                  [("water", (200, 120, 40)), ("too steep", (60, 60, 190))])


COURSES = {"rover_barchans": dunes, "flash_flood": flood}


def summit(simulation):
    """The highest place [m] of the barchan in the middle on which a rover can stand: its crest, over the slip face. The
    dune moves on while it climbs, so that what was the crest is firm sand of the windward side by then."""
    layers = simulation.submap((100, 66), (60, 30), ["elevation", "traversability"])
    heights = numpy.where(layers["traversability"].cost() < 50, layers["elevation"].values, -numpy.inf)
    row, column = numpy.unravel_index(numpy.argmax(heights), heights.shape)
    ground = layers["elevation"]
    return ground.origin_x + (column + 0.5) * ground.cell_size, ground.origin_y + (row + 0.5) * ground.cell_size


class Planner:
    """The planner's last status, and the way of the goal."""

    def __init__(self, name, goals="move_base_simple/goal"):
        self.name, self.changed, self.status = name, threading.Condition(), None
        self.goals = rospy.Publisher(goals, PoseStamped, queue_size=1, latch=True)
        rospy.Subscriber(name + "/status", PlannerStatus, self.take, queue_size=100, tcp_nodelay=True)

    def take(self, status):
        with self.changed:
            self.status = status
            self.changed.notify_all()

    def wait(self, happened, what, seconds=60):
        with self.changed:
            if not self.changed.wait_for(lambda: self.status is not None and happened(self.status), seconds):
                sys.exit("demo: the planner does not answer: %s" % what)

    def set_goal(self, frame, x, y):
        goal = PoseStamped()
        goal.header.frame_id = frame
        goal.pose.position.x, goal.pose.position.y, goal.pose.orientation.w = x, y, 1
        self.goals.publish(goal)
        self.wait(lambda s: math.hypot(s.goal.pose.position.x - x, s.goal.pose.position.y - y) < 1e-3 or s.refusal,
                  "no goal is set")
        if self.status.refusal:
            sys.exit("demo: the goal was refused: " + self.status.refusal)


class Film:
    """Pictures of one size, which is even, to an .mp4, by ffmpeg."""

    def __init__(self, path):
        self.path, self.process = path, None

    def add(self, image):
        if self.process is None:
            self.process = subprocess.Popen(
                ["ffmpeg", "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "bgr24", "-s",
                 "%dx%d" % (image.shape[1], image.shape[0]), "-r", str(FRAMES), "-i", "-", "-pix_fmt", "yuv420p", self.path],
                stdin=subprocess.PIPE)
        self.process.stdin.write(image.tobytes())

    def close(self):
        if self.process is not None:
            self.process.stdin.close()
            if self.process.wait() != 0:
                sys.exit("demo: ffmpeg could not write " + self.path)


def forecast_text(status):
    """What a planner that plans through forecasts has of one."""
    if status.planner != "forecast":
        return "without a forecast"
    if status.forecast_age >= 0:
        return "forecast of %.0f s ago" % status.forecast_age
    if status.forecast_progress >= 0:
        return "no forecast yet (%.0f %%)" % (100 * status.forecast_progress)
    return "no forecast"


class Trip:
    """One rover from goal to goal, step by step."""

    def __init__(self, options, course, desert, planner):
        self.options, self.course, self.desert, self.planner = options, course, desert, planner
        self.time, self.slips, self.length, self.replans, self.last_replan, self.reached = 0.0, [], 0.0, 0, "", 0
        desert.show_path(planner.name + "/path")
        self.set_goal()

    def set_goal(self):
        self.goal = self.course.goals[self.reached](self.desert.simulation)
        self.planner.set_goal("map", *self.goal)

    def next_goal(self):
        """Whether there is another one."""
        status = self.planner.status
        self.reached += 1
        if self.reached == len(self.course.goals):
            return False
        self.replans, self.last_replan = self.replans + status.replans, status.last_replan
        self.set_goal()
        print("      it has arrived; the next goal is (%.1f, %.1f) m" % self.goal, flush=True)
        return True

    def step(self):
        before = self.desert.rover.pose()
        reached = self.desert.step().step
        # It may wait for a forecast, to which steps and publishing are preferred.
        self.planner.wait(lambda s: s.terrain_step >= reached, "it does not act on step %d" % reached, 600)
        self.time += self.course.step
        now = self.desert.rover.pose()
        self.length += math.hypot(now.x - before.x, now.y - before.y)
        status = self.desert.rover.status()
        if status.state == "driving":
            self.slips.append(status.mean_slip)

    def line(self):
        now, status = self.desert.rover.pose(), self.planner.status
        return "%5.0f s  (%6.2f, %6.2f) m  %-10s %5.1f m to go  %s  %d replans%s" % (
            self.time, now.x, now.y, status.state, status.remaining,
            forecast_text(status), *self.changes_of_mind())

    def changes_of_mind(self):
        """Over both goals: how many, and why the last one."""
        status = self.planner.status
        count = status.replans + self.replans
        return count, ": " + (status.last_replan if status.replans else self.last_replan) if count else ""

    def picture(self):
        """The terrain, what the rover plans and has done, and what that means."""
        from desert_sim.picture import BLUE, GREEN, RED, WHITE  # needs OpenCV, which --live does without
        legend = (("way driven", WHITE), ("plan", BLUE), ("goal", GREEN), ("rover", RED), *self.course.legend)
        status, slip = self.planner.status, self.slips[-1] if self.slips else 0.0
        hours = self.time * self.course.hours
        lines = ["%3.0f s%s: %s, %.0f m made, slip %.0f %%" % (
            self.time, ", %.0f days of wind" % (hours / 24) if hours >= 1 else "", status.state, self.length, 100 * slip),
            "%s; %d replans%s" % (forecast_text(status), *self.changes_of_mind())]
        return self.desert.picture(self.goal).framed(FILM_SIZE, legend, lines)

    def run(self, film):
        for n in range(int(self.options.seconds / self.course.step)):
            self.step()
            if n % STEPS_A_FRAME == 0:
                film.add(self.picture())
            if n % int(20 / self.course.step) == 0:
                print(self.line(), flush=True)
            if self.planner.status.state == PlannerStatus.ARRIVED and self.next_goal():
                continue
            if self.planner.status.state in ENDS:
                break
        film.add(self.picture())

    def report(self):
        """Exit status."""
        status, rover = self.planner.status, self.desert.rover.status()
        print("%s after %.0f s: %.1f m made, %.1f m up, %d replans%s, %d recoveries, slip %.0f %% on the mean and %.0f %% at "
              "most; rover %s%s" % (
                  status.state, self.time, self.length, self.desert.rover.pose().z, *self.changes_of_mind(), status.recoveries,
                  100 * sum(self.slips) / max(1, len(self.slips)), 100 * max(self.slips, default=0), rover.state,
                  ": " + rover.reason if rover.reason else ""))
        if self.reached == len(self.course.goals):
            return 0
        print("demo: the rover did not arrive: %s" % (status.reason or "its time is over"), file=sys.stderr)
        return 1


def run_headless(options):
    from desert_sim.picture import write_image
    course = COURSES[options.scenario](options.seed)
    settings = ["run.time_step=%g" % (course.step * course.hours * 3600)]
    parameters = {"backend": options.backend, "threads": 0, "frame_id": "map", "step_rate": 1 / course.step}  # of forecasts
    with Desert(options.scenario, rover=course.start, settings=settings, seconds_per_step=course.step, parameters=parameters,
                rover_parameters=course.rover) as desert:
        planner = Planner("/rover/desert_planner", "/move_base_simple/goal")
        node = Node(planner.name, {
            "clock": "lockstep", "seconds_per_sim_second": 1 / (3600 * course.hours), "planner": options.planner,
            "tf_prefix": "rover", "terrain_node": "/desert_sim", "rover_node": "desert_rover",
            "goal_topic": planner.goals.resolved_name, "forecast_period": options.forecast_period, **course.planner},
            executable="desert_planner_node")
        film = Film(options.film)
        try:
            planner.wait(lambda s: s.header.frame_id, "it has no terrain")
            trip = Trip(options, course, desert, planner)
            trip.run(film)
            status = trip.report()
            write_image(options.picture, trip.picture())
            print("picture: %s, film: %s" % (options.picture, options.film))
        finally:
            film.close()
            node.close()
    return status


def run_live(options):
    rospy.init_node("demo_rover", disable_signals=True)
    planner = Planner("rover/desert_planner")
    planner.wait(lambda s: s.header.frame_id, "it has no terrain", 120)
    course = COURSES[options.scenario](options.seed)
    goals = [*course.goals, lambda _: course.start[:2]]
    simulation = Simulation()
    n = 0
    while not rospy.is_shutdown():
        place = goals[n % len(goals)](simulation)
        planner.set_goal(planner.status.header.frame_id, *place)
        planner.wait(lambda s: s.state not in ENDS, "it does not start")
        while planner.status.state not in ENDS and not rospy.is_shutdown():
            rospy.sleep(2)
            s = planner.status
            print("%-10s %5.1f m to go  %d replans  %s" % (s.state, s.remaining, s.replans, s.reason), flush=True)
        rospy.sleep(3)
        n += 1
    return 0


def main():
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # and not before the nodes have ended
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--live", action="store_true")
    parser.add_argument("--scenario", choices=COURSES, default="rover_barchans")
    parser.add_argument("--seed", type=int, default=1, help="of the course and the rover's noise")
    parser.add_argument("--seconds", type=float, default=900, help="of the rover's time, at most")
    parser.add_argument("--planner", choices=("field", "ompl", "forecast"), default="field")
    parser.add_argument("--forecast-period", type=float, default=100,
                        help="of the rover's time [s]; the weather is known, and each forecast is waited for")
    parser.add_argument("--backend", choices=("auto", "cpu", "cuda"), default="auto")
    parser.add_argument("--picture", default="desert_demo.png")
    parser.add_argument("--film", default="desert_demo.mp4")
    options = parser.parse_args(rospy.myargv()[1:])
    return run_live(options) if options.live else run_headless(options)


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)
