// The scenario of a flash flood: bores come down dry channels, scour them, and leave new sand.

#include <algorithm>
#include <cmath>
#include <vector>

#include "test/support/running.hpp"

namespace desert_sim {
namespace {

/// A place in the middle of a channel, where the bore's arrival is looked at.
struct Gauge {
  int x, y;             ///< [cells], which are of 1 m
  double way = 0;       ///< from the gauge before [m]
  double arrival = -1;  ///< of water of 2 cm [s]
  double high = -1;     ///< when it was first 20 cm deep [s]
  double depth = 0;     ///< greatest in the ten seconds after the arrival [m]
};

void look(Gauge& g, const Field& water, double time) {
  const double depth = water.at(g.x, g.y);
  if (g.arrival < 0 && depth > 0.02) g.arrival = time;
  if (g.high < 0 && depth > 0.2) g.high = time;
  if (g.arrival >= 0 && time < g.arrival + 10) g.depth = std::max(g.depth, depth);
}

double wet_share(const Field& water) {
  const auto wet = std::count_if(water.values.begin(), water.values.end(), [](float d) { return d > 0.02F; });
  return static_cast<double>(wet) / static_cast<double>(water.values.size());
}

class Bores : public testing::TestWithParam<int> {};

/// Fronts on dry ground run about as fast as waves on the water behind them, √(g h): 0.88 to 1.47 times, and
/// are 1.5 to 6 s long, with both seeds.
TEST_P(Bores, RunDownDryChannels) {
  Running scene(shipped("flash_flood", {"seed=" + std::to_string(GetParam())}));
  scene.run(238);
  EXPECT_EQ(wet_share(scene.field(Layer::water)), 0) << "both channels are dry for two minutes";
  // On the way of the main channel, whose middle is y = 46 + 13 sin 2π (x − 20)/150, and in the tributary.
  std::vector<Gauge> main{{60, 59}, {80, 54}, {110, 38}, {150, 36}, {180, 51}},
      tributary{{113, 74}, {126, 60}};
  for (std::vector<Gauge>* channel : {&main, &tributary})
    for (std::size_t n = 1; n < channel->size(); ++n) {
      const Gauge& before = (*channel)[n - 1];
      (*channel)[n].way = std::hypot((*channel)[n].x - before.x, (*channel)[n].y - before.y);
    }
  double wettest = 0;
  while (scene.simulation().time() < 230) {
    const Field water = scene.run(1).field(Layer::water);
    for (Gauge& g : main) look(g, water, scene.simulation().time());
    for (Gauge& g : tributary) look(g, water, scene.simulation().time());
    wettest = wet_share(water);
  }
  for (const std::vector<Gauge>* channel : {&main, &tributary})
    for (std::size_t n = 0; n < channel->size(); ++n) {
      const Gauge& g = (*channel)[n];
      ASSERT_GT(g.arrival, 0) << g.x;
      ASSERT_GT(g.high, 0) << g.x << ": " << g.depth << " m";
      const double c = std::sqrt(9.81 * g.depth),
                   speed = n > 0 ? g.way / (g.arrival - (*channel)[n - 1].arrival) : 0;
      DESERT_REPORT(
          "(%d, %d): water at %.1f s, front %.1f s long, %.2f m deep; speed %.2f m/s, %.2f of its waves", g.x,
          g.y, g.arrival, g.high - g.arrival, g.depth, speed, speed / c);
      EXPECT_LE(g.high - g.arrival, 8) << "at " << g.x;
      if (n == 0) continue;
      EXPECT_GT(speed, 0.5 * c);
      EXPECT_LT(speed, 2.5 * c);
    }
  DESERT_REPORT("%.2f of the ground is wet", wettest);
  EXPECT_LT(wettest, 0.5) << "it stays in its channels";
  scene.expect_balanced();
}

INSTANTIATE_TEST_SUITE_P(OfTheFlashFlood, Bores, testing::Values(1, 2));

/// With seeds 1 and 2: 642 and 637 m³ scoured, 316 and 313 m³ of new sand, of which 82 and 80 m³ where the
/// channel widens.
TEST(FlashFlood, ScoursItsBedAndLeavesNewSand) {
  Running scene(shipped("flash_flood"));
  const Field bed = scene.field(Layer::elevation), sand = scene.field(Layer::sand);
  scene.run(1000);
  const Field bed_after = scene.field(Layer::elevation), sand_after = scene.field(Layer::sand);
  double scoured = 0, deposited = 0, in_the_wide = 0;
  for (int y = 0; y < bed.height; ++y)
    for (int x = 0; x < bed.width; ++x) {
      const double change = bed_after.at(x, y) - bed.at(x, y), fresh = sand_after.at(x, y) - sand.at(x, y);
      if (change < -0.02) scoured -= change;
      if (fresh > 0.02) deposited += fresh;
      if (fresh > 0.02 && x >= 192) in_the_wide += fresh;
    }
  DESERT_REPORT("scoured %.0f m3, new sand %.0f m3, of which %.0f m3 where the channel widens", scoured,
                deposited, in_the_wide);
  EXPECT_GT(scoured, 400);
  EXPECT_GT(deposited, 200);
  EXPECT_GT(in_the_wide, 50);
  EXPECT_LT(wet_share(scene.field(Layer::water)), 0.4);
  scene.expect_balanced();
}

}  // namespace
}  // namespace desert_sim
