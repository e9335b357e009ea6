#pragma once
/// Slip and sinkage of a rover whose middle stands over a cell, by the laws of wheel_ground.hpp.
///
///   slope      max over the lines j of |mean over the axles of ∂h/∂j|, as an angle
///   slip, slip_downhill, slip_across    of a rover that drives up, down and across it
///   sinkage    of its wheels at the uphill slip
///
/// The lines are those through the cell along x, along y, and along both diagonals. A rover stands on each
/// with three axles: one at the cell, and one half a `wheelbase` away on either side, at whole cells, of
/// those that are on the grid. So ripples much shorter than the rover count less than those that all of its
/// wheels climb at once. Looseness, depth of sand and moisture are means over all of these nine cells.
/// Without the layer looseness, sand has the `assumed_looseness` of the section wheel_ground.
///
/// Reads elevation, sand, soil, moisture, looseness; writes those of slip, slip_downhill, slip_across and
/// sinkage that are present in the view.

#include "kernels/backend/for_each.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/rover/surface_differences.hpp"
#include "kernels/rover/traversability.hpp"
#include "kernels/rover/wheel_ground.hpp"
#include "kernels/sand/repose.hpp"

namespace desert_sim::traversability {

constexpr int max_half_wheelbase = 64;  ///< [cells]

/// The rover of `wheels` at a cell.
struct WheelsAt {
  Surface surface;
  wheels::WheelGround law;
  int straight, diagonal;  ///< half a wheelbase [cells along x and y]
  float speed, assumed_looseness;
  const float* looseness;
  const Quanta* sand;
  repose::RelativeMoisture moisture;

  struct State {
    float slope;  ///< [rad]
    wheels::Ground ground;
  };

  /// Rise per metre towards (dx, dy) at cell (x, y).
  DESERT_HD float rise(int x, int y, int dx, int dy) const {
    const float run = dx != 0 && dy != 0 ? 1.41421356f : 1.0f;
    return surface.central(x, y, dx, dy) / (run * surface.grid.cell_size);
  }
  /// Its mean over the axles that stand on the grid.
  DESERT_HD float mean_rise(int x, int y, int dx, int dy, int half) const {
    int axles = 1;
    const auto outer_rise = [&](int outer_x, int outer_y) {
      if (!move_onto(surface.grid, outer_x, outer_y)) return 0.0f;
      ++axles;
      return rise(outer_x, outer_y, dx, dy);
    };
    const float ahead = outer_rise(x + half * dx, y + half * dy),
                outer = ahead + outer_rise(x - half * dx, y - half * dy);
    return (outer + rise(x, y, dx, dy)) / static_cast<float>(axles);
  }
  /// Sums of looseness, depth [m] and moisture over two opposite cells.
  struct Sum {
    float looseness, depth, moisture, cells;
    DESERT_HD Sum operator+(const Sum& o) const {
      return {looseness + o.looseness, depth + o.depth, moisture + o.moisture, cells + o.cells};
    }
  };
  DESERT_HD Sum ground_at(int x, int y) const {
    const int i = neighbour_index(surface.grid, x, y);
    if (i < 0) return {0.0f, 0.0f, 0.0f, 0.0f};
    return {looseness ? looseness[i] : assumed_looseness,
            static_cast<float>(value_or_zero(sand, i)) * surface.quantum, moisture(i), 1.0f};
  }
  DESERT_HD Sum pair(int x, int y, int dx, int dy) const {
    return ground_at(x + dx, y + dy) + ground_at(x - dx, y - dy);
  }

  DESERT_HD State operator()(int x, int y) const {
    const float east = fabsf(mean_rise(x, y, 1, 0, straight)), north = fabsf(mean_rise(x, y, 0, 1, straight)),
                rising = fabsf(mean_rise(x, y, 1, 1, diagonal)),
                falling = fabsf(mean_rise(x, y, 1, -1, diagonal));
    // The order of the sums is such that rotated and mirrored terrain gives the same bits.
    const Sum sum = ground_at(x, y) + ((pair(x, y, straight, 0) + pair(x, y, 0, straight)) +
                                       (pair(x, y, diagonal, diagonal) + pair(x, y, diagonal, -diagonal)));
    return {arctangent(maximum(maximum(east, north), maximum(rising, falling))),
            {sum.looseness / sum.cells, sum.depth / sum.cells, sum.moisture / sum.cells}};
  }
  DESERT_HD float uphill_slip(const State& s) const {
    return law.longitudinal_slip(s.slope, speed, s.ground);
  }
  DESERT_HD float sinkage(const State& s, float slip) const { return law.sinkage(slip, 1.0f, s.ground); }
};

/// Writes the layers; those that are null are not written.
struct WheelLayers {
  WheelsAt wheels;
  float *slip, *slip_downhill, *slip_across, *sinkage;

  DESERT_HD void operator()(int x, int y) const {
    const int i = wheels.surface.grid.index(x, y);
    const WheelsAt::State state = wheels(x, y);
    if (slip || sinkage) {
      const float uphill = wheels.uphill_slip(state);
      if (slip) slip[i] = uphill;
      if (sinkage) sinkage[i] = wheels.sinkage(state, uphill);
    }
    if (slip_downhill)
      slip_downhill[i] = wheels.law.longitudinal_slip(-state.slope, wheels.speed, state.ground);
    if (slip_across) slip_across[i] = wheels.law.lateral_slip(state.slope, state.ground);
  }
};

inline WheelsAt make_wheels_at(const TerrainView& t, const Surface& surface, const Rover& rover) {
  const float half = 0.5f * rover.limits.wheelbase / t.grid.cell_size;
  const auto cells = [](float length) {
    return static_cast<int>(minimum(length + 0.5f, static_cast<float>(max_half_wheelbase)));
  };
  return {surface,
          wheels::make_wheel_ground(rover.limits, rover.ground, rover.repose),
          cells(half),
          cells(half / 1.41421356f),
          rover.limits.drive_speed,
          rover.ground.assumed_looseness,
          t.real(Layer::looseness),
          t.quanta(Layer::sand),
          repose::RelativeMoisture(t, rover.repose)};
}

}  // namespace desert_sim::traversability
