// Speed-up over hills: crests stay fast, and what the projection leaves is free of divergence.

#include <algorithm>
#include <numeric>

#include "test/kernels/wind/wind_field.hpp"

namespace desert_sim {
namespace {

/// Central differences over two cells, on a torus.
double rms_divergence(const std::vector<double>& u, const std::vector<double>& v, int width, int height) {
  double square = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto at = [&](const std::vector<double>& f, int i, int j) {
        return f[static_cast<std::size_t>((j + height) % height * width + (i + width) % width)];
      };
      const double d = 0.5 * (at(u, x + 1, y) - at(u, x - 1, y) + at(v, x, y + 1) - at(v, x, y - 1));
      square += d * d / (width * height);
    }
  return std::sqrt(square);
}

double deviation(const std::vector<double>& v) {
  double square = 0;
  const double m = std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
  for (double x : v) square += (x - m) * (x - m) / static_cast<double>(v.size());
  return std::sqrt(square);
}

/// Wind over a terrain, and the factor of its speed-up.
struct Blown {
  Grid grid;
  std::vector<double> u, v, factor;

  Blown(test::BenchTerrain& t, const WindParameters& p, wind::Vector above) : grid(t.grid()) {
    t.surface();
    wind::Workspace work = wind::make_workspace(t.exec(), grid, p);
    const auto cells = static_cast<std::size_t>(grid.cells());
    Buffer<float> scratch(t.exec(), 2 * cells);
    with_backend(t.exec(), [&](auto& e) {
      wind::step(e, t.terrain.view(), p, {above, t.heights}, {scratch.data(), scratch.data() + cells}, work);
    });
    t.exec().synchronise();
    const std::vector<float> x = t.terrain.values(Layer::wind_x), y = t.terrain.values(Layer::wind_y),
                             factors = work.rise.download();
    u.assign(x.begin(), x.end());
    v.assign(y.begin(), y.end());
    for (int j = 0; j < grid.height; ++j)
      for (int i = 0; i < grid.width; ++i) {
        const wind::AxisInterpolation along_y = work.coarse.interpolation_y(j);
        wind::CoarseColumn<float> column(factors.data(), work.coarse.interpolation_x(i), work.coarse.width);
        column.move_to(along_y);
        factor.push_back(static_cast<double>(column.at(along_y)));
      }
  }
  std::vector<double> over_factor(std::vector<double> values) const {
    for (std::size_t n = 0; n < values.size(); ++n) values[n] /= factor[n];
    return values;
  }
  double divergence() const { return rms_divergence(u, v, grid.width, grid.height); }
  double divergence_of_flux() const {
    return rms_divergence(over_factor(u), over_factor(v), grid.width, grid.height);
  }
};

WindParameters jackson_hunt() {
  WindParameters p;
  p.speedup_law = SpeedUpLaw::jackson_hunt;
  p.response_lowest = 0.2f;
  p.response_highest = 10;  // far beyond the slopes of these tests
  return p;
}

/// Smooth random numbers: waves of about `length` metres in all directions.
double waves(double x, double y, double length, int size, std::uint32_t seed) {
  double sum = 0;
  for (std::uint32_t n = 0; n < 24; ++n) {
    const double angle = 2 * pi * random_unit(seed, Purpose::terrain_noise, n, 1);
    const double k = size / length * (0.6 + 0.8 * random_unit(seed, Purpose::terrain_noise, n, 2));
    sum +=
        std::sin(2 * pi / size * (std::round(k * std::cos(angle)) * x + std::round(k * std::sin(angle)) * y) +
                 2 * pi * random_unit(seed, Purpose::terrain_noise, n, 3));
  }
  return sum / std::sqrt(12.0);
}

/// 0.84 of the divergence of the unprojected wind was left over dunes and 0.30 over hills, with venturi, and
/// of the standard deviation of its speed over dunes 0.18.
TEST_P(WindField, RemovesDivergenceAndKeepsCrestsFast) {
  for (const bool dunes : {true, false})
    for (const int n : {256, 384}) {
      SCOPED_TRACE(std::string(dunes ? "dunes" : "hills") + " on " + std::to_string(n));
      test::BenchTerrain t(exec(), n, n);
      t.set(Layer::bedrock, [&](int x, int y) {
        const double bend = 1.5 * waves(x, y, 120, n, 3);
        return dunes ? 1.2 * (1 + std::sin(2 * pi * x / 32 + bend))
                     : 20 + 2 * waves(x, y, 50, n, 5) + 5 * waves(x, y, 150, n, 6) +
                           0.1 * random_unit(7, Purpose::terrain_noise, static_cast<std::uint32_t>(x),
                                             static_cast<std::uint32_t>(y));
      });
      const wind::Vector above{3, 0};
      // unprojected it is, but for warping, `above` times the factor
      const Blown wind(t, {}, above);
      std::vector<double> before = wind.factor;
      for (double& u : before) u *= 3;
      const std::vector<double> still(before.size(), 0.0);
      EXPECT_LE(wind.divergence_of_flux(), 0.05 * rms_divergence(before, still, n, n));
      const auto sum = [](const std::vector<double>& f) { return std::accumulate(f.begin(), f.end(), 0.0); };
      EXPECT_NEAR(sum(wind.u) / sum(before), 1, 0.01);
      if (dunes) {
        EXPECT_GE(deviation(wind.u), 0.9 * deviation(before));
      }

      WindParameters venturi, unprojected;
      venturi.speedup_law = unprojected.speedup_law = SpeedUpLaw::venturi;
      unprojected.projection = false;
      const Blown after(t, venturi, above), without(t, unprojected, above);
      EXPECT_LE(after.divergence(), 0.05 * without.divergence());
      EXPECT_NEAR(sum(after.u) / sum(without.u), 1, 0.001);
    }
}

/// Faster by 2 H/L at the crest of a ridge, by 1.6 H/L at that of a round hill, after the
/// projection; L is the half length at half the height. It was less than 0.02 H/L at ridges.
TEST_P(WindField, CrestsAreAsFastAsJacksonAndHuntSay) {
  for (const int n : {256, 512})
    for (const double width : {10.0, 20.0, 40.0})
      for (const double slope : {0.05, 0.15, 0.3}) {
        if (width * 10 > n) continue;  // its images are too near
        const double height = slope * width * std::exp(0.5),
                     half_length = width * std::sqrt(2 * std::log(2.0));
        SCOPED_TRACE(std::to_string(n) + " cells, width " + std::to_string(width) + ", slope " +
                     std::to_string(slope));
        const double law = height / half_length;
        const int c = n / 2;
        test::BenchTerrain t(exec(), n, n);
        const auto gauss = [&](double r2) { return height * std::exp(-0.5 * r2 / (width * width)); };
        t.set(Layer::bedrock, [&](int x, int) { return gauss((x - c) * (x - c)); });
        t.blow(jackson_hunt(), {5, 0});
        EXPECT_NEAR(t.at(Layer::wind_x, c, c) / 5 - 1, 2 * law, 0.12 * 2 * law);
        t.blow(jackson_hunt(), {3, 4});  // only the component across the ridge is faster
        EXPECT_NEAR(t.at(Layer::wind_x, c, c) / 3 - 1, 2 * law, 0.12 * 2 * law + 0.05);
        EXPECT_NEAR(t.at(Layer::wind_y, c, c) / 4, 1, width < 15 ? 0.15 : 0.05);
        t.set(Layer::bedrock, [&](int x, int y) { return gauss((x - c) * (x - c) + (y - c) * (y - c)); });
        t.blow(jackson_hunt(), {4, 3});
        EXPECT_NEAR(std::hypot(t.at(Layer::wind_x, c, c), t.at(Layer::wind_y, c, c)) / 5 - 1, 1.6 * law,
                    (0.1 + 0.5 * slope) * 1.6 * law);
      }
}

/// At default settings: 2 H/L over gentle ridges, and never more than the bound over steep ones.
TEST_P(WindField, CrestsAreAsFastAsJacksonAndHuntSayByDefault) {
  constexpr int n = 256, c = n / 2;
  test::BenchTerrain t(exec(), n, n);
  for (const double law : {0.01, 0.02, 0.04, 0.4}) {
    const double width = 20, height = law * width * std::sqrt(2 * std::log(2.0));
    t.set(Layer::bedrock,
          [&](int x, int) { return height * std::exp(-0.5 * (x - c) * (x - c) / (width * width)); });
    t.blow({}, {5, 0});
    const double faster = t.at(Layer::wind_x, c, c) / 5 - 1;
    if (law < 0.1)
      EXPECT_NEAR(faster, 2 * law, 0.12 * 2 * law) << law;
    else
      EXPECT_TRUE(faster > 0.2 && faster < 0.25) << faster;
  }
}

/// Slopes far beyond the law: the factor stays within its bounds.
TEST_P(WindField, SpeedUpOverCliffsIsBounded) {
  test::BenchTerrain t(exec(), 128, 128);
  t.set(Layer::bedrock, [](int x, int y) { return (x / 32 + y / 32) % 2 ? 60.0 : 0.0; });
  WindParameters p;
  p.response_lowest = 0.8f;
  const Blown blown(t, p, {5, 0});
  const auto [least, most] = std::minmax_element(blown.factor.begin(), blown.factor.end());
  EXPECT_GE(*least, 0.8);
  EXPECT_NEAR(*least, 0.8, 0.01);
  EXPECT_LE(*most, p.response_highest);
  EXPECT_NEAR(*most, p.response_highest, 0.01);
}

}  // namespace
}  // namespace desert_sim
