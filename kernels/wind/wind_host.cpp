#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/wind/coarse_modes.hpp"
#include "kernels/wind/wind_laws.hpp"
#include "src/core/elementary.hpp"

namespace desert_sim::wind {

namespace {
/// Least length of a coarse axis: shorter ones would save no time, and show in the result.
constexpr int min_coarse_cells = 64;

/// The width of a coarse cell that is chosen by default [m]: a quarter of the smallest σ of the radii.
float default_coarse_cell(const WindParameters& p) {
  float smallest = 1e9f;
  for (int r = 0; r < p.radii.count; ++r) smallest = std::min(smallest, p.radii.values[r]);
  return 0.5f * smallest / 4.0f;
}

/// The next number whose only prime factors are 2, 3 and 5: transforms of such lengths are fast.
int smooth_length(int n) {
  while (!has_small_factors(n)) ++n;
  return n;
}

/// The transfer functions of the wind along an axis.
struct WindModes : ModesOfAxis {
  /// Of a Gaussian of `sigma` fine cells, with the derivative's 1/l and the normalisation 1/n.
  std::vector<Transfer> transfer(double sigma, double cell_size) const {
    std::vector<Transfer> table(static_cast<std::size_t>(n), Transfer{0, 0});
    for (int i = 0; i < n; ++i) {
      if (nyquist(i)) continue;
      const double smooth = gaussian(i, sigma) / (kept(i) * n);
      table[static_cast<std::size_t>(i)] = {
          static_cast<float>(smooth),
          static_cast<float>(smooth * elementary::sin(wavenumber(i)) / cell_size)};
    }
    return table;
  }
  /// The terrain's with the normalisation 1/n, and a σ of at least `least_sigma` cells, so that small
  /// terrains, which are not coarsened as much, have the same speed-up. At full resolution the flux is not
  /// smoothed: there it is not interpolated.
  std::vector<FlowTransfer> flow_transfer(double least_sigma) const {
    std::vector<FlowTransfer> table(static_cast<std::size_t>(n), FlowTransfer{0, 0});
    const double of_terrain = std::max({1.0, 0.5 * ratio, least_sigma}),
                 of_flux = std::sqrt(ratio * ratio - 1);
    for (int i = 0; i < n; ++i)
      if (!nyquist(i))
        table[static_cast<std::size_t>(i)] = {static_cast<float>(gaussian(i, of_terrain) / (kept(i) * n)),
                                              static_cast<float>(gaussian(i, of_flux))};
    return table;
  }
};

}  // namespace

CoarseGrid coarse_grid(const Grid& fine, const WindParameters& p) {
  float ratio = static_cast<float>(p.coarsening);
  if (p.coarsening == 0) ratio = std::max(1.0f, std::floor(default_coarse_cell(p) / fine.cell_size));
  const auto cells = [&](int n) {
    const int coarse = std::max(1, static_cast<int>(std::lround(n / ratio)));
    if (p.coarsening != 0) return coarse;
    return std::min(n, smooth_length(std::max(coarse, min_coarse_cells)));
  };
  return coarse_grid_of(fine, cells(fine.width), cells(fine.height));
}

Workspace make_workspace(Exec& exec, const Grid& fine, const WindParameters& p) {
  Workspace work;
  work.coarse = coarse_grid(fine, p);
  if (!has_coarse_fields(p)) return work;
  const CoarseGrid& c = work.coarse;
  const auto values = static_cast<std::size_t>(c.values());
  work.row_means = Buffer<float>(exec, static_cast<std::size_t>(c.columns) * fine.height);
  const int fields = response_fields(p), radius_count = p.warping ? p.radii.count : 0;
  work.rise = Buffer<float>(exec, values);
  for (Buffer<Complex>* buffer : {&work.spectrum, &work.warped}) *buffer = Buffer<Complex>(exec, values);
  work.responses = Buffer<Complex>(exec, values * static_cast<std::size_t>(std::max(1, fields)));
  work.mean_sums = Buffer<long long>(exec, 3);
  const WindModes along_x{{c.width, c.ratio_x}}, along_y{{c.height, c.ratio_y}};
  const double least_sigma = p.radii.count > 0 ? 0.5 * default_coarse_cell(p) / fine.cell_size : 0;
  work.flow_x = on_device(exec, along_x.flow_transfer(least_sigma));
  work.flow_y = on_device(exec, along_y.flow_transfer(least_sigma));
  constexpr int longest_in_one_kernel = 512;  // longer ones are faster in kernels of their own
  work.in_one_kernel = std::max(c.width, c.height) <= longest_in_one_kernel && has_small_factors(c.width) &&
                       has_small_factors(c.height) && bytes_for_lines(c, fields) <= exec.memory_for_lines();
  const FftMethod method = method_of_states(c.width, c.height, FftMethod::columns_first);
  if (work.in_one_kernel) {
    work.lines_along_x = LineTransform::for_length(c.width);
    work.lines_along_y = LineTransform::for_length(c.height);
    work.roots_x = on_device(exec, work.lines_along_x.roots());
    work.roots_y = on_device(exec, work.lines_along_y.roots());
  } else {
    work.fft_one_field = exec.make_fft(c.width, c.height, 1, method);
  }
  if (fields == 0) return work;
  if (!work.in_one_kernel) work.fft_all_responses = exec.make_fft(c.width, c.height, fields, method);
  for (int r = 0; r < radius_count; ++r) {
    const double sigma = 0.5 * p.radii.values[r] / fine.cell_size;
    work.along_x[r] = on_device(exec, along_x.transfer(sigma, fine.cell_size));
    work.along_y[r] = on_device(exec, along_y.transfer(sigma, fine.cell_size));
  }
  return work;
}

std::size_t Workspace::bytes() const {
  std::size_t total = row_means.bytes() + rise.bytes() + spectrum.bytes() + warped.bytes() +
                      responses.bytes() + mean_sums.bytes() + flow_x.bytes() + flow_y.bytes() +
                      roots_x.bytes() + roots_y.bytes();
  for (const std::unique_ptr<Fft>* transform : {&fft_one_field, &fft_all_responses})
    total += *transform ? (*transform)->bytes() : 0;
  for (int r = 0; r < ShortList::capacity; ++r) total += along_x[r].bytes() + along_y[r].bytes();
  return total;
}

}  // namespace desert_sim::wind
