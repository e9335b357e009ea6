#pragma once
/// Statistics of patterns of dunes that two programs made, over ten seeds each.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <utility>
#include <vector>

#include "src/core/constants.hpp"

namespace desert_sim::test {

constexpr int seeds = 10;

/// Of the heights of a periodic square, in slabs.
struct Pattern {
  double highest, roughness, bare, slope;  ///< standard deviation; share of cells; rms between neighbours
  double long_waves;                       ///< share of the variance along x in waves of more than 16 cells
  double dunes;                            ///< patches higher than the mean, of four cells at least
};

/// Share of the variance along x in the waves 1 … `highest` of each row.
inline double share_of_waves(const std::vector<double>& heights, std::size_t side, std::size_t highest) {
  double shared = 0, all = 0;
  for (std::size_t row = 0; row < heights.size(); row += side) {
    double sum = 0, squares = 0;
    for (std::size_t x = 0; x < side; ++x) {
      sum += heights[row + x];
      squares += heights[row + x] * heights[row + x];
    }
    const double n = static_cast<double>(side);
    all += squares / n - sum * sum / (n * n);
    for (std::size_t k = 1; k <= highest; ++k) {
      std::complex<double> wave = 0;
      for (std::size_t x = 0; x < side; ++x)
        wave += heights[row + x] * std::polar(1.0, 2 * pi * static_cast<double>(k * x) / n);
      shared += 2 * std::norm(wave) / (n * n);
    }
  }
  return shared / all;
}

/// Patches of cells higher than `level`, joined over their sides, that have at least four cells.
inline int patches_above(const std::vector<double>& heights, std::size_t side, double level) {
  std::vector<bool> seen(heights.size());
  int patches = 0;
  for (std::size_t start = 0; start < heights.size(); ++start) {
    std::vector<std::size_t> patch;
    const auto visit = [&](std::size_t i) {
      if (seen[i] || heights[i] <= level) return;
      seen[i] = true;
      patch.push_back(i);
    };
    visit(start);
    for (std::size_t n = 0; n < patch.size(); ++n) {
      const std::size_t i = patch[n], x = i % side;
      visit(i - x + (x + 1) % side);
      visit(i - x + (x + side - 1) % side);
      visit((i + side) % heights.size());
      visit((i + heights.size() - side) % heights.size());
    }
    patches += patch.size() >= 4;
  }
  return patches;
}

inline Pattern pattern_of(const std::vector<double>& slabs) {
  const auto side = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(slabs.size()))));
  const double n = static_cast<double>(slabs.size());
  double sum = 0, squares = 0, bare = 0, slopes = 0;
  for (std::size_t i = 0; i < slabs.size(); ++i) {
    const std::size_t x = i % side, east = i - x + (x + 1) % side;
    sum += slabs[i];
    squares += slabs[i] * slabs[i];
    bare += slabs[i] < 0.5;
    slopes += (slabs[east] - slabs[i]) * (slabs[east] - slabs[i]);
  }
  return {*std::max_element(slabs.begin(), slabs.end()),
          std::sqrt(squares / n - sum * sum / (n * n)),
          bare / n,
          std::sqrt(slopes / n),
          share_of_waves(slabs, side, side / 16),
          static_cast<double>(patches_above(slabs, side, sum / n))};
}

/// Welch's t of two samples.
inline double welch(const std::vector<double>& a, const std::vector<double>& b) {
  const auto moments = [](const std::vector<double>& v) {
    double mean = 0, variance = 0;
    for (double x : v) mean += x / static_cast<double>(v.size());
    for (double x : v) variance += (x - mean) * (x - mean) / static_cast<double>(v.size() - 1);
    return std::pair(mean, variance / static_cast<double>(v.size()));
  };
  const auto [mean_a, of_mean_a] = moments(a);
  const auto [mean_b, of_mean_b] = moments(b);
  return (mean_a - mean_b) / std::sqrt(of_mean_a + of_mean_b + 1e-12);
}

/// |t| over 3.6 comes by chance in 2 of 1000 (18 degrees of freedom): with six statistics and three tests,
/// one of them fails by chance with 3.5 %. The seeds are fixed.
inline void expect_alike(const std::vector<Pattern>& a, const std::vector<Pattern>& b) {
  const std::pair<const char*, double Pattern::*> statistics[] = {
      {"highest stack", &Pattern::highest}, {"roughness", &Pattern::roughness},   {"bare", &Pattern::bare},
      {"slope", &Pattern::slope},           {"long waves", &Pattern::long_waves}, {"dunes", &Pattern::dunes}};
  for (const auto& [name, member] : statistics) {
    std::vector<double> of_a, of_b;
    for (const Pattern& p : a) of_a.push_back(p.*member);
    for (const Pattern& p : b) of_b.push_back(p.*member);
    double mean_a = 0, mean_b = 0;
    for (double v : of_a) mean_a += v / seeds;
    for (double v : of_b) mean_b += v / seeds;
    EXPECT_LT(std::abs(welch(of_a, of_b)), 3.6) << name << ": " << mean_a << " in parallel, " << mean_b;
    ::testing::Test::RecordProperty(name, std::to_string(mean_a) + " " + std::to_string(mean_b));
  }
}

}  // namespace desert_sim::test
