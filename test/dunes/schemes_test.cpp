// The quick avalanche (multilevel, closed tiles) makes the same dunes as the reference (synchronous sweeps until
// nothing moves), within the scatter between seeds, and leaves no trace of its tiles.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "dunes/running.hpp"

namespace desert_sim {
namespace {

Scenario transverse(int size, std::uint64_t seed, AvalancheScheme scheme, AvalancheQuality quality) {
  Scenario s;
  s.name = "test";
  s.seed = seed;
  s.grid.width = s.grid.height = size;
  s.grid.cell_size = 1;
  NoiseStep sand;
  sand.low = 1.5;
  sand.high = 3;
  s.terrain = {sand};
  s.wind_regime.speed = 3;
  s.reptation.strength = 0.1f;
  s.avalanching.scheme = scheme;
  s.avalanching.quality = quality;
  if (scheme == AvalancheScheme::sweeps) s.avalanching.sweeps = 10;
  return s;
}

struct Statistics {
  double height, wavelength, crest;
  std::vector<double> histogram;
};

Statistics measure(const Field& elevation) {
  return {roughness(elevation), wavelength(elevation, 0), crest_orientation(elevation, 2).crest_deg,
          slope_histogram(elevation, 6)};
}

double mean(const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size()); }

double deviation(const std::vector<double>& v) {
  double sum = 0;
  for (double x : v) sum += (x - mean(v)) * (x - mean(v));
  return std::sqrt(sum / static_cast<double>(v.size() - 1));
}

/// The means differ by no more than twice the scatter between seeds.
void expect_same(const char* what, const std::vector<double>& quick, const std::vector<double>& reference) {
  const double scatter = std::hypot(deviation(quick), deviation(reference));
  DESERT_REPORT("%s: %.3f, reference %.3f, scatter %.3f", what, mean(quick), mean(reference), scatter);
  EXPECT_LE(std::abs(mean(quick) - mean(reference)), 2 * scatter) << what;
}

void compare(AvalancheQuality quality) {
  constexpr int seeds = 4, size = 128, steps = 200;
  std::vector<Statistics> runs[2];
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    Running quick(transverse(size, seed, AvalancheScheme::multilevel, quality));
    Running reference(transverse(size, seed, AvalancheScheme::sweeps, AvalancheQuality::converged));
    runs[0].push_back(measure(quick.run(steps).field(Layer::elevation)));
    runs[1].push_back(measure(reference.run(steps).field(Layer::elevation)));
  }
  const auto each = [&](int which, auto&& value) {
    std::vector<double> values;
    for (const Statistics& s : runs[which]) values.push_back(value(s));
    return values;
  };
  const auto same = [&](const char* what, auto&& value) { expect_same(what, each(0, value), each(1, value)); };
  same("roughness [m]", [](const Statistics& s) { return s.height; });
  same("wavelength [m]", [](const Statistics& s) { return s.wavelength; });
  same("crest orientation [deg]", [](const Statistics& s) { return s.crest; });
  for (std::size_t bin = 0; bin < 6; ++bin)
    same(("share of slopes from " + std::to_string(6 * bin) + " degrees").c_str(),
         [bin](const Statistics& s) { return s.histogram[bin]; });
}

TEST(Schemes, GoodMakesTheSameDunes) { compare(AvalancheQuality::good); }
TEST(Schemes, FastMakesTheSameDunes) { compare(AvalancheQuality::fast); }

TEST(Schemes, TilesLeaveNoImprint) {
  for (AvalancheQuality quality : {AvalancheQuality::fast, AvalancheQuality::good}) {
    std::vector<Field> fields;
    for (std::uint64_t seed = 1; seed <= 3; ++seed)
      fields.push_back(Running(transverse(256, seed, AvalancheScheme::multilevel, quality)).run(200).field(Layer::elevation));
    const double strength = imprint(fields, 32);
    DESERT_REPORT("power at the tiles' period over that beside it: %.2f", strength);
    EXPECT_LT(strength, 2);
  }
}

}  // namespace
}  // namespace desert_sim
