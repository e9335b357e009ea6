// Sediment goes with its water, and flowing water wears ground alike whichever way it runs on the grid.

#include <cmath>

#include "src/core/constants.hpp"
#include "test/support/bench_terrain.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

/// 0 … 1, of a cell.
double roughness(int x, int y) {
  const double n = std::sin(12.9898 * x + 78.233 * y) * 43758.5453;
  return n - std::floor(n);
}

class Sediment : public test::OnBackend {
 protected:
  static WaterParameters water(float friction) {
    WaterParameters p;
    p.friction = friction;
    p.most_substeps = 1000;
    return p;
  }
};

TEST_P(Sediment, KeepsItsShareOfTheWater) {
  for (bool periodic : {true, false}) {
    test::BenchTerrain t(exec(), 40, 32, 1, periodic);
    t.set(Layer::bedrock, [](int x, int y) { return 2 * std::sin(0.4 * x) * std::cos(0.3 * y); });
    t.set(Layer::water, [](int x, int y) { return 2 + (x < 20 ? 1.0 : 0.0) + 0.2 * roughness(x, y); });
    t.set(Layer::suspended_sediment, [&](int x, int y) { return 0.05 * t.at(Layer::water, x, y); });
    const long long before = t.total(Layer::suspended_sediment);
    for (int n = 0; n < 20; ++n) {
      t.flow(water(0.05f), 1, n);
      ASSERT_EQ(t.total(Layer::suspended_sediment) + t.booked(Material::sediment, 1), before);
    }
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 40; ++x) {
        const double depth = t.at(Layer::water, x, y);
        if (depth < 0.05) continue;  // shares are rounded down to whole quanta
        ASSERT_NEAR(t.at(Layer::suspended_sediment, x, y) / depth, 0.05, 1e-3) << x << ", " << y;
      }
    EXPECT_EQ(t.booked(Material::sediment, 1) > 0, !periodic);
  }
}

/// A stream that turns at every second cell, faster than a cell a step.
TEST_P(Sediment, DoesNotComeOverTheBanksOfAStream) {
  const int cells = 48;
  test::BenchTerrain t(exec(), cells, cells, 1, false);
  const auto inside = [](int x, int y) { return x == y || x == y + 1; };
  t.set(Layer::bedrock, [&](int x, int y) { return 0.2 * (2 * cells - x - y) + (inside(x, y) ? 0 : 3); });
  t.set(Layer::water, [&](int x, int y) { return inside(x, y) ? 0.2 : 0; });
  t.set(Layer::suspended_sediment, [&](int x, int y) { return inside(x, y) ? 0.02 : 0; });
  double fastest = 0;
  for (int n = 0; n < 20; ++n) {
    t.flow(water(0.5f), 1);
    for (int y = 0; y < cells; ++y)
      for (int x = 0; x < cells; ++x) {
        fastest = std::max(fastest, t.at(Layer::water_velocity_x, x, y));
        if (!inside(x, y)) {
          ASSERT_EQ(t.quanta_at(Layer::suspended_sediment, x, y), 0) << x << ", " << y;
        }
      }
  }
  EXPECT_GT(fastest, 1.5);
  EXPECT_GT(t.booked(Material::sediment, 1), t.total(Layer::suspended_sediment) / 4);
}

TEST_P(Sediment, PlanesErodeAlikeWhicheverWayTheyTilt) {
  const int cells = 96;
  const auto lost = [&](double degrees) {
    test::BenchTerrain t(exec(), cells, cells, 1, false);
    const double slope = 0.02, east = slope * std::cos(degrees * pi / 180),
                 north = slope * std::sin(degrees * pi / 180);
    t.set(Layer::bedrock, [&](int x, int y) { return 5 - east * x - north * y; });
    t.set(Layer::sand, 1).set(Layer::water, 0.3);
    HydraulicErosionParameters p;
    p.capacity = 5;
    p.least_slope = 0.001f;
    for (int n = 0; n < 10; ++n) {
      t.flow(water(0.1f), 1, n);
      t.erode(p);
    }
    double sum = 0, least = 1, most = 0;  // in the middle, where no edge is felt yet
    for (int y = 40; y < 56; ++y)
      for (int x = 40; x < 56; ++x) {
        const double gone = 1 - t.at(Layer::sand, x, y);
        sum += gone / 256;
        least = std::min(least, gone);
        most = std::max(most, gone);
      }
    EXPECT_LT((most - least) / sum, 0.05) << degrees << " degrees";
    return sum;
  };
  const double along = lost(0);
  EXPECT_GT(along, 0.01);
  for (const double degrees : {22.5, 45.0, 67.5, 90.0, 180.0, 225.0})
    EXPECT_NEAR(lost(degrees) / along, 1, 0.02) << degrees << " degrees";
}

/// How far cells stand out from the two beside them [m], root of the mean square: the shortest wave.
double standing_out(const test::BenchTerrain& t, int cells) {
  double sum = 0;
  long long count = 0;
  for (int y = 16; y < cells - 16; ++y)
    for (int x = 16; x < cells - 16; ++x) {
      const auto sand = [&](int dx, int dy) { return t.at(Layer::sand, x + dx, y + dy); };
      const double across = sand(0, 0) - 0.5 * (sand(0, 1) + sand(0, -1)),
                   along = sand(0, 0) - 0.5 * (sand(1, 0) + sand(-1, 0));
      sum += across * across + along * along;
      count += 2;
    }
  return std::sqrt(sum / static_cast<double>(count));
}

TEST_P(Sediment, ARoughPlaneInTheRainGrowsNoPatternOfSingleCells) {
  const int cells = 64;
  for (const double degrees : {0.0, 30.0, 45.0}) {
    test::BenchTerrain t(exec(), cells, cells, 1, false);
    const double slope = 0.05, east = slope * std::cos(degrees * pi / 180),
                 north = slope * std::sin(degrees * pi / 180);
    t.set(Layer::bedrock, [&](int x, int y) { return 10 - east * x - north * y; });
    t.set(Layer::sand, [&](int x, int y) { return 1 + 0.01 * roughness(x, y); });
    const double before = standing_out(t, cells);
    HydraulicErosionParameters p;
    p.capacity = 1;
    t.terrain.allocate(Layer::water);
    for (int n = 0; n < 300; ++n) {
      const std::vector<Quanta> there = t.quanta(Layer::water);
      t.set_quanta(Layer::water,
                   [&](int x, int y) { return there[static_cast<std::size_t>(y * cells + x)] + 105; });
      t.flow(water(0.1f), 1, n);  // 0.1 mm of rain a second
      t.erode(p);
    }
    const double lost = 1.005 - static_cast<double>(t.total(Layer::sand)) / (1 << 20) / (cells * cells);
    EXPECT_GT(lost, 0.003) << degrees << " degrees";
    EXPECT_LT(standing_out(t, cells), 1.5 * before) << degrees << " degrees";
  }
}

DESERT_ON_EACH_BACKEND(Sediment);

}  // namespace
}  // namespace desert_sim
