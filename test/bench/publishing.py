#!/usr/bin/env python3
"""What publishing costs and how late it is: a 1024 x 1024 node at full speed on two cores, with and without three
subscribers to keyframes at 5 Hz and all updates, in turns. After `. build/devel/setup.bash`:

    test/bench/publishing.py [--scenario barchan] [--size 1024] [--rounds 6] [--seconds 8] [--json]

Aims: the step rate with subscribers at least 95 % of that without, the 99th percentile of the latency of updates under
10 ms, updates of a step under 10 % of a keyframe. The exit status is 0 whether they are met or not: a machine that does
other things as well misses them, and the table says how busy it was.
"""
import argparse
import json
import sys
import time

from desert_sim.srv import Step
from live_node import CORES, LiveNode, Trigger, median, quantile

WARM_UP = 40  # steps: the scenario's discs become dunes


def measure(live, seconds):
    """Steps a second, and the shares of the two cores that the four of LiveNode.cpu() took."""
    before, cpu_before, start = live.status(), live.cpu(), time.monotonic()
    time.sleep(seconds)
    after = live.status()
    while after.step == before.step:
        after = live.status()
    cpu_after, elapsed = live.cpu(), time.monotonic() - start
    rate = (after.step - before.step) / (after.header.stamp - before.header.stamp).to_sec()
    return rate, [(b - a) / elapsed / CORES for a, b in zip(cpu_before, cpu_after)]


def alternate(live, rounds, seconds):
    """Rates without and with subscribers, round by round, their costs, and what subscribers were sent."""
    result = {"alone": [], "subscribed": [], "shares": [], "others": [], "sent": []}
    for turn in range(2 * rounds):
        subscribed = turn % 4 in (1, 2)  # without, with, with, without: a drift of the machine's speed evens out
        if subscribed:
            live.subscribe()
        time.sleep(1)
        if subscribed:
            live.sent()  # of the time before
        rate, shares = measure(live, seconds)
        if subscribed:
            result["sent"] += live.sent()
            live.unsubscribe()
            result["shares"].append(shares)
        result["subscribed" if subscribed else "alone"].append(rate)
        result["others"].append(max(0.0, shares[3] - sum(shares[:3])))
    return result


def bytes_of_steps(live, steps=10):
    """Bytes of the updates of single steps, and of a keyframe."""
    live.node.call("pause", Trigger)
    live.subscribe(counts_bytes=True)
    time.sleep(2)
    for _ in range(steps):
        live.node.call("step", Step, 1)
    time.sleep(1)
    sent = live.sent()[0]
    return sent["update_bytes"][-steps:], sent["keyframe_bytes"]


def run(arguments):
    private = {"scenario": arguments.scenario, "paused": False, "step_rate": 0, "keyframe_rate": 5.0, "update_rate": 10.0,
               "update_threshold": 0.01,
               "settings": ["grid.width=%d" % arguments.size, "grid.height=%d" % arguments.size]}
    with LiveNode(private) as live:
        live.node.call("step", Step, WARM_UP)
        turns = alternate(live, arguments.rounds, arguments.seconds)
        update_bytes, keyframe_bytes = bytes_of_steps(live)
    latencies = [1e3 * latency for sent in turns["sent"] for latency in sent["latencies"]]
    ratios = [with_them / alone for alone, with_them in zip(turns["alone"], turns["subscribed"])]
    seconds = arguments.rounds * arguments.seconds
    return {
        "scenario": arguments.scenario, "size": arguments.size,
        "steps_per_second_alone": median(turns["alone"]), "steps_per_second_subscribed": median(turns["subscribed"]),
        "step_rate_cost": 1 - median(ratios), "cost_of_rounds": [1 - ratio for ratio in ratios],
        "keyframes_per_second": sum(sent["keyframes"] for sent in turns["sent"]) / 3 / seconds,
        "updates_per_second": sum(sent["updates"] for sent in turns["sent"]) / 3 / seconds,
        "gaps": sum(sent["gaps"] for sent in turns["sent"]), "refused": sum(sent["refused"] for sent in turns["sent"]),
        "latency_ms": {"median": median(latencies), "p99": quantile(latencies, 0.99), "max": quantile(latencies, 1),
                       "count": len(latencies)},
        "update_bytes": median(update_bytes), "keyframe_bytes": keyframe_bytes,
        "update_share": median(update_bytes) / keyframe_bytes,
        # What a busy machine does not blur: of the CPU time that node and subscribers took, the part for publishing.
        "cpu_cost": median([sum(shares[1:3]) / sum(shares[:3]) for shares in turns["shares"]]),
        "cpu_share": dict(zip(("simulation", "publishing", "subscribers"),
                              (median(column) for column in zip(*turns["shares"])))),
        "cpu_share_of_other_programs": median(turns["others"])}


def print_table(r):
    print("%s, %d x %d cells, %d cores; three subscribers to keyframes (%.1f a second) and updates (%.1f a second)" % (
        r["scenario"], r["size"], r["size"], CORES, r["keyframes_per_second"], r["updates_per_second"]))
    print("  steps a second       %8.2f alone, %.2f with subscribers: cost %.1f %% (aim: under 5; rounds: %s)" % (
        r["steps_per_second_alone"], r["steps_per_second_subscribed"], 100 * r["step_rate_cost"],
        ", ".join("%.1f" % (100 * cost) for cost in r["cost_of_rounds"])))
    print("  latency of updates   %8.1f ms at the median, %.1f at the 99th percentile (aim: under 10), %.1f at most, of %d" % (
        tuple(r["latency_ms"][key] for key in ("median", "p99", "max", "count"))))
    print("  update of a step     %8d bytes, %.1f %% of a keyframe's %d at 1 cm (aim: under 10)" % (
        r["update_bytes"], 100 * r["update_share"], r["keyframe_bytes"]))
    print("  share of the cores   %8.1f %% simulation, %.1f publishing, %.1f subscribers, %.1f other programs; cost in CPU "
          "time %.1f %%" % (*(100 * r["cpu_share"][key] for key in ("simulation", "publishing", "subscribers")),
                            100 * r["cpu_share_of_other_programs"], 100 * r["cpu_cost"]))
    if r["gaps"] or r["refused"]:
        print("  LOST: %d gaps, %d refused messages" % (r["gaps"], r["refused"]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenario", default="barchan")
    parser.add_argument("--size", type=int, default=1024)
    parser.add_argument("--rounds", type=int, default=6)
    parser.add_argument("--seconds", type=float, default=8)
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    result = run(arguments)
    if arguments.json:
        print(json.dumps(result))
    else:
        print_table(result)


if __name__ == "__main__":
    sys.exit(main())
