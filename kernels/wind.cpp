#include "desert_sim/kernels/wind.hpp"

#include <algorithm>
#include <cmath>

namespace desert_sim::wind {

namespace {
/// Coarse axes shorter than this gain nothing and would show in the result.
constexpr int fewest_coarse_cells = 64;
}  // namespace

CoarseGrid coarse_grid(const Grid& fine, const WindParameters& p) {
  float ratio = static_cast<float>(p.coarsening);
  if (p.coarsening == 0) {
    float smallest = 1e9f;
    for (int r = 0; r < p.radii.count; ++r) smallest = std::min(smallest, p.radii.values[r]);
    ratio = std::max(1.0f, std::floor(0.5f * smallest / 4.0f / fine.cell_size));
  }
  const auto cells = [&](int n) {
    return std::max(std::min(n, fewest_coarse_cells), static_cast<int>(std::lround(n / ratio)));
  };
  CoarseGrid c;
  c.fine = fine;
  c.columns = p.coarsening == 0 ? cells(fine.width) : std::max(1, static_cast<int>(std::lround(fine.width / ratio)));
  c.rows = p.coarsening == 0 ? cells(fine.height) : std::max(1, static_cast<int>(std::lround(fine.height / ratio)));
  c.width = fine.periodic_x ? c.columns : 2 * c.columns;
  c.height = fine.periodic_y ? c.rows : 2 * c.rows;
  c.ratio_x = static_cast<float>(fine.width) / c.columns;
  c.ratio_y = static_cast<float>(fine.height) / c.rows;
  return c;
}

Workspace make_workspace(Exec& exec, const Grid& fine, const WindParameters& p) {
  Workspace work;
  work.coarse = coarse_grid(fine, p);
  if (!p.warping && !p.projection) return work;
  const std::size_t values = static_cast<std::size_t>(work.coarse.width) * work.coarse.height;
  work.fft = exec.make_fft(work.coarse.width, work.coarse.height);
  work.spectrum = Buffer<Complex>(exec, values);
  const int buffers = p.warping ? std::max(1, p.radii.count) : 1;
  for (int r = 0; r < buffers; ++r) work.gradients[r] = Buffer<Complex>(exec, values);
  return work;
}

}  // namespace desert_sim::wind
