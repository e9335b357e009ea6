#pragma once
/// The wind of each cell from that of the coarse grid; equations in wind.hpp.

#include "kernels/backend/for_each.hpp"
#include "kernels/field/math.hpp"
#include "kernels/wind/coarse_wind.hpp"

namespace desert_sim::wind {

/// The wind high above the ground, now [m/s].
struct Vector {
  float x = 0, y = 0;
};

/// Factor of the wind above, `rise` metres above the lowest ground.
struct SpeedUp {
  float per_metre, lowest, highest;
  DESERT_HD float operator()(float rise) const {
    return lower(higher(fused(per_metre, rise, 1.0f), lowest), highest);
  }
};

/// The wind of each cell: direction from the coarse grid, speed by its own height, what the projection
/// corrects, and, if `perturbed`, the perturbation of local features. `strip` cells, one above the other,
/// share what they read of the coarse grid.
template <int strip, bool perturbed>
struct SurfaceWind {
  CoarseGrid coarse;
  const float* heights;
  float reference, quantum;
  Vector above;
  float per_speed_squared;  ///< 1/|above|², or 0
  SpeedUp speed_up;
  const Complex *turned, *correction;  ///< both null: the wind above, and none
  const float *perturbation_x, *perturbation_y;
  float *wind_x, *wind_y;

  DESERT_HD Grid strips() const {
    return Grid{coarse.fine.width, (coarse.fine.height + strip - 1) / strip, 1};
  }

  /// Between differing directions a linear interpolation is too short; the series makes up for it within 0.1
  /// % where they differ by up to 60 degrees.
  DESERT_HD Vector at_full_speed(const Complex& w) const {
    const float missing = fused(-(w.re * w.re + w.im * w.im), per_speed_squared, 1.0f);
    const float series = fused(missing, fused(missing, fused(missing, 0.3125f, 0.375f), 0.5f), 1.0f);
    const float scale = w.re == above.x && w.im == above.y ? 1.0f : series;
    return {w.re * scale, w.im * scale};
  }

  DESERT_HD void operator()(int x, int n) const {
    const int first = strip * n, rows = strip == 1 ? 1 : clamp_index(coarse.fine.height - first, strip + 1);
    float h[strip];  // all are read before anything is written, for which a GPU then waits once
    unrolled<strip>([&](auto k) DESERT_INLINE {
      if (strip == 1 || k < rows) h[k] = heights[coarse.fine.index(x, first + k)];
    });
    const AxisPlace across = coarse.across(x);
    CoarseColumn direction(turned, across, coarse.width), corrections(correction, across, coarse.width);
    int row = -1;
    unrolled<strip>([&](auto k) DESERT_INLINE {
      if (strip > 1 && k >= rows) return;
      const AxisPlace along = coarse.along(first + k);
      if (turned && (strip == 1 || along.first != row)) {
        direction.move_to(along);
        corrections.move_to(along);
        row = along.first;
      }
      const float factor = speed_up((h[k] - reference) * quantum);
      const Vector wind = turned ? at_full_speed(direction.at(along.share)) : above;
      const Complex corrected = corrections.at(along.share);
      const int i = coarse.fine.index(x, first + k);
      const Vector local = perturbed ? Vector{perturbation_x[i], perturbation_y[i]} : Vector{};
      wind_x[i] = fused(wind.x, factor, corrected.re) + local.x;
      wind_y[i] = fused(wind.y, factor, corrected.im) + local.y;
    });
  }
};

}  // namespace desert_sim::wind
