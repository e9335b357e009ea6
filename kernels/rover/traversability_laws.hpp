#pragma once
/// The laws of traversability.hpp, cell by cell.

#include "kernels/backend/for_each.hpp"
#include "kernels/base/math.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/rover/surface_differences.hpp"
#include "kernels/rover/traversability.hpp"
#include "kernels/rover/wheel_layers.hpp"
#include "kernels/sand/repose.hpp"
#include "src/core/constants.hpp"
#include "src/core/elementary.hpp"
#include "src/core/parameter_table.hpp"

namespace desert_sim::traversability {

/// Slope and normal; outputs that are null are not written.
struct Orientation {
  Surface surface;
  float *slope, *normal_x, *normal_y, *normal_z;

  DESERT_HD void operator()(int x, int y) const {
    const int i = surface.grid.index(x, y);
    if (slope) slope[i] = arctangent(surface.steepness(x, y));
    const float gx = surface.central(x, y, 1, 0) / surface.grid.cell_size,
                gy = surface.central(x, y, 0, 1) / surface.grid.cell_size;
    const float length = sqrtf(1.0f + (gx * gx + gy * gy));
    if (normal_x) normal_x[i] = -gx / length;
    if (normal_y) normal_y[i] = -gy / length;
    if (normal_z) normal_z[i] = 1.0f / length;
  }
};

struct Roughness {
  Surface surface;
  int reach;  ///< half width of the window [cells]
  float* roughness;

  /// Root mean square residual, from the sums of the least-squares fit. The window is a rectangle, so that
  /// the fits along x and y separate. Heights are clamped to ±2²⁶ quanta around the cell's, so that the sums
  /// fit 63 bits.
  DESERT_HD float at(int x, int y) const {
    constexpr Quanta height_limit = Quanta{1} << 26;
    const int i = surface.grid.index(x, y);
    long long n = 0, sx = 0, sy = 0, sxx = 0, syy = 0, sh = 0, sxh = 0, syh = 0, shh = 0;
    for (int dy = -reach; dy <= reach; ++dy)
      for (int dx = -reach; dx <= reach; ++dx) {
        Quanta rise;
        if (!surface.rise(i, x + dx, y + dy, rise)) continue;
        const long long h =
            rise > height_limit ? height_limit : (rise < -height_limit ? -height_limit : rise);
        n += 1, sx += dx, sy += dy, sxx += dx * dx, syy += dy * dy;
        sh += h, sxh += dx * h, syh += dy * h, shh += h * h;
      }
    const auto explained = [n](long long covariance, long long variance) {
      const double c = static_cast<double>(covariance);
      return variance == 0 ? 0.0 : c * c / (static_cast<double>(variance) * static_cast<double>(n));
    };
    const double mean = static_cast<double>(sh) * static_cast<double>(sh) / static_cast<double>(n);
    const double in_plane =
        explained(n * sxh - sx * sh, n * sxx - sx * sx) + explained(n * syh - sy * sh, n * syy - sy * sy);
    const double residual = static_cast<double>(shh) - mean - in_plane;
    return residual > 0 ? static_cast<float>(sqrt(residual / static_cast<double>(n))) * surface.quantum
                        : 0.0f;
  }
  /// Whether all of the window has one height.
  DESERT_HD bool level_at(int x, int y) const {
    const int i = surface.grid.index(x, y);
    for (int dy = -reach; dy <= reach; ++dy)
      for (int dx = -reach; dx <= reach; ++dx) {
        Quanta rise;
        if (surface.rise(i, x + dx, y + dy, rise) && rise != 0) return false;
      }
    return true;
  }
  DESERT_HD void operator()(int x, int y) const { roughness[surface.grid.index(x, y)] = at(x, y); }
};

struct StepHeight {
  Surface surface;
  int reach;       ///< half width of the window [cells]
  float drivable;  ///< tangent of the slope up to which a rise is no step
  float* step_height;

  DESERT_HD float at(int x, int y) const {
    const int i = surface.grid.index(x, y);
    const float gx = surface.minmod_difference(x, y, 1, 0), gy = surface.minmod_difference(x, y, 0, 1);
    float highest = 0.0f;
    for (int dy = -reach; dy <= reach; ++dy)
      for (int dx = -reach; dx <= reach; ++dx) {
        Quanta quanta;
        if (!surface.rise(i, x + dx, y + dy, quanta)) continue;
        const float rise = quanta * surface.quantum;
        const float run = hypotenuse(static_cast<float>(dx), static_cast<float>(dy)) * surface.grid.cell_size;
        if (fabsf(rise) > run * drivable) highest = maximum(highest, fabsf(rise - (gx * dx + gy * dy)));
      }
    return highest;
  }
  DESERT_HD void operator()(int x, int y) const { step_height[surface.grid.index(x, y)] = at(x, y); }
};

struct Traversability {
  Roughness roughness;
  StepHeight step_height;
  WheelsAt wheels;
  float slope, sand_slope;  ///< limits [rad]
  TraversabilityParameters limits;
  const Quanta *sand, *soil, *water;
  repose::RelativeMoisture moisture;
  const float *water_velocity_x, *water_velocity_y, *vegetation, *obstacle;
  float* traversability;

