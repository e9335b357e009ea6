#include <algorithm>
#include <cmath>

#include "kernels/backend/for_each.hpp"
#include "kernels/backend/line_transform.hpp"
#include "kernels/wind/coarse_modes.hpp"
#include "kernels/wind/shear_stress.hpp"
#include "kernels/wind/surface_wind.hpp"
#include "src/core/elementary.hpp"

namespace desert_sim::shear_stress {

double shear_velocity_per_wind(const ShearStressParameters& p) {
  return von_karman / elementary::log(static_cast<double>(p.wind_height) / p.roughness_length);
}

namespace {

/// The number of coarse cells along n cells: n itself unless a coarse cell is wider than one and a half,
/// because even a slight smoothing of the stress makes dunes of a few saturation lengths wider and lower;
/// else about n/ratio, with no prime factors but 2, 3 and 5, because transforms of such lengths are fast.
int coarse_cells(int n, double ratio) {
  if (ratio <= 1.5) return n;
  int coarse = std::clamp(static_cast<int>(std::lround(n / ratio)), 1, n);
  while (!has_small_factors(coarse)) --coarse;
  return coarse;
}

/// What undoes the attenuation of averaging and interpolation, with the transform's 1/n. Where the grid is
/// coarser than the terrain, a Gaussian of half a coarse cell takes the waves that it cannot hold.
std::vector<float> transfer(const wind::ModesOfAxis& modes) {
  const double sigma = modes.ratio > 1 ? 0.5 * modes.ratio : 0.0;
  std::vector<float> table(static_cast<std::size_t>(modes.n));
  for (int i = 0; i < modes.n; ++i)
    if (modes.ratio <= 1 || !modes.nyquist(i))
      table[static_cast<std::size_t>(i)] =
          static_cast<float>(modes.gaussian(i, sigma) / (modes.kept(i) * modes.n));
  return table;
}

}  // namespace

Workspace make_workspace(Exec& exec, const Grid& grid, const ShearStressParameters& p) {
  Workspace work;
  const double ratio = static_cast<double>(p.stress_cell) / grid.cell_size;
  work.coarse = wind::coarse_grid_of(grid, coarse_cells(grid.width, ratio), coarse_cells(grid.height, ratio));
  const wind::CoarseGrid& c = work.coarse;
  const auto values = static_cast<std::size_t>(c.values());
  // Interpolation in the outermost cells reads the row beyond the edge. Its stress is not that of the
  // mirrored row, because the wind is not mirrored.
  const bool half_is_enough = c.is_full() && c.rows < c.height;
  const FftMethod by_lines = half_is_enough ? FftMethod::mirrored_rows_first : FftMethod::rows_first;
  work.fft = exec.make_fft(c.width, c.height, 1, method_of_states(c.width, c.height, by_lines));
  for (Buffer<float>* buffer : {&work.ground, &work.lee, &work.filled})
    *buffer = Buffer<float>(exec, static_cast<std::size_t>(grid.cells()));
  work.lines = Buffer<float>(
      exec, words_for_lines(words_handed_on, reach_of_words, std::max(grid.width, grid.height)));
  work.spectrum = Buffer<Complex>(exec, values);
  if (!c.is_full()) {
    work.row_means = Buffer<float>(exec, static_cast<std::size_t>(c.columns) * grid.height);
    work.rise = Buffer<float>(exec, values);
    work.rows = Buffer<Complex>(exec, static_cast<std::size_t>(wind::InterpolateRows::values(c)));
  }
  work.transfer_x = wind::on_device(exec, transfer({c.width, c.ratio_x}));
  work.transfer_y = wind::on_device(exec, transfer({c.height, c.ratio_y}));
  return work;
}

std::size_t Workspace::bytes() const {
  return fft->bytes() + ground.bytes() + lee.bytes() + filled.bytes() + lines.bytes() + row_means.bytes() +
         rise.bytes() + spectrum.bytes() + rows.bytes() + transfer_x.bytes() + transfer_y.bytes();
}

}  // namespace desert_sim::shear_stress
