#include "src/metrics/field.hpp"

#include <algorithm>
#include <cmath>

namespace desert_sim {

double direction_of(double x, double y) { return std::atan2(y, x) / degree; }

std::size_t Field::nearest(int x, int y) const {
  return periodic ? index(wrapped(x, width), wrapped(y, height))
                  : index(std::clamp(x, 0, width - 1), std::clamp(y, 0, height - 1));
}

double Field::sample(double x, double y) const {
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const double fx = x - x0, fy = y - y0;
  return (1 - fy) * ((1 - fx) * at(x0, y0) + fx * at(x0 + 1, y0)) +
         fy * ((1 - fx) * at(x0, y0 + 1) + fx * at(x0 + 1, y0 + 1));
}

double angle_between_deg(double a, double b) { return std::abs(std::remainder(a - b, 360.0)); }

double line_angle_between_deg(double a, double b) { return std::abs(std::remainder(a - b, 180.0)); }

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto n = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(n), values.end());
  return values[n];
}

double parabola_top(double before, double middle, double after) {
  const double bend = before - 2 * middle + after;
  return bend < 0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0;
}

Field smoothed(const Field& f, double sigma) {
  const double cells = sigma / f.cell_size;
  if (cells < 0.1) return f;
  const int reach = static_cast<int>(std::ceil(3 * cells));
  std::vector<double> kernel;
  double sum = 0;
  for (int d = -reach; d <= reach; ++d) {
    kernel.push_back(std::exp(-0.5 * d * d / (cells * cells)));
    sum += kernel.back();
  }
  Field rows = f, out = f;
  for (int pass = 0; pass < 2; ++pass) {
    const Field& from = pass == 0 ? f : rows;
    Field& to = pass == 0 ? rows : out;
    for (int y = 0; y < f.height; ++y)
      for (int x = 0; x < f.width; ++x) {
        double mean = 0;
        for (int d = -reach; d <= reach; ++d)
          mean += kernel[static_cast<std::size_t>(d + reach)] *
                  (pass == 0 ? from.at(x + d, y) : from.at(x, y + d));
        to.values[f.index(x, y)] = static_cast<float>(mean / sum);
      }
  }
  return out;
}

double roughness(const Field& f) {
  double mean = 0, square = 0;
  for (float v : f.values) mean += v / static_cast<double>(f.values.size());
  for (float v : f.values) square += (v - mean) * (v - mean) / static_cast<double>(f.values.size());
  return std::sqrt(square);
}

Slopes slopes(const Field& f) {
  Slopes s;
  s.slope_deg.resize(f.values.size());
  s.direction_deg.resize(f.values.size());
  for (int y = 0; y < f.height; ++y)
    for (int x = 0; x < f.width; ++x) {
      const double gx = (f.at(x + 1, y) - f.at(x - 1, y)) / (2 * f.cell_size);
      const double gy = (f.at(x, y + 1) - f.at(x, y - 1)) / (2 * f.cell_size);
      s.slope_deg[f.index(x, y)] = static_cast<float>(std::atan(std::hypot(gx, gy)) / degree);
      s.direction_deg[f.index(x, y)] = static_cast<float>(direction_of(-gx, -gy));
    }
  return s;
}

std::vector<double> slope_histogram(const Field& f, double bin_deg) {
  std::vector<double> shares(static_cast<std::size_t>(std::ceil(90.0 / bin_deg)), 0.0);
  for (float slope : slopes(f).slope_deg)
    shares[std::min(static_cast<std::size_t>(slope / bin_deg), shares.size() - 1)] += 1.0;
  for (double& share : shares) share /= static_cast<double>(f.values.size());
  return shares;
}

}  // namespace desert_sim