  /// Half-saturated ground is firmest; wetter ground turns to mud, the more the deeper it is.
  DESERT_HD float mud(int i) const {
    const float depth =
        static_cast<float>(value_or_zero(sand, i) + value_or_zero(soil, i)) * roughness.surface.quantum;
    const float excess = maximum(moisture(i) - 0.5f, 0.0f) / (limits.mud - 0.5f);
    return excess * minimum(depth / limits.sand_depth, 1.0f);
  }

  /// What water takes off, by its depth, and by its depth × speed.
  DESERT_HD float flood(int i) const {
    const float depth = value_or_zero(water, i) * roughness.surface.quantum;
    if (!(depth > 0.0f) || !water_velocity_x) return depth / limits.water_depth;
    const float speed = hypotenuse(water_velocity_x[i], water_velocity_y[i]);
    return maximum(depth / limits.water_depth, depth * speed / limits.water_flow);
  }

  /// What the slope takes off; where looseness is not known, deep sand as well.
  DESERT_HD float steepness(int x, int y) const {
    const Surface& surface = roughness.surface;
    const float angle = arctangent(surface.steepness(x, y));
    if (wheels.looseness) return angle / slope;
    const float depth = value_or_zero(sand, surface.grid.index(x, y)) * surface.quantum;
    const float sand_share = minimum(depth / limits.sand_depth, 1.0f);
    return maximum(angle / lerp(slope, sand_slope, sand_share), limits.sand_cost * sand_share);
  }
  /// What loose ground takes off.
  DESERT_HD float slip_and_sinkage(int x, int y) const {
    const WheelsAt::State state = wheels(x, y);
    const float slip = wheels.uphill_slip(state);
    return maximum(slip / limits.slip, wheels.sinkage(state, slip) / (limits.sinkage * limits.wheel_radius));
  }

  DESERT_HD float at(int x, int y) const {
    const Surface& surface = roughness.surface;
    const int i = surface.grid.index(x, y);
    if (value_or_zero(obstacle, i) > 0.0f) return 0.0f;
    float worst = steepness(x, y);
    worst = maximum(worst, flood(i));
    worst = maximum(worst, mud(i));
    worst = maximum(worst, value_or_zero(vegetation, i) / limits.vegetation);
    if (worst < 1.0f && !roughness.level_at(x, y)) {  // level ground has neither steps nor roughness
      worst = maximum(worst, step_height.at(x, y) / limits.step_height);
      if (worst < 1.0f) worst = maximum(worst, roughness.at(x, y) / limits.roughness);
    }
    if (worst < 1.0f && wheels.looseness) worst = maximum(worst, slip_and_sinkage(x, y));
    return clamp(1.0f - worst, 0.0f, 1.0f);
  }
  DESERT_HD void operator()(int x, int y) const {
    traversability[roughness.surface.grid.index(x, y)] = at(x, y);
  }
};

/// The law for this rover; it writes those layers that are present in the view.
inline Traversability make_law(const TerrainView& t, const Rover& rover) {
  const TraversabilityParameters& p = rover.limits;
  const float degree = static_cast<float>(pi) / 180.0f;
  const int reach = window_cells(p, t.grid.cell_size);
  const Surface surface{t.grid, t.quanta(Layer::elevation), t.quantum};
  return {{surface, reach, t.real(Layer::roughness)},
          {surface, reach, static_cast<float>(elementary::tan_deg(p.slope_deg)), t.real(Layer::step_height)},
          make_wheels_at(t, surface, rover),
          p.slope_deg * degree,
          p.sand_slope_deg * degree,
          p,
          t.quanta(Layer::sand),
          t.quanta(Layer::soil),
          t.quanta(Layer::water),
          repose::RelativeMoisture(t, rover.repose),
          t.real(Layer::water_velocity_x),
          t.real(Layer::water_velocity_y),
          t.real(Layer::vegetation),
          t.real(Layer::obstacle),
          t.real(Layer::traversability)};
}

}  // namespace desert_sim::traversability
