#!/usr/bin/env python3
"""An oasis, made in a running node from an empty plain: dunes, a basin with a spring, wet soil, plants that live there."""
import desert_sim
import rospy

rospy.init_node("oasis")
scale = rospy.get_param("~scale", 1.0)  # of the plain and of all that is put on it; 0.25 for a quick look
steps = rospy.get_param("~steps", 600)

SPECIES = """species=[
  {preset: palm, spawn: 20, position_adjust: 0.02, hue: 110},
  {preset: bush, name: shrub, light_highest: 1.7, position_adjust: 0.02, hue: 70},
  {preset: bush, name: grass, max_radius: 0.7, stem: 1, growth: 0.3, light_highest: 1.8, sand: 0.8, moisture_lowest: 0.1,
   position_adjust: 0.02, water_use: 0.02, hue: 95}]"""


def at(x, y, radius, **more):
    return {"center": (x * scale, y * scale), "radius": radius * scale, **more}


def basin(layer, merge, value, radius, inner):
    desert.edit(layer, "circle", merge, value, stroke="basin", **at(96, 72, radius, inner=inner))


desert = desert_sim.Simulation()
desert.pause()
desert.load_scenario("plain", ["grid.width=%d" % (192 * scale), "grid.height=%d" % (144 * scale)])

# A sheet of sand, and heaps on it, of which the wind makes dunes.
desert.set_wind(speed=4, direction_deg=0)
desert.apply_settings(["saltation.lift=0.5"])
desert.edit("sand", "rectangle", "add", 1.2, stroke="sheet", **at(96, 72, 96, radius_y=72 * scale, inner=1))
for i in range(12):
    desert.edit("sand", "circle", "add", 2, stroke="sheet", **at(i * 71 % 192, i * 47 % 144, 12))
desert.step(steps // 4)

# A basin in the rock with soil, a pond and a spring; the ground around it is wet.
desert.apply_settings(["soil.enabled=true", "moisture.enabled=true", "moisture.evaporation=0.01", "moisture.diffusion=0.5"])
basin("bedrock", "sub", 6, radius=26, inner=0.2)
basin("sand", "replace", 0.3, radius=30, inner=0.8)
basin("soil", "add", 0.5, radius=34, inner=0.7)
basin("water", "add", 2, radius=16, inner=0.8)
basin("moisture", "max", 0.15, radius=36, inner=0.7)
desert.set_weather(evaporation=0.004, springs=[{"x": 96 * scale, "y": 72 * scale, "radius": 4 * scale, "discharge": 10 * scale**2}])

# Plants that live.
desert.apply_settings([SPECIES, "vegetation.enabled=true"])
for seed, (species, density) in enumerate((("palm", 0.03), ("shrub", 0.1), ("grass", 0.5)), 1):
    desert.edit_plants("plant", "circle", species=species, density=density, size=0.5, seed=seed, stroke="plants",
                       **at(96, 72, 33))
desert.step(steps)

saved = desert.save_scenario("my_oasis")
print("step %d, state %s: %s" % (saved.step, saved.state_hash, saved.path))
