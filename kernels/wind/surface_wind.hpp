#pragma once
/// The wind of each terrain cell from the wind of the coarse grid; equations in wind.hpp.

#include "kernels/backend/for_each.hpp"
#include "kernels/field/math.hpp"
#include "kernels/wind/coarse_wind.hpp"
#include "kernels/wind/vector.hpp"

namespace desert_sim::wind {

/// Factor of the speed-up over the high-altitude wind.
struct SpeedUp {
  float per_metre, lowest, highest;
  DESERT_HD float bounded(float factor) const { return fast_min(fast_max(factor, lowest), highest); }
  /// Of a response s: 1 + s for small ones, and never beyond the bounds, which it approaches smoothly.
  DESERT_HD float of_response(float s) const {
    const float most = s > 0.0f ? highest - 1.0f : 1.0f - lowest;
    return most > 0.0f ? 1.0f + s * most / sqrtf(most * most + s * s) : 1.0f;
  }
  /// By height, at `rise` metres above the reference.
  DESERT_HD float operator()(float rise) const { return bounded(fused(per_metre, rise, 1.0f)); }
};

/// The wind of each cell: the deflected wind or projected flux of the coarse grid, times the speed-up and, if
/// `perturbed`, plus the perturbation of local features. One call computes `strip` cells of a column, which
/// share the values that they load from the coarse grid.
template <int strip, bool perturbed>
struct SurfaceWind {
  CoarseGrid coarse;
  const float* heights;
  float reference, quantum;
  Vector above;
  float per_speed_squared;  ///< 1/|above|², or 0
  SpeedUp speed_up;
  const Complex* deviation;  ///< of the deflected wind, or of the flux, from `above`; null: none
  bool keeps_speed;          ///< the deflected wind is as fast as `above`
  const float* factors;      ///< of the speed-up on the coarse grid; null: by the cell's own height
  const float *perturbation_x, *perturbation_y;
  float *wind_x, *wind_y;

  DESERT_HD Grid strips() const {
    return Grid{coarse.fine.width, (coarse.fine.height + strip - 1) / strip, 1};
  }

  /// Interpolation between vectors of different direction shortens them. The series restores the speed
  /// to within 0.1 % where directions differ by up to 60 degrees.
  DESERT_HD Vector restore_speed(Vector w) const {
    const float missing = fused(-(w.x * w.x + w.y * w.y), per_speed_squared, 1.0f);
    const float series = fused(missing, fused(missing, fused(missing, 0.3125f, 0.375f), 0.5f), 1.0f);
    const float scale = w.x == above.x && w.y == above.y ? 1.0f : series;
    return {w.x * scale, w.y * scale};
  }
  DESERT_HD Vector wind_at(const CoarseColumn<Complex>& deviations, const AxisInterpolation& along_y) const {
    if (!deviation) return above;
    const Complex d = deviations.at(along_y);
    const Vector wind{above.x + d.re, above.y + d.im};
    return keeps_speed ? restore_speed(wind) : wind;
  }

  DESERT_HD void operator()(int x, int n) const {
    const int first = strip * n, rows = strip == 1 ? 1 : clamp_index(coarse.fine.height - first, strip + 1);
    float h[strip];  // all loads come before the first store, so that a GPU waits for memory once
    unrolled<strip>([&](auto k) DESERT_INLINE {
      if (!factors && (strip == 1 || k < rows)) h[k] = heights[coarse.fine.index(x, first + k)];
    });
    const AxisInterpolation along_x = coarse.interpolation_x(x);
    CoarseColumn<Complex> deviations(deviation, along_x, coarse.width);
    CoarseColumn<float> speed_ups(factors, along_x, coarse.width);
    int row = -1;
    unrolled<strip>([&](auto k) DESERT_INLINE {
      if (strip > 1 && k >= rows) return;
      const AxisInterpolation along_y = coarse.interpolation_y(first + k);
      if (strip == 1 || along_y.nearest != row) {
        if (deviation) deviations.move_to(along_y);
        if (factors) speed_ups.move_to(along_y);
        row = along_y.nearest;
      }
      const float factor = factors ? speed_ups.at(along_y) : speed_up((h[k] - reference) * quantum);
      const Vector wind = wind_at(deviations, along_y);
      const int i = coarse.fine.index(x, first + k);
      const Vector local = perturbed ? Vector{perturbation_x[i], perturbation_y[i]} : Vector{};
      wind_x[i] = fused(wind.x, factor, local.x);
      wind_y[i] = fused(wind.y, factor, local.y);
    });
  }
};

}  // namespace desert_sim::wind
