#!/usr/bin/env python3
"""Draws a run of desert_run over time: areas by what one sees from above, plants by species, and water.

  python/plot_run.py PICTURE.png STEP/summary.json...     (what desert_run --plot does)
"""
import json
import sys

COLOURS = {"rock": "#726660", "soil": "#6c5138", "sand": "#dab476", "plants": "#467a34", "water": "#4f86c6"}


def read(path):
    with open(path) as file:
        return json.load(file)


def main(picture, paths):
    runs = sorted((read(path) for path in paths), key=lambda r: r["sim_time_s"])
    try:
        import matplotlib
        matplotlib.use("Agg")
        import matplotlib.pyplot as plt
    except ImportError as error:
        raise ValueError("needs matplotlib (python3-matplotlib): %s" % error)
    times = [r["sim_time_s"] for r in runs]
    whole = sum(runs[0]["area_m2"].values())
    species = list(runs[-1]["plants"])
    figure, (areas, plants, water) = plt.subplots(3, 1, sharex=True, figsize=(8, 8),
                                                  gridspec_kw={"height_ratios": [3, 3, 2]})
    areas.stackplot(times, [[100 * r["area_m2"][name] / whole for r in runs] for name in COLOURS],
                    labels=list(COLOURS), colors=list(COLOURS.values()))
    areas.set_ylabel("seen from above [% of area]")
    areas.set_ylim(0, 100)
    areas.legend(loc="center left", bbox_to_anchor=(1, 0.5), frameon=False)
    for name in species:
        plants.plot(times, [r["plants"].get(name, {"plants": 0})["plants"] for r in runs], label=name)
    plants.set_ylabel("plants")
    plants.set_yscale("symlog", linthresh=10)
    if species:
        plants.legend(loc="center left", bbox_to_anchor=(1, 0.5), frameon=False)
    for name in ("water", "moisture"):
        water.plot(times, [r["volume_m3"][name]["final"] / whole for r in runs], label=name)
    water.set_ylabel("mean depth [m]")
    water.set_xlabel("simulated time [s]")
    water.set_xlim(times[0], times[-1] if times[-1] > times[0] else times[0] + 1)
    water.legend(loc="center left", bbox_to_anchor=(1, 0.5), frameon=False)
    areas.set_title(runs[0]["scenario"])
    figure.tight_layout()
    with open(picture, "wb") as file:  # desert_run gives a name without an extension
        figure.savefig(file, format="png", dpi=110)


if __name__ == "__main__":
    if len(sys.argv) < 3 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    try:
        main(sys.argv[1], sys.argv[2:])
    except (OSError, ValueError, KeyError) as fault:
        sys.exit("plot_run.py: %s" % (repr(fault) if isinstance(fault, KeyError) else fault))
