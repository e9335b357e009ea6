// The scenes of rivers, floods and seas show what their headers say, on smaller grids or for a shorter time.

#include <algorithm>
#include <cmath>

#include "test/support/field_means.hpp"
#include "test/support/running.hpp"

namespace desert_sim {
namespace {

/// The rows of a field from `first` on, `rows` of them.
Field rows_of(const Field& f, int first, int rows) {
  Field part = f;
  part.height = rows;
  part.periodic = false;
  part.values.assign(f.values.begin() + first * f.width, f.values.begin() + (first + rows) * f.width);
  return part;
}

/// On the floor of the western half of the valley. shallow_water leaves 0.23 to 0.26 of it bare, with banks
/// on 0.45 of it; streams that broke into pulses left 0.46 bare, and banks on 0.27.
TEST(Wadi, FloodSweepsItsBed) {
  Running scene(shipped("wadi", {"grid.width=192"}));
  const auto floor = [&](Layer layer) { return rows_of(scene.field(layer), 32, 64); };
  const Orientation ridges = crest_orientation((scene.run(300), floor(Layer::sand)), 6);
  const Field before = (scene.run(100), floor(Layer::sand));
  const double bare_before = share_where(before, [&](std::size_t i) { return before.values[i] < 0.05f; });
  const Field flood = (scene.run(200), floor(Layer::water));
  const double flooded = share_where(flood, [&](std::size_t i) { return flood.values[i] > 0.1f; });
  const Field carried = floor(Layer::suspended_sediment);
  const double load = mean_over(carried, [&](std::size_t i) { return flood.values[i] > 0.1f; });
  scene.run(200);
  const Field after = floor(Layer::sand), water = floor(Layer::water), speed = floor(Layer::water_velocity_x);
  const double bare = share_where(after, [&](std::size_t i) { return after.values[i] < 0.05f; });
  const double banks =
      share_where(after, [&](std::size_t i) { return after.values[i] > before.values[i] + 0.3f; });
  const double flowing =
      share_where(water, [&](std::size_t i) { return water.values[i] > 0.1f && speed.values[i] > 0.1f; });
  DESERT_REPORT(
      "ridges at %.0f degrees (coherence %.2f); flooded %.2f, %.3f m of sand in it; bare %.2f (before %.2f), "
      "banks %.3f, water "
      "flows in %.3f",
      ridges.crest_deg, ridges.coherence, flooded, load, bare, bare_before, banks, flowing);
  EXPECT_LT(line_angle_between_deg(ridges.crest_deg, 90), 25);
  EXPECT_GT(ridges.coherence, 0.1);
  EXPECT_LT(bare_before, 0.1);
  EXPECT_GT(flooded, 0.5);
  EXPECT_GT(load, 0.015) << "the flood carries sand [m]";
  EXPECT_GT(bare, 0.15);
  EXPECT_GT(banks, 0.3);
  EXPECT_GT(flowing, 0.02);
  scene.expect_balanced();
}

#if DESERT_WITH_IO
/// Bodies of water deeper than 0.3 m, over eight neighbours.
int ponds_of(const Field& water) { return static_cast<int>(find_dunes(water, water, 0, 0.3, 1).size()); }

/// A river comes in, fills the deepest hollow, and drops its sand there; rain fills hollows on the plateau:
/// four of them by the end, as with shallow_water.
TEST(RiverBend, FillsTheHollowAndDropsItsSand) {
  Running scene(shipped("river_bend"));

  double deepest[3], in_lake[3], x = 0, y = 0;
  for (int look = 0; look < 3; ++look) {
    const Field water = scene.run(look ? 225 : 150).field(Layer::water), sand = scene.field(Layer::sand);
    const auto place = std::max_element(water.values.begin(), water.values.end()) - water.values.begin();
    x = static_cast<double>(place % water.width), y = static_cast<double>(place / water.width);
    deepest[look] = static_cast<double>(water.values[static_cast<std::size_t>(place)]);
    in_lake[look] = mean_over(sand, [&](std::size_t i) { return water.values[i] > 1.5f; });
    DESERT_REPORT("%.1f m deep at %.0f, %.0f; sand there %.2f m; %d ponds", deepest[look], x, y,
                  in_lake[look], ponds_of(water));
  }

  EXPECT_GT(deepest[1], 1.3 * deepest[0]);
  EXPECT_NEAR(deepest[2], deepest[1], 0.15 * deepest[1]);
  EXPECT_GT(in_lake[2], in_lake[0] + 0.15);
  EXPECT_GE(ponds_of(scene.field(Layer::water)), 3);
  scene.expect_balanced();
}
#endif

/// Rain lays the soil of the high ground bare (without, 6 % of it are); sand gathers at the shore and in
/// shallows.
TEST(IslandSea, RainBaresTheSoilAndSandLinesTheShores) {
  Running scene(shipped("island_sea", {"grid.width=128", "grid.height=128"}));
  const Field first = scene.field(Layer::sand);
  const double before = mean_over(first, [](std::size_t) { return true; });
  scene.run(300);
  const Field top = scene.field(Layer::elevation), sand = scene.field(Layer::sand),
              soil = scene.field(Layer::soil);
  const auto between = [&top](float low, float high) {
    return [&top, low, high](std::size_t i) { return top.values[i] > low && top.values[i] <= high; };
  };
  const auto land = between(2, 100);
  const double brown =
      share_where(
          top, [&](std::size_t i) { return land(i) && sand.values[i] < 0.02f && soil.values[i] > 0.02f; }) /
      share_where(top, land);
  const double high = mean_over(sand, between(4, 100)), rim = mean_over(sand, between(-0.5f, 2)),
               shallows = mean_over(sand, between(-4, -0.5f));
  DESERT_REPORT(
      "bare soil on %.2f of the land; sand: %.2f m on high ground, %.2f m at the shore, %.2f m in the "
      "shallows (before %.2f m)",
      brown, high, rim, shallows, before);
  EXPECT_GT(brown, 0.3);
  EXPECT_LT(high, 0.8 * before);
  EXPECT_GT(rim, 1.1 * before);
  EXPECT_GT(rim, 1.5 * high);
  EXPECT_GT(shallows, 1.2 * before);
  scene.expect_balanced();
}

TEST(OasisCycle, TurnsGreenAndIsADesertAgain) {
  // The rain stops 1200 s sooner: the forest has then stood long enough.
  Running scene(shipped("oasis_cycle", {"grid.width=48", "grid.height=48", "run.timeline.3.time=2000"}));
  struct Look {
    double wet, bare, brown, relief;
    int seaweed, bushes, trees;
  };
  const auto look = [&](int step) {
    while (scene.simulation().steps() < static_cast<std::uint64_t>(step)) scene.run(1);
    const Field sand = scene.field(Layer::sand), water = scene.field(Layer::water),
                soil = scene.field(Layer::soil);
    Look l{};
    l.wet = share_where(water, [&](std::size_t i) { return water.values[i] > 0.2f; });
    l.bare = share_where(sand, [&](std::size_t i) { return sand.values[i] + soil.values[i] < 0.02f; });
    l.brown =
        share_where(sand, [&](std::size_t i) { return sand.values[i] < 0.02f && soil.values[i] > 0.02f; });
    l.relief = roughness(sand);
    for (const PlantCount& c : scene.simulation().state().plant_counts())
      if (c.species == "seaweed")
        l.seaweed = c.plants;
      else if (c.species == "bush")
        l.bushes = c.plants;
      else if (c.species == "tree")
        l.trees = c.plants;
    DESERT_REPORT(
        "step %d: wet %.2f, bare rock %.2f, soil %.2f, relief of sand %.2f m; %d seaweed, %d bushes, %d "
        "trees",
        step, l.wet, l.bare, l.brown, l.relief, l.seaweed, l.bushes, l.trees);
    return l;
  };
  const Look desert = look(600);
  EXPECT_GT(desert.bare, 0.1);
  EXPECT_GT(desert.relief, 1);
  EXPECT_EQ(desert.bushes + desert.trees, 0);
  EXPECT_GT(look(800).wet, 0.3);
  const Look shores = look(1000);
  EXPECT_GT(shores.seaweed, 5);
  EXPECT_GT(shores.bushes, 300);
  EXPECT_GT(shores.trees, 100);
  const Look forest = look(2000);
  EXPECT_GT(forest.trees, 300);
  EXPECT_GT(forest.bushes, 300);
  EXPECT_GT(forest.brown, 0.5) << "plants make soil of the sand";
  const Look trees = look(2400);
  EXPECT_LT(trees.bushes, forest.bushes / 20);
  EXPECT_GT(trees.trees, forest.trees / 10);
  const Look dead = look(2800);
  EXPECT_LT(dead.bushes + dead.trees, forest.trees / 10);
  EXPECT_GT(dead.brown, 0.4);
  const Look again = look(3600);
  EXPECT_LT(again.brown, 0.3);
  EXPECT_GT(again.relief, 2 * dead.relief);
  EXPECT_EQ(again.bushes + again.trees, 0);
  scene.expect_balanced();
}

}  // namespace
}  // namespace desert_sim
