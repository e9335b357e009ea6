// Ripples and bumps on the surface between cells: sizes against the formula, orientation, motion, continuity,
// windows that agree to the bit, and where there are none.

#include "src/simulation/views/micro_relief.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>

#include "src/simulation/checkpoint.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

constexpr double pi = 3.14159265358979;

/// Flat sand under a wind, 32 m × 24 m.
std::string flat_sand(double speed, double direction_deg, const std::string& boundary = "periodic") {
  return "grid: {width: 32, height: 24, cell_size: 1, boundary: " + boundary +
         "}\nterrain: [{uniform: {layer: sand, value: 1}}]\nwind: {speed: " + std::to_string(speed) +
         ", direction_deg: " + std::to_string(direction_deg) + "}\n";
}

class MicroReliefOfSurface : public test::OnBackend {
 protected:
  Snapshot snapshot(Simulation& s) { return *s.views().snapshot(MicroRelief::layers()); }
  Snapshot flat(double speed, double direction_deg = 0) {
    return snapshot(*simulation(flat_sand(speed, direction_deg)));
  }
};

/// The formula, once more.
double wavelength(double speed) { return std::min(0.013 + 0.02 * (speed - 1), 0.3); }
double height(double speed) { return 0.0467 * wavelength(speed); }

/// Wave number [1/m] of rows of heights `spacing` apart, by the centre of the peak of their power spectra.
double wave_number(const std::vector<float>& z, const MicroReliefWindow& w) {
  const auto columns = static_cast<std::size_t>(w.columns);
  const double length = w.columns * w.resolution;
  std::vector<double> power(columns / 4, 0.0);
  for (std::size_t row = 0; row < static_cast<std::size_t>(w.rows); ++row)
    for (std::size_t k = 1; k < power.size(); ++k) {
      std::complex<double> sum;
      for (std::size_t i = 0; i < columns; ++i)
        sum += std::polar(1 - std::cos(2 * pi * (static_cast<double>(i) + 0.5) / w.columns),
                          -2 * pi * static_cast<double>(i * k) / w.columns) *
               (static_cast<double>(z[row * columns + i]) - 1);
      power[k] += std::norm(sum);
    }
  const auto peak = static_cast<std::size_t>(std::max_element(power.begin(), power.end()) - power.begin());
  double sum = 0, weight = 0;
  for (std::size_t k = peak - peak / 4; k <= peak + peak / 4; ++k) {
    sum += power[k] * static_cast<double>(k);
    weight += power[k];
  }
  return sum / weight / length;
}

std::vector<float> heights(const Snapshot& s, const MicroReliefWindow& w) {
  return MicroRelief(s).elevations(w);
}

double largest_offset(const Snapshot& s) {
  double largest = 0;
  for (float z : heights(s, {4, 4, 300, 300, 0.02})) largest = std::max(largest, std::abs(z - 1.0));
  return largest;
}

TEST_P(MicroReliefOfSurface, WavelengthAndHeightAreThoseOfTheWindSpeed) {
  for (const double speed : {3.0, 8.0, 12.0, 25.0}) {
    const double expected = wavelength(speed);
    const Snapshot s = flat(speed);
    double mean = 0, low = 1, high = 1;
    for (int n = 0; n < 20; ++n) {  // far enough from each other to have patches of their own
      const MicroReliefWindow line{1, 1 + 1.1 * n, static_cast<int>(30 * 16 / expected / 5), 1,
                                   expected / 16};
      const std::vector<float> z = heights(s, line);
      mean += wave_number(z, line) / 20;
      low = std::min(low, static_cast<double>(*std::min_element(z.begin(), z.end())));
      high = std::max(high, static_cast<double>(*std::max_element(z.begin(), z.end())));
    }
    EXPECT_NEAR(mean * expected, 1, 0.03) << speed << " m/s";
    EXPECT_NEAR((high - low) / height(speed), 1, 0.03) << speed << " m/s";
    EXPECT_GE(expected, 0.013);
    EXPECT_LE(expected, 0.3);
  }
}

TEST_P(MicroReliefOfSurface, CrestsLieAcrossTheWind) {
  for (const double direction : {0.0, 30.0, 75.0, 140.0, 205.0, 290.0}) {
    const MicroReliefWindow w{4, 4, 400, 400, 0.02};
    const std::vector<float> z = heights(flat(8, direction), w);
    double xx = 0, xy = 0, yy = 0;
    for (std::size_t y = 0; y + 1 < 400; ++y)
      for (std::size_t x = 0; x + 1 < 400; ++x) {
        const double gx = z[y * 400 + x + 1] - z[y * 400 + x], gy = z[(y + 1) * 400 + x] - z[y * 400 + x];
        xx += gx * gx, xy += gx * gy, yy += gy * gy;
      }
    const double across = 0.5 * std::atan2(2 * xy, xx - yy) * 180 / pi;
    EXPECT_NEAR(std::remainder(across - direction, 180), 0, 2.5) << direction;
    EXPECT_GT(std::hypot(2 * xy, xx - yy) / (xx + yy), 0.6) << direction;
  }
}

