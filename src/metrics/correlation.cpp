#include "src/metrics/correlation.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "kernels/backend/exec.hpp"
#include "kernels/backend/fft.hpp"
#include "src/core/error.hpp"

namespace desert_sim {

namespace {

std::string grid_text(const Field& f) {
  return std::to_string(f.width) + " x " + std::to_string(f.height) + " cells of " +
         std::to_string(f.cell_size) + " m, " + (f.periodic ? "periodic" : "open");
}

void require_same_grid(const Field& a, const Field& b) {
  if (a.width != b.width || a.height != b.height || a.cell_size != b.cell_size || a.periodic != b.periodic)
    throw ConfigError("correlation: the grids differ: " + grid_text(a) + ", and " + grid_text(b) +
                      " (allowed: the same grid)");
}

/// The deviations from the mean, in the corner of an area of width × height that is 0 elsewhere.
std::vector<Complex> deviations(const Field& f, int width, int height, double& square_sum) {
  double mean = 0;
  for (float v : f.values) mean += static_cast<double>(v) / static_cast<double>(f.values.size());
  std::vector<Complex> values(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), {0, 0});
  square_sum = 0;
  for (int y = 0; y < f.height; ++y)
    for (int x = 0; x < f.width; ++x) {
      const double deviation = static_cast<double>(f.values[f.index(x, y)]) - mean;
      square_sum += deviation * deviation;
      values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)].re =
          static_cast<float>(deviation);
    }
  return values;
}

/// Sums over the rectangle from (0, 0) to before (x, y), at each (x, y).
std::vector<double> rectangle_sums(const std::vector<Complex>& values, int row, int width, int height,
                                   bool of_squares) {
  const auto stride = static_cast<std::size_t>(width) + 1;
  std::vector<double> sums(stride * (static_cast<std::size_t>(height) + 1), 0.0);
  for (int y = 0; y < height; ++y) {
    double line = 0;
    for (int x = 0; x < width; ++x) {
      const double v = static_cast<double>(
          values[static_cast<std::size_t>(y) * static_cast<std::size_t>(row) + static_cast<std::size_t>(x)]
              .re);
      line += of_squares ? v * v : v;
      const std::size_t corner = (static_cast<std::size_t>(y) + 1) * stride + static_cast<std::size_t>(x) + 1;
      sums[corner] = sums[corner - stride] + line;
    }
  }
  return sums;
}

}  // namespace

Correlation::Correlation(const Field& h, const Field& g)
    : width_(h.width), height_(h.height), periodic_(h.periodic) {
  require_same_grid(h, g);
  const int width = h.periodic ? h.width : 2 * h.width, height = h.periodic ? h.height : 2 * h.height;
  double squares_h = 0, squares_g = 0;
  std::vector<Complex> a = deviations(h, width, height, squares_h),
                       b = deviations(g, width, height, squares_g);
  norm_ = std::sqrt(squares_h * squares_g);
  if (!periodic_) {
    sums_h_ = rectangle_sums(a, width, width_, height_, false);
    sums_g_ = rectangle_sums(b, width, width_, height_, false);
    squares_h_ = rectangle_sums(a, width, width_, height_, true);
    squares_g_ = rectangle_sums(b, width, width_, height_, true);
  }
  CpuExec exec(1);
  const auto fft = exec.make_fft(width, height, 1, FftMethod::library);
  fft->forward(a.data());
  fft->forward(b.data());
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Complex p = a[i], q = b[i];
    a[i] = {p.re * q.re + p.im * q.im, p.re * q.im - p.im * q.re};
  }
  fft->inverse(a.data());
  products_ = {width, height, h.cell_size, true, std::vector<float>(a.size())};
  for (std::size_t i = 0; i < a.size(); ++i) products_.values[i] = a[i].re / static_cast<float>(a.size());
}

double Correlation::overlap(const std::vector<double>& sums, int x, int y) const {
  const auto at = [&](int i, int j) {
    return sums[static_cast<std::size_t>(j) * (static_cast<std::size_t>(width_) + 1) +
                static_cast<std::size_t>(i)];
  };
  const int x0 = std::max(0, x), x1 = std::min(width_, width_ + x), y0 = std::max(0, y),
            y1 = std::min(height_, height_ + y);
  return at(x1, y1) - at(x0, y1) - at(x1, y0) + at(x0, y0);
}

double Correlation::at(int x, int y) const {
  const double products = static_cast<double>(products_.at(x, y));
  if (periodic_) return norm_ > 0 ? products / norm_ : 0;
  // The cells x of h and x + d of g lie in rectangles on opposite sides of the grid.
  const double cells = static_cast<double>(width_ - std::abs(x)) * (height_ - std::abs(y));
  const double h = overlap(sums_h_, -x, -y), g = overlap(sums_g_, x, y);
  const double variances =
      (overlap(squares_h_, -x, -y) - h * h / cells) * (overlap(squares_g_, x, y) - g * g / cells);
  // Where nothing but the rounding of the transforms is left, nothing correlates.
  return variances > 1e-12 * norm_ * norm_ ? (products - h * g / cells) / std::sqrt(variances) : 0;
}

double Correlation::sample(double x, double y) const {
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const double fx = x - x0, fy = y - y0;
  return (1 - fy) * ((1 - fx) * at(x0, y0) + fx * at(x0 + 1, y0)) +
         fy * ((1 - fx) * at(x0, y0 + 1) + fx * at(x0 + 1, y0 + 1));
}

std::optional<double> wavelength(const Field& relief, double direction_deg) {
  const Correlation correlation(relief, relief);
  const double c = std::cos(direction_deg * degree), s = std::sin(direction_deg * degree);
  // To half the grid along this direction; beyond, a periodic one repeats itself.
  const double half =
      0.5 * std::min(relief.width / std::max(std::abs(c), 1e-9), relief.height / std::max(std::abs(s), 1e-9));
  const int most = static_cast<int>(half) - 1;
  bool crossed = false;
  double before = correlation.at(0, 0), here = before;
  for (int d = 1; d <= most; ++d) {
    const double next = correlation.sample(d * c, d * s);
    if (crossed && here > 0 && here >= before && here > next)
      return (d - 1 + parabola_top(before, here, next)) * relief.cell_size;
    crossed = crossed || next < 0;
    before = here;
    here = next;
  }
  return std::nullopt;
}

std::optional<Displacement> displacement(const Field& before, const Field& after, double least_correlation) {
  const Correlation correlation(before, after);
  const int most_x = before.width / 4, most_y = before.height / 4;
  double greatest = correlation.at(0, 0);
  for (int j = -most_y; j <= most_y; ++j)
    for (int i = -most_x; i <= most_x; ++i) greatest = std::max(greatest, correlation.at(i, j));
  // A pattern that repeats has several such lags, which differ by rounding only: the shortest counts.
  constexpr double rounding = 1e-5;
  int x = most_x, y = most_y;
  for (int j = -most_y; j <= most_y; ++j)
    for (int i = -most_x; i <= most_x; ++i)
      if (i * i + j * j < x * x + y * y && correlation.at(i, j) >= greatest - rounding) x = i, y = j;
  if (!(greatest >= least_correlation) || std::abs(x) == most_x || std::abs(y) == most_y) return std::nullopt;
  const double dx = parabola_top(correlation.at(x - 1, y), greatest, correlation.at(x + 1, y)),
               dy = parabola_top(correlation.at(x, y - 1), greatest, correlation.at(x, y + 1));
  return Displacement{(x + dx) * before.cell_size, (y + dy) * before.cell_size, greatest};
}

}  // namespace desert_sim
