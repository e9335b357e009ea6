#include "desert_sim/kernels/wind.hpp"

#include <algorithm>
#include <cmath>

namespace desert_sim::wind {

namespace {
/// Coarse axes shorter than this gain nothing and would show in the result.
constexpr int fewest_coarse_cells = 64;

/// The next number whose only prime factors are 2, 3 and 5: transforms of such lengths are fast.
int smooth_length(int n) {
  for (;; ++n) {
    int rest = n;
    for (int factor : {2, 3, 5})
      while (rest % factor == 0) rest /= factor;
    if (rest == 1) return n;
  }
}
}  // namespace

CoarseGrid coarse_grid(const Grid& fine, const WindParameters& p) {
  float ratio = static_cast<float>(p.coarsening);
  if (p.coarsening == 0) {
    float smallest = 1e9f;
    for (int r = 0; r < p.radii.count; ++r) smallest = std::min(smallest, p.radii.values[r]);
    ratio = std::max(1.0f, std::floor(0.5f * smallest / 4.0f / fine.cell_size));
  }
  const auto cells = [&](int n) {
    const int coarse = std::max(1, static_cast<int>(std::lround(n / ratio)));
    if (p.coarsening != 0) return coarse;
    return std::min(n, smooth_length(std::max(coarse, fewest_coarse_cells)));
  };
  CoarseGrid c;
  c.fine = fine;
  c.columns = cells(fine.width);
  c.rows = cells(fine.height);
  c.width = fine.periodic_x ? c.columns : 2 * c.columns;
  c.height = fine.periodic_y ? c.rows : 2 * c.rows;
  c.ratio_x = static_cast<float>(fine.width) / c.columns;
  c.ratio_y = static_cast<float>(fine.height) / c.rows;
  c.share_x = 1.0f / c.ratio_x;
  c.share_y = 1.0f / c.ratio_y;
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
