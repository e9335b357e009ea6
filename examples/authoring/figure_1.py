#!/usr/bin/env python3
"""A landscape like figure 1 of Paris et al. 2019, made in a running node: a wind rose, swirls, heaps, rock, plants."""
import desert_sim
import rospy

rospy.init_node("figure_1")
scale = rospy.get_param("~scale", 1.0)  # of the plain and of all that is put on it; 0.25 for a quick look
steps = rospy.get_param("~steps", 500)

PLAIN = """
grid: {width: %d, height: %d}
terrain:
  - uniform: {layer: bedrock, value: 0}
  - noise: {layer: sand, low: 0.8, high: 2.2, scale: %g}
sand: {model: desertscape_2019}
saltation: {lift: 0.1}
reptation: {slab: 0.01}
avalanching: {scheme: multilevel}
""" % (256 * scale, 192 * scale, 60 * scale)


def at(x, y, radius, **more):
    return {"center": (x * scale, y * scale), "radius": radius * scale, **more}


def rose(seed, hold_time, *winds):
    desert.set_wind_schedule(kind="rose", hold_time=hold_time, seed=seed, segments=[
        {"direction_deg": direction, "speed": speed, "probability": weight} for direction, speed, weight in winds])


desert = desert_sim.Simulation()
desert.pause()
desert.new_scenario(PLAIN, name="figure_1")

# Winds from the west, and swirls in them.
rose(3, 30, (0, 5, 6), (50, 4, 2), (-50, 4, 2))
desert.edit_wind("add", id=1, kind="vortex", speed=6, **at(150, 150, 24))
desert.edit_wind("add", id=2, kind="vortex", speed=-6, **at(150, 42, 24))
desert.edit_wind("add", id=3, kind="turbulence", speed=6, scale=60 * scale, life_time=60, seed=2, **at(215, 96, 45))
desert.edit_wind("add", id=4, kind="turbulence", speed=1.5, scale=25 * scale, life_time=40, seed=1, **at(50, 150, 40))

# Heaps of sand, a rock, and plants that hold sand.
desert.edit("sand", "circle", "add", 18 * scale, stroke="heap", **at(80, 96, 36))
desert.edit("sand", "circle", "add", 16 * scale, stroke="heap", **at(215, 96, 26))
desert.edit("bedrock", "ellipse", "add", 8 * scale, stroke="rock", **at(30, 25, 14, radius_y=7 * scale, angle_deg=20, inner=0.4))
for x, y, radius in ((95, 20, 8), (110, 30, 5)):
    desert.edit("vegetation", "circle", "max", 0.9, stroke="plants", **at(x, y, radius, inner=0.5))
desert.step(steps)

# A heap more, and winds from three sides, which make a star dune of it.
desert.edit("sand", "circle", "add", 14 * scale, stroke="star", **at(185, 96, 26))
rose(5, 20, (0, 5, 3), (120, 5, 2), (240, 5, 2))
desert.step(steps * 3 // 10)

saved = desert.save_scenario("figure_1")
print("step %d, state %s: %s" % (saved.step, saved.state_hash, saved.path))
