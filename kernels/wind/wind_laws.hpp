#pragma once
/// The laws of wind.hpp, cell by cell.

#include <memory>
#include <type_traits>

#include "kernels/backend/buffer.hpp"
#include "kernels/backend/fft.hpp"
#include "kernels/backend/for_each.hpp"
#include "kernels/backend/line_transform.hpp"
#include "kernels/base/math.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/surface.hpp"
#include "kernels/wind/coarse_wind.hpp"
#include "kernels/wind/surface_wind.hpp"
#include "kernels/wind/wind.hpp"
#include "kernels/wind/wind_turning.hpp"
#include "src/core/parameter_table.hpp"

namespace desert_sim::wind {

/// Laws of the coarse grid in the order in which they run: box filter, FFT, response of the terrain, inverse
/// FFT, warped wind, FFT, projection, inverse FFT, mean.
struct CoarseLaws {
  CoarsenColumns columns;
  TerrainResponse response;  ///< without warping for no radius
  WarpWind warp;
  Projection project;
  MeanWind mean;
  bool projected;
};

/// Whether the speed-up is a response of the terrain's transform: that of jackson_hunt lives in the projected
/// flux.
inline bool has_response(const WindParameters& p) {
  return p.speedup_law == SpeedUpLaw::jackson_hunt && p.projection && p.speedup_response > 0.0f;
}
/// Whether anything is computed on the coarse grid.
inline bool has_coarse_fields(const WindParameters& p) { return p.warping || p.projection; }
/// Fields of the terrain's response.
inline int response_fields(const WindParameters& p) {
  return (p.warping ? p.radii.count : 0) + (has_response(p) ? 1 : 0);
}
/// The bounds of the speed-up, and how it grows with height, if it does.
inline SpeedUp speed_up(const WindParameters& p) {
  if (has_response(p)) return {0, p.response_lowest, p.response_highest};
  const bool by_height = p.speedup_law == SpeedUpLaw::venturi || !p.projection;
  return {by_height ? p.speedup : 0.0f, p.speedup_lowest, p.speedup_highest};
}

inline CoarseLaws coarse_laws(const TerrainView& t, const WindParameters& p, Vector above, float speed_above,
                              const Workspace& work) {
  const CoarseGrid& coarse = work.coarse;
  Complex* const spectrum = work.spectrum.data();
  const FlowTransfer *const flow_x = work.flow_x.data(), *const flow_y = work.flow_y.data();
  const int radius_count = p.warping ? p.radii.count : 0;
  const bool by_response = has_response(p);
  CoarseLaws laws{};
  laws.columns = {coarse, work.row_means.data(), t.quantum, work.rise.data(), spectrum};
  laws.response = {coarse, radius_count, 0.0f, spectrum, {}, {}, flow_x, flow_y, work.responses.data()};
  if (by_response) laws.response.response = p.speedup_response / coarse.fine.cell_size;
  laws.warp.coarse = coarse;
  laws.warp.rise = work.rise.data();
  laws.warp.above = above;
  laws.warp.speed_above = speed_above;
  laws.warp.speed_up = speed_up(p);
  laws.warp.by_response = by_response;
  laws.warp.radius_count = radius_count;
  laws.warp.gradient_scale = p.gradient_scale;
  laws.warp.responses = work.responses.data();
  laws.warp.warped = work.warped.data();
  laws.warp.factors = work.rise.data();
  laws.warp.unprojected = spectrum;
  for (int r = 0; r < radius_count; ++r) {
    laws.response.along_x[r] = work.along_x[r].data();
    laws.response.along_y[r] = work.along_y[r].data();
    laws.warp.weights[r] = p.weights.values[r];
    laws.warp.deflections[r] = p.deflections.values[r];
  }
  laws.project = {coarse, spectrum, 1.0f / static_cast<float>(coarse.values()),
                  flow_x, flow_y,   work.responses.data()};
  laws.mean = {coarse, work.rise.data(), work.warped.data(), work.responses.data(),
               by_response ? work.mean_sums.data() : nullptr};
  laws.projected = p.projection;
  return laws;
}

/// Lines that a thread block of transform_in_one_kernel() transforms at a time.
constexpr int lines_per_block = 2;

/// Shared memory of such a block [bytes]: two buffers for each line of each response, between which the
/// transform alternates, and the roots of unity of both axes.
inline std::size_t bytes_for_lines(const CoarseGrid& c, int response_fields) {
  const int longest = c.width > c.height ? c.width : c.height,
            fields = response_fields > 1 ? response_fields : 1;
  return sizeof(Complex) *
         static_cast<std::size_t>(2 * longest * lines_per_block * fields + c.width + c.height);
}

}  // namespace desert_sim::wind
