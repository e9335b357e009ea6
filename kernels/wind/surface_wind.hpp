#pragma once
/// The wind of each terrain cell from the wind of the coarse grid; equations in wind.hpp.

#include "kernels/backend/for_each.hpp"
#include "kernels/field/math.hpp"
#include "kernels/wind/coarse_wind.hpp"
#include "kernels/wind/vector.hpp"

namespace desert_sim::wind {

/// Speed-up factor over the high-altitude wind, at `rise` metres above the lowest ground.
struct SpeedUp {
  float per_metre, lowest, highest;
  DESERT_HD float operator()(float rise) const {
    return fast_min(fast_max(fused(per_metre, rise, 1.0f), lowest), highest);
  }
};

/// The wind of each cell: direction from the coarse grid, speed-up by the cell's own height, correction of
/// the projection and, if `perturbed`, the perturbation of local features. One call computes `strip` cells of
/// a column, which share the values that they load from the coarse grid.
template <int strip, bool perturbed>
struct SurfaceWind {
  CoarseGrid coarse;
  const float* heights;
  float reference, quantum;
  Vector above;
  float per_speed_squared;  ///< 1/|above|², or 0
  SpeedUp speed_up;
  const Complex *warped_wind, *correction;  ///< both null: uniform wind, no correction
  const float *perturbation_x, *perturbation_y;
  float *wind_x, *wind_y;

  DESERT_HD Grid strips() const {
    return Grid{coarse.fine.width, (coarse.fine.height + strip - 1) / strip, 1};
  }

  /// Linear interpolation between vectors of different direction shortens them. The series restores the speed
  /// to within 0.1 % where directions differ by up to 60 degrees.
  DESERT_HD Vector restore_speed(const Complex& w) const {
    const float missing = fused(-(w.re * w.re + w.im * w.im), per_speed_squared, 1.0f);
    const float series = fused(missing, fused(missing, fused(missing, 0.3125f, 0.375f), 0.5f), 1.0f);
    const float scale = w.re == above.x && w.im == above.y ? 1.0f : series;
    return {w.re * scale, w.im * scale};
  }

  DESERT_HD void operator()(int x, int n) const {
    const int first = strip * n, rows = strip == 1 ? 1 : clamp_index(coarse.fine.height - first, strip + 1);
    float h[strip];  // all loads come before the first store, so that a GPU waits for memory once
    unrolled<strip>([&](auto k) DESERT_INLINE {
      if (strip == 1 || k < rows) h[k] = heights[coarse.fine.index(x, first + k)];
    });
    const AxisInterpolation along_x = coarse.interpolation_x(x);
    CoarseColumn direction(warped_wind, along_x, coarse.width),
        corrections(correction, along_x, coarse.width);
    int row = -1;
    unrolled<strip>([&](auto k) DESERT_INLINE {
      if (strip > 1 && k >= rows) return;
      const AxisInterpolation along_y = coarse.interpolation_y(first + k);
      if (warped_wind && (strip == 1 || along_y.first != row)) {
        direction.move_to(along_y);
        corrections.move_to(along_y);
        row = along_y.first;
      }
      const float factor = speed_up((h[k] - reference) * quantum);
      const Vector wind = warped_wind ? restore_speed(direction.at(along_y.share)) : above;
      const Complex corrected = corrections.at(along_y.share);
      const int i = coarse.fine.index(x, first + k);
      const Vector local = perturbed ? Vector{perturbation_x[i], perturbation_y[i]} : Vector{};
      wind_x[i] = fused(wind.x, factor, corrected.re) + local.x;
      wind_y[i] = fused(wind.y, factor, corrected.im) + local.y;
    });
  }
};

}  // namespace desert_sim::wind