/// Steepest descent over steepest rise downwind, of a west wind.
double steepness_ratio(const Snapshot& s) {
  const MicroReliefWindow w{4, 4, 4000, 12, 0.002};
  const std::vector<float> z = heights(s, w);
  std::vector<float> slopes;
  for (std::size_t i = 0; i + 1 < z.size(); ++i)
    if ((i + 1) % 4000 != 0) slopes.push_back(z[i + 1] - z[i]);
  std::sort(slopes.begin(), slopes.end());
  return -static_cast<double>(slopes[slopes.size() / 50]) / slopes[slopes.size() - 1 - slopes.size() / 50];
}

TEST_P(MicroReliefOfSurface, LeeSidesAreSteeperInAWindOfOneDirectionOnly) {
  Snapshot s = flat(8);
  EXPECT_GT(steepness_ratio(s), 1.5);
  s.micro_relief.wind.x = 0.3 * s.micro_relief.wind.speed;  // winds to and fro
  const double mixed = steepness_ratio(s);
  EXPECT_LT(mixed, 1.35);
  s.micro_relief.parameters.asymmetry = 0;
  EXPECT_NEAR(steepness_ratio(s), 1, 0.05);
}

TEST_P(MicroReliefOfSurface, RipplesMoveDownwindAtTheirCelerity) {
  const double speed = 8, time = 60, way = 1e-4 * (speed - 1) * time;
  Snapshot s = flat(speed);
  const MicroReliefWindow w{4, 4, 4000, 12, 0.001};
  const std::vector<float> before = heights(s, w);
  for (int n = 0; n < 60; ++n)
    s.micro_relief.wind.advance({static_cast<float>(speed), 0}, time / 60, s.micro_relief.parameters);
  const std::vector<float> after = heights(s, w);
  double best = 0;
  int shift = 0;
  for (int by = -70; by <= 70; ++by) {
    double sum = 0;
    for (int row = 0; row < w.rows; ++row)
      for (int i = 100; i < w.columns - 100; ++i)
        sum += (before[static_cast<std::size_t>(row * w.columns + i)] - 1) *
               (after[static_cast<std::size_t>(row * w.columns + i + by)] - 1);
    if (sum > best) best = sum, shift = by;
  }
  EXPECT_NEAR(shift * w.resolution, way, 0.002);
  EXPECT_NEAR(way, 0.042, 1e-9);
}

/// Largest change of a height from step to step while the wind jumps by 90°, then reverses, then dies down.
double largest_change(Snapshot s, double dt) {
  const MicroReliefWindow w{4, 4, 24, 24, 0.04};
  std::vector<float> before = heights(s, w);
  double largest = 0;
  const auto blow = [&](wind::Vector wind, double time) {
    for (int n = 0; n < static_cast<int>(time / dt); ++n) {
      s.micro_relief.wind.advance(wind, dt, s.micro_relief.parameters);
      const std::vector<float> now = heights(s, w);
      for (std::size_t i = 0; i < now.size(); ++i)
        largest = std::max(largest, std::abs(static_cast<double>(now[i]) - before[i]));
      before = now;
    }
  };
  blow({0, 8}, 1200);
  blow({0, -10}, 1200);
  blow({0, 0}, 1200);
  return largest;
}

TEST_P(MicroReliefOfSurface, HeightsAreContinuousInTimeHoweverTheWindJumps) {
  const double coarse = largest_change(flat(8), 8), fine = largest_change(flat(8), 4);
  EXPECT_LT(fine, 0.35 * height(8));
  EXPECT_GT(fine, 0.01 * height(8));
  EXPECT_NEAR(fine / coarse, 0.5, 0.12);
}

