#!/usr/bin/env python3
"""How long a forecast takes beside a live run, and what it costs the live run, on two cores. After `. build/devel/setup.bash`:

    test/bench/forecast.py [--scenario rover_barchans] [--size 256] [--horizon 600] [--moments 10] [--rate 10] [--repeat 3]
                           [--stride 1] [--at-most SECONDS]

The node runs the scenario at `rate` steps a second (those with a run.acceleration: as that says). With `stride` a step of the
forecast stands for so many of the live run. It fails (exit status 1) if the fastest of the forecasts takes longer than
`at-most`, or the result is no forecast.
"""
import argparse
import sys
import time

from actionlib import ActionClient, CommState, GoalStatus
from desert_sim.msg import ForecastTerrainAction, ForecastTerrainGoal
from desert_sim.testing import wait_until
from live_node import LiveNode, median


def rate(live, seconds):
    """Steps a second by the stamps of two states."""
    first = live.status()
    time.sleep(seconds)
    last = live.status()
    return (last.step - first.step) / (last.header.stamp - first.header.stamp).to_sec()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenario", default="rover_barchans")
    parser.add_argument("--settings", nargs="*", default=[])
    for name, default in (("size", 256), ("moments", 10), ("repeat", 3), ("threads", 0), ("stride", 1)):
        parser.add_argument("--" + name, type=int, default=default)
    for name, default in (("horizon", 600), ("rate", 10), ("at-most", float("inf"))):
        parser.add_argument("--" + name, type=float, default=default)
    a = parser.parse_args()
    private = {"scenario": a.scenario, "paused": False, "step_rate": a.rate, "status_rate": 20, "forecast_threads": a.threads,
               "settings": ["grid.width=%d" % a.size, "grid.height=%d" % a.size, *a.settings]}
    goal = ForecastTerrainGoal(horizon=a.horizon, moments=a.moments, stride=a.stride)
    seconds, failed = [], False
    with LiveNode(private, subscribers=0) as live:
        # Not SimpleActionClient: an answer that comes before its send_goal() has returned is lost to it.
        client = ActionClient("/desert_sim/forecast", ForecastTerrainAction)
        client.wait_for_server()
        alone, beside = rate(live, 2), []
        for _ in range(a.repeat):
            start = time.monotonic()
            handle = client.send_goal(goal)
            beside.append(rate(live, 2))
            wait_until(lambda: handle.get_comm_state() == CommState.DONE, "no result", 3600)
            seconds.append(time.monotonic() - start)
            failed = failed or handle.get_goal_status() != GoalStatus.SUCCEEDED
            forecast = handle.get_result().forecast
            steps = forecast.steps[-1] - forecast.step if forecast.steps else 0
            print("%.1f s for %d steps, %.2f ms each; %s" % (seconds[-1], steps, 1e3 * seconds[-1] / max(1, steps),
                                                          handle.get_goal_status_text()), flush=True)
    print("%s, %d x %d cells, %.0f s ahead: %.1f s at best; the live run makes %.2f steps a second alone, %.2f beside (medians)" % (
        a.scenario, a.size, a.size, a.horizon, min(seconds), alone, median(beside)))
    return 1 if failed or min(seconds) > a.at_most else 0


if __name__ == "__main__":
    sys.exit(main())
