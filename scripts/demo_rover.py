#!/usr/bin/env python3
"""A rover crosses a desert whose dunes march over its way, and climbs one of them.

Without --live: desert, rover and planner without a window, in lockstep, faster than time passes. Prints a line every 20 s
of the rover's time, and in the end what came of it; leaves a picture and a film. Exit status 1, with the reason, if the
rover did not arrive.
--live: sets goals to the planner of a desert that runs (launch/demo_rover.launch), round and round.
"""
import argparse
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

SCENARIO = "rover_barchans"
ACCELERATION = 3600  # of its dunes: an hour in a second
STEP = 0.4  # of the rover's time [s]
FORECAST_PERIOD = 100  # of the rover's time [s]: the wind is steady, and each forecast is waited for
FRAMES = 10  # of the film a second, each STEPS_A_FRAME steps
STEPS_A_FRAME = 5
FILM_SIZE = (1280, 720)
ENDS = (PlannerStatus.ARRIVED, PlannerStatus.NO_PATH, PlannerStatus.STUCK, PlannerStatus.BURIED, PlannerStatus.TIPPED,
        PlannerStatus.TIMED_OUT, PlannerStatus.CANCELLED)


def course(seed):
    """Start and first goal [m]: on either side of the barchan in the middle, whose slip face moves over the ground between."""
    draw = random.Random(seed)
    return (draw.uniform(100, 108), 42.0), (draw.uniform(100, 108), 90.0)


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
    """One rover from start to a goal behind the dune, and onto the dune, step by step."""

    def __init__(self, options, desert, planner, goal):
        self.options, self.desert, self.planner, self.goal = options, desert, planner, goal
        self.time, self.slips, self.length, self.replans, self.last_replan, self.climbs = 0.0, [], 0.0, 0, "", False
        desert.show_path(planner.name + "/path")
        planner.set_goal("map", *goal)

    def climb(self):
        """Sets the second goal."""
        status = self.planner.status
        self.replans, self.last_replan, self.climbs = status.replans, status.last_replan, True
        self.goal = summit(self.desert.simulation)
        print("      the way past the dune is done; now onto its crest, at (%.1f, %.1f) m" % self.goal, flush=True)
        self.planner.set_goal("map", *self.goal)

    def step(self):
        before = self.desert.rover.pose()
        reached = self.desert.step().step
        # It may wait for a forecast, which only has the time that nobody else wants.
        self.planner.wait(lambda s: s.terrain_step >= reached, "it does not act on step %d" % reached, 600)
        self.time += STEP
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
        legend = (("way driven", WHITE), ("plan", BLUE), ("goal", GREEN), ("rover", RED),
                  ("too steep or too loose", (60, 60, 190)))
        status, slip = self.planner.status, self.slips[-1] if self.slips else 0.0
        lines = ["%3.0f s, %.0f days of wind: %s, %.0f m made, slip %.0f %%" % (
            self.time, self.time * ACCELERATION / 86400, status.state, self.length, 100 * slip),
            "%s; %d replans%s" % (forecast_text(status), *self.changes_of_mind())]
        return self.desert.picture(self.goal).framed(FILM_SIZE, legend, lines)

    def run(self, film):
        steps = int(self.options.seconds / STEP)
        for n in range(steps):
            self.step()
            if n % STEPS_A_FRAME == 0:
                film.add(self.picture())
            if n % int(20 / STEP) == 0:
                print(self.line(), flush=True)
            if self.planner.status.state == PlannerStatus.ARRIVED and not self.climbs:
                self.climb()
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
        if status.state == PlannerStatus.ARRIVED and self.climbs:
            return 0
        print("demo: the rover did not arrive: %s" % (status.reason or "its time is over"), file=sys.stderr)
        return 1


def run_headless(options):
    from desert_sim.picture import write_image
    start, goal = course(options.seed)
    settings = ["run.time_step=%g" % (STEP * ACCELERATION)]
    parameters = {"backend": options.backend, "threads": 0, "frame_id": "map", "step_rate": 1 / STEP}  # of forecasts
    with Desert(SCENARIO, rover=(*start, 90.0), settings=settings, seconds_per_step=STEP, parameters=parameters,
                rover_parameters={"rover": {"seed": options.seed}}) as desert:
        planner = Planner("/rover/desert_planner", "/move_base_simple/goal")
        node = Node(planner.name, {
            "clock": "lockstep", "seconds_per_sim_second": 1 / ACCELERATION, "planner": options.planner, "tf_prefix": "rover",
            "terrain_node": "/desert_sim", "rover_node": "desert_rover", "goal_topic": planner.goals.resolved_name,
            "forecast_period": FORECAST_PERIOD},
            executable="desert_planner_node")
        film = Film(options.film)
        try:
            planner.wait(lambda s: s.header.frame_id, "it has no terrain")
            trip = Trip(options, desert, planner, goal)
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
    start, goal = course(options.seed)
    simulation = Simulation()
    n = 0
    while not rospy.is_shutdown():
        place = (goal, summit(simulation), start)[n % 3]
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
    parser.add_argument("--seed", type=int, default=1, help="of the course and the rover's noise")
    parser.add_argument("--seconds", type=float, default=900, help="of the rover's time, at most")
    parser.add_argument("--planner", choices=("field", "ompl", "forecast"), default="field")
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
