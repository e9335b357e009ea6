#pragma once
/// The wind of each terrain cell from the wind of the coarse grid; equations in wind.hpp.

#include "kernels/backend/for_each.hpp"
#include "kernels/base/math.hpp"
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

/// Memory for the rows of InterpolateRows: one value a cell of the terrain each.
struct RowScratch {
  float *deviation, *factors;
};

/// Interpolates the fields of SurfaceWind along x, for all columns of the terrain in each coarse row. Along y
/// a CPU then finds the values of neighbouring cells beside each other, and interpolates whole vectors.
struct InterpolateRows {
  CoarseGrid coarse;
  const Complex* deviation;  ///< null: none
  const float* factors;      ///< null: none
  Complex* deviation_rows;
  float* factor_rows;

  DESERT_HD Grid grid() const { return Grid{coarse.fine.width, coarse.height, 1, true, true}; }
  /// Size of the rows of one field.
  DESERT_HD static long long values(const CoarseGrid& coarse) {
    return static_cast<long long>(coarse.fine.width) * coarse.height;
  }
  DESERT_HD void operator()(int x, int row) const {
    const AxisInterpolation along_x = coarse.interpolation_x(x);
    const int i = row * coarse.fine.width + x;
    if (deviation) deviation_rows[i] = CoarseColumn<Complex>(deviation, along_x, coarse.width).in_row(row);
    if (factors) factor_rows[i] = CoarseColumn<float>(factors, along_x, coarse.width).in_row(row);
  }
};

/// The uniform flux that restores the mean wind (c in wind.hpp): `known`, or from the sums of MeanWind.
struct MeanFlux {
  const long long* sums;  ///< null: `known`
  Vector known;

  DESERT_HD Vector operator()() const {
    if (!sums) return known;
    const float factor = static_cast<float>(sums[2]);
    return {static_cast<float>(sums[0]) / factor, static_cast<float>(sums[1]) / factor};
  }
};

/// What the wind of the cells is made from: the deflected wind or projected flux of the coarse grid, times
/// the speed-up and, if there is one, plus the perturbation of local features.
struct SurfaceWindInputs {
  CoarseGrid coarse;
  const float* heights;
  float reference, quantum;
  Vector above;
  float per_speed_squared;  ///< 1/|above|², or 0
  SpeedUp speed_up;
  const Complex* deviation;  ///< of the deflected wind, or of the flux, from `above`; null: none
  MeanFlux mean;             ///< added to the flux
  bool keeps_speed;          ///< the deflected wind is as fast as `above`
  const float* factors;      ///< of the speed-up on the coarse grid; null: by the cell's own height
  const float *perturbation_x, *perturbation_y;
  float *wind_x, *wind_y;
};

/// The wind of each cell. One call computes `strip` cells of a column, which share the values that they load
/// from the coarse grid. `interpolated`: deviation and factors are rows of InterpolateRows.
template <int strip, bool perturbed, bool interpolated>
struct SurfaceWind : SurfaceWindInputs {
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
  template <class Column>
  DESERT_HD Vector wind_at(const Column& deviations, const AxisInterpolation& along_y,
                           Vector mean_flux) const {
    if (!deviation) return above;
    const Complex d = deviations.at(along_y);
    const Vector wind{above.x + (d.re + mean_flux.x), above.y + (d.im + mean_flux.y)};
    return keeps_speed ? restore_speed(wind) : wind;
  }

  template <class Value>
  DESERT_HD auto column(const Value* field, int x) const {
    if constexpr (interpolated)
      return InterpolatedColumn<Value>(field, x, coarse.fine.width);
    else
      return CoarseColumn<Value>(field, coarse.interpolation_x(x), coarse.width);
  }

  DESERT_HD void operator()(int x, int n) const {
    const int first = strip * n, rows = strip == 1 ? 1 : clamp_index(coarse.fine.height - first, strip + 1);
    float h[strip];  // all loads come before the first store, so that a GPU waits for memory once
    unrolled<strip>([&](auto k) DESERT_INLINE {
      if (!factors && (strip == 1 || k < rows)) h[k] = heights[coarse.fine.index(x, first + k)];
    });
    const Vector mean_flux = mean();
    auto deviations = column(deviation, x);
    auto speed_ups = column(factors, x);
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
      const Vector wind = wind_at(deviations, along_y, mean_flux);
      const int i = coarse.fine.index(x, first + k);
      const Vector local = perturbed ? Vector{perturbation_x[i], perturbation_y[i]} : Vector{};
      wind_x[i] = fused(wind.x, factor, local.x);
      wind_y[i] = fused(wind.y, factor, local.y);
    });
  }
};

}  // namespace desert_sim::wind
