#!/usr/bin/env python3
"""How much the desert depends on the time step: runs one small world a process at several steps for the same time.

    test/bench/time_steps.py [--program desert_run] [--page doc/notebook/time_steps.md] [--only NAME]...

Each world has a quantity that its process changes. The page lists what that is at each step, relative to 1 s.
Needs python3 with numpy and OpenCV.
"""
import argparse
import os
import subprocess
import sys
import tempfile

import cv2
import numpy as np

STEPS = (2, 1, 0.5, 0.25, 0.1, 0.01)
LONG_STEPS = (14400, 3600, 1800, 600, 60)  # of continuum transport
HEAP = """
grid: {width: 256, height: 32, cell_size: 1}
terrain: [cone: {layer: sand, shape: dome, x: 30, y: 16, radius: 14, height: 7}]
wind: {speed: 3, projection: false}
"""
THIN = """
grid: {width: 256, height: 256, cell_size: 1}
terrain: [noise: {layer: sand, low: 0.5, high: 2}]
wind: {speed: 5}
"""
BED = """
grid: {width: 48, height: 48, cell_size: 1}
terrain: [noise: {layer: sand, low: 2, high: 3, scale: 8}]
wind: {speed: 3, speedup: 0, warping: false, projection: false}
wind_shadow: {enabled: false}
saltation: {lift: 0.05}
"""
POND = """
grid: {width: 48, height: 48, cell_size: 1}
terrain: [uniform: {layer: soil, value: 1}, uniform: {layer: water, value: 0.2}]
wind: {speed: 0}
saltation: {enabled: false}
avalanching: {enabled: false}
"""
SLOPE = """
grid: {width: 64, height: 24, cell_size: 1, boundary: open}
terrain: [ramp: {layer: bedrock, slope_x: 0.02}, uniform: {layer: soil, value: 1}]
wind: {speed: 0}
saltation: {enabled: false}
avalanching: {enabled: false}
rain: {rate: 0.0002}
water: {evaporation: 0, friction: 0.3}
"""


def moved(field):
    return np.average(np.arange(field["sand"].shape[1]) + 0.5, weights=(field["sand"] + field["airborne_sand"]).sum(0)) - 30


def relief(field):
    return field["sand"].std()


def bare(field):
    return (field["sand"] < 0.001).mean()


def mean(layer):
    return lambda field: field[layer].mean()


# Name, quantity, seconds, scenario, what is measured of the layers.
WORLDS = [
    ("saltation", "displacement of a heap", 60, HEAP + "saltation: {lift: 0.02}\n", moved),
    ("saltation, much lifted at once", "displacement of a heap", 20, HEAP + "saltation: {lift: 0.5}\n", moved),
    ("dunes on rock", "bare rock", 100, THIN, bare),
    ("reptation, adaptive_repose", "relief of a bed", 20, BED + "reptation: {strength: 10}\n", relief),
    ("reptation, smoothing", "relief of a bed", 20, BED + "reptation: {method: smoothing, strength: 0.5}\n", relief),
    ("reptation, steepest", "relief of a bed", 20, BED + "reptation: {method: steepest, slab: 0.2}\n", relief),
    ("avalanching", "height of a column that collapses", 20,
     "grid: {width: 64, height: 64}\nterrain: [column: {layer: sand, x: 32, y: 32, size_x: 12, size_y: 12, height: 15}]\n"
     "wind: {speed: 0}\nsaltation: {enabled: false}\n", lambda field: field["sand"].max()),
    ("abrasion", "rock worn", 40,
     "grid: {width: 48, height: 48}\nterrain: [uniform: {layer: sand, value: 0.01}]\nwind: {speed: 3, speedup: 0}\n"
     "avalanching: {enabled: false}\nabrasion: {rate: 0.001}\n", lambda field: -field["bedrock"].mean()),
    ("evaporation", "water lost", 40, POND + "water: {evaporation: 0.002}\nrain: {rate: 1e-9}\n", lambda field: 0.2 - field["water"].mean()),
    ("moisture", "water in the ground", 20, POND + "water: {evaporation: 0}\nmoisture: {enabled: true}\n", mean("moisture")),
    ("rivers", "water on a slope in the rain", 60, SLOPE, mean("water")),
    ("erosion", "soil worn by the rain", 60, SLOPE + "hydraulic_erosion: {enabled: true}\n",
     lambda field: 1 - field["soil"].mean()),
    ("erosion, shallow_water", "soil worn by the rain", 60,
     SLOPE.replace("friction", "model: shallow_water, friction") + "hydraulic_erosion: {enabled: true}\n",
     lambda field: 1 - field["soil"].mean()),
    ("soil", "soil that dries to sand", 40,
     "grid: {width: 48, height: 48}\nterrain: [uniform: {layer: soil, value: 1}]\nwind: {speed: 0}\n"
     "saltation: {enabled: false}\nmoisture: {enabled: true}\nsoil: {enabled: true}\n", lambda field: 1 - field["soil"].mean()),
    ("plants", "mean cover", 60,
     "grid: {width: 64, height: 64}\nterrain: [uniform: {layer: soil, value: 2}, uniform: {layer: moisture, value: 0.15}]\n"
     "wind: {speed: 0}\nsaltation: {enabled: false}\nvegetation: {enabled: true}\n"
     "species: [{preset: bush, water_use: 0, moisture_lowest: 0, light_highest: 2, spawn: 1000}]\n", mean("vegetation")),
]

