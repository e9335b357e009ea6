// Echo dunes: the lane free of sand before a cliff, and the sticky ground ahead of it.

#include <algorithm>

#include "test/support/bench_terrain.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

class EchoDunes : public test::OnBackend {};

TEST_P(EchoDunes, LaneAndStickyGroundLieAtTheirDistancesBeforeACliff) {
  // A wall of 10 m at x = 40, wind to the east: lane up to 4 m before its face, sticky up to 20 m.
  test::BenchTerrain t(exec(), 64, 3, 1, false);
  t.set(Layer::bedrock, [](int x, int) { return x >= 40 && x < 44 ? 10 : 0; }).set(Layer::wind_x, 5);
  EchoDuneParameters p;
  t.echo(p);
  for (int x = 0; x < 64; ++x) {
    const int d = 40 - x;
    double expected = 0;
    if (d >= 1 && d <= 4) expected = -1;
    if (d > 4 && d <= 20) expected = std::clamp(1.1 - (d - 4) / 16.0, 0.0, 1.0);
    EXPECT_NEAR(t.at(Layer::echo, x, 1), expected, 1e-5) << "at " << d << " m before the cliff";
  }
}

TEST_P(EchoDunes, StickyGroundBeginsAtItsShareBesideTheLane) {
  for (const float start : {0.5f, 2.0f}) {
    test::BenchTerrain t(exec(), 64, 3, 1, false);
    t.set(Layer::bedrock, [](int x, int) { return x >= 40 && x < 44 ? 10 : 0; }).set(Layer::wind_x, 5);
    EchoDuneParameters p;
    p.sticky_start = start;
    t.echo(p);
    for (int d = 5; d <= 20; ++d)
      EXPECT_NEAR(t.at(Layer::echo, 40 - d, 1), std::clamp(start - (d - 4) / 16.0, 0.0, 1.0), 1e-5) << d;
  }
}

TEST_P(EchoDunes, ScalesWithTheHeightUpToItsLimitAndInMetres) {
  for (double cell : {0.5, 2.0}) {
    test::BenchTerrain t(exec(), 128, 3, cell, false);
    t.set(Layer::bedrock, [](int x, int) { return x >= 100 ? 50 : 0; }).set(Layer::wind_x, 5);
    EchoDuneParameters p;
    p.highest = 20;
    p.erosion_rate = 0.25f;
    t.echo(p);
    for (int x = 60; x < 100; ++x) {
      const double d = (100 - x) * cell;
      EXPECT_EQ(t.at(Layer::echo, x, 1) == -0.25, d <= 8) << "cell " << cell << ", at " << d;
      EXPECT_EQ(t.at(Layer::echo, x, 1) > 0, d > 8 && d <= 40) << "cell " << cell << ", at " << d;
    }
  }
}

/// A cliff of five steps of 2 m, which rises from x = 39 to x = 44, is 10 m high at its top. Walls of a
/// single step hid a height that was that of the last step, 2 m: then sand sticks up to 4 m from the top
/// instead of 20 m.
TEST_P(EchoDunes, HeightOfACliffIsThatOfAllItsSteps) {
  test::BenchTerrain t(exec(), 64, 3, 1, false);
  t.set(Layer::bedrock, [](int x, int) { return x < 50 ? 2 * std::clamp(x - 39, 0, 5) : 0; });
  t.set(Layer::wind_x, 5);
  t.echo({});
  const int top = 44;
  for (int x = 0; x < 36; ++x) {  // nearer cells stand before the lower parts of the slope, too
    const int d = top - x;
    const double expected = d <= 20 ? std::clamp(1.1 - (d - 4) / 16.0, 0.0, 1.0) : 0;
    EXPECT_NEAR(t.at(Layer::echo, x, 1), expected, 1e-5) << d << " m before the top";
  }
  EXPECT_EQ(t.at(Layer::echo, 40, 1), -1) << "the lane reaches 4 m from the top, over the slope";
}

TEST_P(EchoDunes, NeedsACliffThatFacesTheWind) {
  test::BenchTerrain t(exec(), 64, 3);
  t.set(Layer::wind_x, 5);
  const auto any = [&] {
    for (float v : t.terrain.values(Layer::echo))
      if (v != 0) return true;
    return false;
  };
  t.set(Layer::bedrock, [](int x, int) {
    return x >= 20 && x < 40 ? std::min(x - 20, 15) * 1.4 : 0;
  });  // 54.5°, sheer to the lee
  t.echo({});
  EXPECT_FALSE(any());
  t.set(Layer::bedrock,
        [](int x, int) { return x >= 20 && x < 40 ? std::min(x - 20, 15) * 1.45 : 0; });  // 55.4°
  t.echo({});
  EXPECT_TRUE(any());
  t.set(Layer::wind_x, 0);
  t.echo({});
  EXPECT_FALSE(any()) << "in calm air";
}

DESERT_ON_EACH_BACKEND(EchoDunes);

}  // namespace
}  // namespace desert_sim
