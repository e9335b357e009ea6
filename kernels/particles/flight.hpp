#pragma once
/// Flights of grains: lift-off, drag and gravity in a logarithmic wind, and bounces. Equations in wang.hpp.
///
/// A bed is what a flight is over: bed.at(x, y) gives the surface at a place, bed.cell_size the distance
/// within which it changes. Places are offsets from where the flight began [m], x and y like the grid's axes.

#include "kernels/base/math.hpp"

namespace desert_sim::particles {

/// The surface at a place.
struct Surface {
  float height;            ///< above the beginning of the flight [m]
  float shelter;           ///< depth of the shelter over it, z_d [m]
  float slope_x, slope_y;  ///< [1]
};

/// A level bed without shelter.
struct FlatBed {
  float cell_size;
  DESERT_HD Surface at(float, float) const { return {0.0f, 0.0f, 0.0f, 0.0f}; }
};

/// The wind over the bed, and what it does to a grain.
struct Air {
  /// U = slope · ln(z/z_0) + offset.
  struct Layer {
    float slope, offset;  ///< [m/s]
  };
  Layer near, above;       ///< below the focus, and above it
  float focus;             ///< z_f [m]
  float per_roughness;     ///< 1/z_0 [1/m]
  float drag;              ///< A/m = ¾ C_d ρ_a/(ρ_s d) [1/m]
  float gravity;           ///< [m/s²]
  float along_x, along_y;  ///< direction of the wind, of length 1

  /// Of the wind at a height above the ground [m/s].
  DESERT_HD float speed(float height, float shelter) const {
    const float z = height - shelter, ratio = z * per_roughness;
    const Layer& layer = z < focus ? near : above;
    return ratio > 1.0f ? layer.slope * logarithm(ratio) + layer.offset : 0.0f;
  }
};

struct Grain {
  float x, y, z;                             ///< [m]
  float velocity_x, velocity_y, velocity_z;  ///< [m/s]

  DESERT_HD float speed() const {
    return sqrtf(velocity_x * velocity_x + velocity_y * velocity_y + velocity_z * velocity_z);
  }
};

/// Integration of a hop: the time of a step is this share of the time that the hop would take without air
/// over level ground, or of the time flown so far, if that is more. Near the ground a step is at most this
/// share of a cell long. The first keeps the steps of a fall from any height few.
constexpr float share_of_hop = 1.0f / 16, share_of_cell = 1.0f;
/// A grain that is still in the air after so many steps comes down where it is.
constexpr int most_steps = 4096;

/// Flies until the grain hits the bed, and leaves it there. `rise`: speed away from the bed at the start
/// [m/s]. `passed(x, y)` is called after each step.
template <class Bed, class Passed>
DESERT_HD Surface hop(const Bed& bed, const Air& air, float rise, Grain& g, const Passed& passed) {
  Surface below = bed.at(g.x, g.y);
  float gap = maximum(g.z - below.height, 0.0f), flown = 0.0f;
  const float least = 2.0f * rise / air.gravity;
  for (int n = 0; n < most_steps; ++n) {
    float time = share_of_hop * maximum(least, flown);
    const float reach = share_of_cell * bed.cell_size + gap, speed = g.speed();
    if (speed * time > reach) time = reach / speed;
    // The wind in the middle of the step.
    const float wind = air.speed(gap + 0.5f * time * g.velocity_z, below.shelter);
    const float slip_x = wind * air.along_x - g.velocity_x, slip_y = wind * air.along_y - g.velocity_y,
                slip_z = -g.velocity_z;
    // By the slip in the middle of the step, which the drag has lessened by then: stable for any drag.
    const float at_first = air.drag * sqrtf(slip_x * slip_x + slip_y * slip_y + slip_z * slip_z) * time;
    const float drag = at_first / (1.0f + 0.5f * at_first), pull = drag / (1.0f + 0.5f * drag);
    const Grain before = g;
    g.velocity_x += pull * slip_x;
    g.velocity_y += pull * slip_y;
    g.velocity_z += pull * slip_z - air.gravity * time;
    // The mean of both velocities makes flights without air exact.
    g.x += 0.5f * (before.velocity_x + g.velocity_x) * time;
    g.y += 0.5f * (before.velocity_y + g.velocity_y) * time;
    g.z += 0.5f * (before.velocity_z + g.velocity_z) * time;
    flown += time;
    below = bed.at(g.x, g.y);
    const float left = g.z - below.height;
    if (left <= 0.0f) {
      const float part = gap > 0.0f ? gap / (gap - left) : 0.0f;
      g.x = lerp(before.x, g.x, part);
      g.y = lerp(before.y, g.y, part);
      g.velocity_x = lerp(before.velocity_x, g.velocity_x, part);
      g.velocity_y = lerp(before.velocity_y, g.velocity_y, part);
      g.velocity_z = lerp(before.velocity_z, g.velocity_z, part);
      passed(g.x, g.y);
      below = bed.at(g.x, g.y);
      break;
    }
    passed(g.x, g.y);
    gap = left;
  }
  g.z = below.height;
  return below;
}

/// A bounce off a surface: the velocity into it is turned round and damped, that along it is damped. Gives
/// the speed away from the surface [m/s].
DESERT_HD float bounce(const Surface& surface, float normal_restitution, float tangential_restitution,
                       Grain& g) {
  const float sx = surface.slope_x, sy = surface.slope_y;
  const float size = 1.0f / sqrtf(1.0f + sx * sx + sy * sy);
  const float nx = -sx * size, ny = -sy * size, nz = size;
  const float into = g.velocity_x * nx + g.velocity_y * ny + g.velocity_z * nz;
  const float change = -(normal_restitution + tangential_restitution) * minimum(into, 0.0f);
  g.velocity_x = tangential_restitution * g.velocity_x + change * nx;
  g.velocity_y = tangential_restitution * g.velocity_y + change * ny;
  g.velocity_z = tangential_restitution * g.velocity_z + change * nz;
  return -normal_restitution * minimum(into, 0.0f);
}

}  // namespace desert_sim::particles
