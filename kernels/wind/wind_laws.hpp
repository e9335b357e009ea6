#pragma once
/// The laws of wind.hpp, cell by cell.

#include <memory>
#include <type_traits>

#include "kernels/backend/buffer.hpp"
#include "kernels/backend/fft.hpp"
#include "kernels/backend/for_each.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/math.hpp"
#include "kernels/field/surface.hpp"
#include "kernels/wind/coarse_wind.hpp"
#include "kernels/wind/surface_wind.hpp"
#include "kernels/wind/tuned/line_transform.hpp"
#include "kernels/wind/wind.hpp"
#include "kernels/wind/wind_turning.hpp"
#include "src/core/parameters.hpp"

namespace desert_sim::wind {

/// Laws of the coarse grid in the order in which they run: box filter, FFT, gradients, inverse FFT, warped
/// wind, FFT, correction of the projection, inverse FFT.
struct CoarseLaws {
  CoarsenColumns columns;
  SmoothedGradients gradients;  ///< without warping for no radius
  WarpWind warp;
  ProjectionCorrection correct;
  bool projected;
};

inline CoarseLaws coarse_laws(const TerrainView& t, const WindParameters& p, Vector above, float speed_above,
                              const SpeedUp& speed_up, const Workspace& work) {
  const CoarseGrid& coarse = work.coarse;
  Complex* const spectrum = work.spectrum.data();
  const int radius_count = p.warping ? p.radii.count : 0;
  CoarseLaws laws{{coarse, work.row_means.data(), t.quantum, work.rise.data(), spectrum},
                  {coarse, radius_count, spectrum, {}, {}, work.gradients.data()},
                  {coarse,
                   work.rise.data(),
                   above,
                   speed_above,
                   speed_up,
                   radius_count,
                   {},
                   {},
                   p.gradient_scale,
                   work.gradients.data(),
                   work.warped_wind.data(),
                   spectrum},
                  {coarse, spectrum, 1.0f / static_cast<float>(coarse.values()), work.correction.data()},
                  p.projection};
  for (int r = 0; r < radius_count; ++r) {
    laws.gradients.along_x[r] = work.along_x[r].data();
    laws.gradients.along_y[r] = work.along_y[r].data();
    laws.warp.weights[r] = p.weights.values[r];
    laws.warp.deflections[r] = p.deflections.values[r];
  }
  return laws;
}

/// Lines that a thread block of transform_by_lines() transforms at a time.
constexpr int lines_per_block = 2;

/// Shared memory of such a block [bytes]: two buffers for each line of each radius, between which the
/// transform alternates, and the roots of unity of both axes.
inline std::size_t bytes_for_lines(const CoarseGrid& c, int radius_count) {
  const int longest = c.width > c.height ? c.width : c.height, fields = radius_count > 1 ? radius_count : 1;
  return sizeof(Complex) *
         static_cast<std::size_t>(2 * longest * lines_per_block * fields + c.width + c.height);
}

}  // namespace desert_sim::wind
