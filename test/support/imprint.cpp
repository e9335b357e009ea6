#include "test/support/imprint.hpp"

#include <algorithm>
#include <cmath>

namespace desert_sim {

namespace {

/// Power of mode k of the rows (or columns), summed over all of them.
double line_power(const Field& f, bool along_x, int k) {
  const int n = along_x ? f.width : f.height, lines = along_x ? f.height : f.width;
  std::vector<double> cosine(static_cast<std::size_t>(n)), sine(cosine);
  for (int i = 0; i < n; ++i) {
    cosine[static_cast<std::size_t>(i)] = std::cos(2 * (180 * degree) * k * i / n);
    sine[static_cast<std::size_t>(i)] = std::sin(2 * (180 * degree) * k * i / n);
  }
  double power = 0;
  for (int line = 0; line < lines; ++line) {
    double re = 0, im = 0;
    for (int i = 0; i < n; ++i) {
      const double v = along_x ? f.values[f.index(i, line)] : f.values[f.index(line, i)];
      re += v * cosine[static_cast<std::size_t>(i)];
      im += v * sine[static_cast<std::size_t>(i)];
    }
    power += re * re + im * im;
  }
  return power;
}

}  // namespace

double mode_excess(const std::vector<Field>& fields, bool along_x, int mode) {
  const auto power = [&](int k) {
    double sum = 1e-30;
    for (const Field& f : fields) sum += line_power(f, along_x, k);
    return sum;
  };
  // The geometric mean follows a spectrum that falls steeply.
  double beside = 0;
  for (int d : {-2, -1, 1, 2}) beside += 0.25 * std::log(power(mode + d));
  return power(mode) / std::exp(beside);
}

namespace {

constexpr int harmonics = 3;

/// The greatest excess of the modes up to the third harmonic of `period` that are multiples of it, or that
/// are not.
double greatest_excess(const std::vector<Field>& fields, int period, bool multiples) {
  double greatest = 0;
  for (bool along_x : {true, false}) {
    const int n = along_x ? fields[0].width : fields[0].height;
    for (int k = 3; k * period <= harmonics * n && k + 2 < n / 2; ++k)
      if ((k * period % n == 0) == multiples) greatest = std::max(greatest, mode_excess(fields, along_x, k));
  }
  return greatest;
}

}  // namespace

double imprint(const std::vector<Field>& fields, int period) { return greatest_excess(fields, period, true); }

double imprint_by_chance(const std::vector<Field>& fields, int period) {
  return greatest_excess(fields, period, false);
}

}  // namespace desert_sim