TEST_P(MicroReliefOfSurface, WindowsAgreeToTheBit) {
  const std::unique_ptr<Simulation> world =
      simulation(flat_sand(8, 20) + "micro_relief: {crest_length: 0.7}\n");
  test::run(*world, 3);
  const Snapshot whole = snapshot(*world);
  const MicroReliefWindow large{3, 5, 240, 200, 0.05};
  const std::vector<float> all = heights(whole, large);
  const auto at = [&](int column, int row) {
    return all[static_cast<std::size_t>(row * large.columns + column)];
  };
  const MicroReliefWindow part{5, 8, 40, 60, 0.05}, coarse{3.05, 5.05, 70, 60, 0.15};
  const std::vector<float> inner = heights(*world->views().snapshot(MicroRelief::layers(),
                                                                    MicroRelief::band(part, whole)),
                                           part),
                           sparse = heights(whole, coarse);
  for (int row = 0; row < part.rows; ++row)
    for (int column = 0; column < part.columns; ++column)
      ASSERT_EQ(inner[static_cast<std::size_t>(row * part.columns + column)], at(column + 40, row + 60));
  for (int row = 0; row < 60; ++row)
    for (int column = 0; column < 70; ++column)
      ASSERT_EQ(sparse[static_cast<std::size_t>(row * 70 + column)], at(3 * column + 2, 3 * row + 2));
}

TEST_P(MicroReliefOfSurface, PeriodicTerrainRepeatsAndWindowsGoOverItsEdges) {
  const Snapshot s = flat(8, 20);
  const MicroReliefWindow here{2, 3, 60, 60, 0.05}, around{2 - 32, 3 + 24, 60, 60, 0.05},
      edge{30, 22, 80, 80, 0.05}, over{-2, -2, 80, 80, 0.05};
  EXPECT_EQ(heights(s, here), heights(s, around));
  EXPECT_EQ(heights(s, edge), heights(s, over));
  const MicroRelief micro_relief(s);
  const std::vector<float> z = micro_relief.elevations(edge);
  for (int n = 0; n < 80; ++n)
    EXPECT_EQ(static_cast<float>(1 + micro_relief.offset(30 + (n + 0.5) * 0.05, 22.025)),
              z[static_cast<std::size_t>(n)]);
}

TEST_P(MicroReliefOfSurface, OpenTerrainIsUnknownBeyondItsEdges) {
  const Snapshot s = snapshot(*simulation(flat_sand(8, 20, "open")));
  const std::vector<float> z = heights(s, {-1, 3, 40, 1, 0.05});
  for (std::size_t n = 0; n < 40; ++n) EXPECT_EQ(std::isnan(z[n]), n < 20) << n;
}

TEST_P(MicroReliefOfSurface, ThereAreNoneWhereTheWindMovesNoSand) {
  const Snapshot bare = flat(8);
  ASSERT_GT(largest_offset(bare), 0.4 * height(8));
  const auto with = [&](Layer layer, float value) {
    Snapshot s = bare;
    std::fill(s.layers.at(layer).begin(), s.layers.at(layer).end(), value);
    return largest_offset(s);
  };
  EXPECT_EQ(with(Layer::wind_shadow, 1), 0);
  EXPECT_EQ(with(Layer::sand, 0), 0);
  EXPECT_EQ(with(Layer::water, 0.01f), 0);
  EXPECT_EQ(with(Layer::obstacle, 1), 0);
  EXPECT_EQ(with(Layer::moisture, 0.2f), 0);
  EXPECT_EQ(largest_offset(flat(0.9)), 0) << "below the threshold";
  EXPECT_EQ(largest_offset(flat(0)), 0) << "in still air";
  Snapshot s = bare;
  std::fill(s.layers.at(Layer::moisture).begin(), s.layers.at(Layer::moisture).end(), 0.2f);
  std::fill(s.layers.at(Layer::sand).begin(), s.layers.at(Layer::sand).end(), 3.0f);
  s.micro_relief.moisture_cutoff = 1;
  const double damp = largest_offset(s);
  EXPECT_GT(damp, 0) << "saltation.moisture_cutoff";
  s.micro_relief.moisture_depth = 2;
  EXPECT_GT(largest_offset(s), 1.5 * damp) << "repose.moisture_depth";
  s = bare;
  s.micro_relief.wind.x = s.micro_relief.wind.y = 0;
  EXPECT_EQ(largest_offset(s), 0) << "where no direction prevails";
}

TEST_P(MicroReliefOfSurface, TheyFadeInHalfAShadowAndDoNotDigThroughThinSand) {
  Snapshot s = flat(8);
  const double full = largest_offset(s);
  std::fill(s.layers.at(Layer::wind_shadow).begin(), s.layers.at(Layer::wind_shadow).end(), 0.5f);
  EXPECT_NEAR(largest_offset(s) / full, 0.5, 1e-3);
  s = flat(8);
  for (const float depth : {0.0005f, 0.001f, 0.003f, 0.006f}) {
    std::fill(s.layers.at(Layer::sand).begin(), s.layers.at(Layer::sand).end(), depth);
    EXPECT_LT(largest_offset(s), depth);
    EXPECT_GT(largest_offset(s), 0);
  }
}