DUNE = """
grid: {width: 128, height: 64, cell_size: 1}
terrain: [cone: {layer: sand, shape: gaussian, x: 30, y: 32, radius: 8, height: 4}]
wind: {speed: 9}
sand: {model: continuum}
"""
SHEET = """
grid: {width: 48, height: 24, cell_size: 1, boundary: open}
terrain: [uniform: {layer: bedrock, value: 1}]
wind: {speed: 9}
sand: {model: continuum}\nsaltation: {influx: 5.0e-6}
shear_stress: {in_phase: 0, in_quadrature: 0}
"""
LONG_WORLDS = [
    ("continuum", "displacement of a dune", 4 * 86400, DUNE, moved),
    ("continuum", "relief of a dune", 4 * 86400, DUNE, relief),
    ("continuum, abrasion", "rock worn", 4 * 86400, SHEET + "abrasion: {rate: 1e-5}\n", lambda field: 1 - field["bedrock"].mean()),
    ("continuum, plants", "sand that plants catch", 4 * 86400,
     SHEET.replace("value: 1}]", "value: 1}, column: {layer: vegetation, x: 24, y: 12, size_x: 10, size_y: 99, height: 0.5}]"),
     mean("sand")),
]


def measure(program, scenario, seconds, step, quantity):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "world.yaml")
        with open(path, "w") as f:
            f.write(scenario)
        command = [program, path, "--quiet", "--backend", "cpu", "--out", folder, "--steps", str(round(seconds / step)),
                   "--set", f"run.time_step={step}"]
        done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        if done.returncode:
            raise SystemExit(done.stderr)
        layers = {name[:-4]: cv2.imread(os.path.join(folder, name), cv2.IMREAD_UNCHANGED).astype(np.float64)
                  for name in os.listdir(folder) if name.endswith(".tif")}
        return quantity(layers)


def relative(value, reference):
    share = value / reference
    return f"{share:.3f}" if abs(share - 1) <= 0.05 else f"**{share:.3f}**"


def table(arguments, worlds, steps, reference):
    """Lines of markdown, which are printed as they are found."""
    others = [step for step in steps if step != reference]
    lines = [f"| process | quantity | at {reference} s | " + " | ".join(f"{step} s" for step in others) + " |",
             "|" + "---|" * (3 + len(others))]
    print("\n".join(lines))
    for name, what, seconds, scenario, quantity in worlds:
        if arguments.only and name not in arguments.only:
            continue
        found = {step: measure(arguments.program, scenario, seconds, step, quantity) for step in steps}
        shares = " | ".join(relative(found[step], found[reference]) for step in others)
        lines.append(f"| {name} | {what} | {found[reference]:.4g} | {shares} |")
        print(lines[-1], flush=True)
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--program", default="desert_run")
    parser.add_argument("--page")
    parser.add_argument("--only", action="append")
    arguments = parser.parse_args()
    lines = ["# How much do results depend on the time step?", "",
             "What a process does in the same time at several time steps, relative to steps of 1 s. Written by",
             "`test/bench/time_steps.py --page doc/notebook/time_steps.md`. More than 5 % off is bold.",
             "Longer ones are divided where sand or plants move. Hops and avalanches take turns, which is of first order: where much",
             "is lifted, steps of 1 s are 7 % from short ones, which leave less rock bare. What a film of rain wears by pipes goes",
             "with the step.", ""]
    lines += table(arguments, WORLDS, STEPS, 1)
    lines += ["", "Continuum transport, relative to steps of ten minutes; steps beyond 3900 s are divided.",
              ""]
    lines += table(arguments, LONG_WORLDS, LONG_STEPS, 600)
    if arguments.page:
        with open(arguments.page, "w", encoding="utf-8") as f:
            f.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    sys.exit(main())