TEST_P(MicroReliefOfSurface, TheyAreLowUnderPlants) {
  Snapshot s = flat(8);
  s.micro_relief.parameters.bumps = false;
  const double full = largest_offset(s);
  for (const float density : {0.5f, 1.0f}) {
    std::fill(s.layers.at(Layer::vegetation).begin(), s.layers.at(Layer::vegetation).end(), density);
    EXPECT_NEAR(largest_offset(s) / full, 1 - static_cast<double>(density), 1e-3);
  }
}

TEST_P(MicroReliefOfSurface, SlopesFromTheAngleOfReposeOnHaveNone) {
  for (const auto& [degrees, some] : {std::pair{20.0, true}, {33.1, false}, {50.0, false}}) {
    Snapshot s = snapshot(*simulation(flat_sand(8, 0, "open")));
    std::vector<float>& z = s.layers.at(Layer::elevation);
    for (std::size_t i = 0; i < z.size(); ++i)
      z[i] = static_cast<float>(static_cast<double>(i / 32) * std::tan(degrees * pi / 180));
    const MicroRelief micro_relief(s);
    double largest = 0;
    for (int n = 0; n < 200; ++n)
      largest = std::max(largest, std::abs(micro_relief.offset(8 + 0.02 * n, 12)));
    EXPECT_EQ(largest > 0, some) << degrees;
  }
}

/// Where the sand of the heaps is, west to east [m], and how much of it [m³].
std::pair<double, double> heaps(const Snapshot& s) {
  const MicroReliefWindow w{0, 0, 640, 480, 0.05};
  const std::vector<float> z = heights(s, w);
  double volume = 0, moment = 0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    const double sand = static_cast<double>(z[i]) - 1;
    volume += sand;
    moment += sand * (static_cast<double>(i % 640) + 0.5) * w.resolution;
  }
  return {moment / volume, volume * w.resolution * w.resolution};
}

TEST_P(MicroReliefOfSurface, SandIsHeapedWindwardOfPlants) {
  const auto with_plants = [this](double direction) {
    Snapshot s = flat(8, direction);
    s.micro_relief.parameters.ripples = false;
    for (std::size_t y = 6; y < 18; ++y)
      for (std::size_t x = 8; x < 24; ++x) s.layers.at(Layer::vegetation)[y * 32 + x] = 0.9f;
    return s;
  };
  const auto [east, volume] = heaps(with_plants(0));
  const auto [west, other] = heaps(with_plants(180));
  EXPECT_NEAR(west - east, 2 * 0.6 * 0.4 * (1 - 0.3) / (1 + 0.3), 0.03);
  EXPECT_NEAR(volume, other, 0.02 * volume);
  EXPECT_GT(volume, 0.5);
  Snapshot none = with_plants(0);
  none.micro_relief.parameters.bumps = false;
  EXPECT_EQ(largest_offset(none), 0);
}

TEST_P(MicroReliefOfSurface, TheSeedMovesRipplesAndTheSameSeedDoesNot) {
  Snapshot s = flat(8);
  const MicroReliefWindow w{4, 4, 100, 100, 0.02};
  const std::vector<float> first = heights(s, w);
  EXPECT_EQ(heights(flat(8), w), first);
  ++s.micro_relief.seed;
  EXPECT_NE(heights(s, w), first);
}

TEST_P(MicroReliefOfSurface, TheStateDoesNotKnowOfIt) {
  const auto plain = simulation(flat_sand(8, 20)),
             other = simulation(flat_sand(8, 20) + "micro_relief: {response_time: 5, ripples: false}\n");
  test::run(*plain, 5);
  test::run(*other, 5);
  const std::uint64_t hash = plain->state().hash();
  EXPECT_GT(largest_offset(snapshot(*plain)), 0);
  EXPECT_EQ(plain->state().hash(), hash);
  EXPECT_EQ(other->state().hash(), hash);
}

TEST_P(MicroReliefOfSurface, ACheckpointContinuesToTheBit) {
  const auto world = simulation(flat_sand(8, 20));
  world->apply(command::SetWind{100, 6, 0});
  test::run(*world, 40);
  const auto again = simulation_from_bytes(checkpoint_bytes(*world), exec(), "checkpoint");
  test::run(*world, 40);
  test::run(*again, 40);
  const MicroReliefWindow w{4, 4, 100, 100, 0.02};
  EXPECT_EQ(heights(snapshot(*again), w), heights(snapshot(*world), w));
  EXPECT_NE(heights(snapshot(*again), w), heights(flat(8, 20), w));
}

DESERT_ON_EACH_BACKEND(MicroReliefOfSurface);

}  // namespace
}  // namespace desert_sim
