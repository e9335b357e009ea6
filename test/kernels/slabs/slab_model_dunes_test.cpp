// Slab models in parallel beside the same models one poll after the other (support/sequential_slabs.hpp), by
// statistics over ten seeds.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "test/support/patterns.hpp"
#include "test/support/running.hpp"
#include "test/support/sequential_slabs.hpp"

namespace desert_sim {
namespace {

constexpr int slab_side = 96;

test::Pattern in_parallel(const std::string& model, const std::string& repose, int slabs, int steps,
                          int seed) {
  const std::string size = std::to_string(slab_side);
  Running scene(parse_scenario_text(
      "grid: {width: " + size + ", height: " + size + "}\nterrain: [uniform: {layer: sand, value: " +
          std::to_string(slabs / 3.0) + "}]\nwind: {speed: 5}\nslab_model: {repose_deg: " + repose +
          "}\nsand: {model: " + model + "}\nseed: " + std::to_string(seed) + "\n",
      "slabs"));
  scene.run(steps).expect_balanced();
  std::vector<double> heights;
  for (float metres : scene.field(Layer::sand).values)
    heights.push_back(std::round(3.0 * static_cast<double>(metres)));
  return test::pattern_of(heights);
}

void compare(const std::string& model, const std::string& repose, int slabs, int steps,
             test::SequentialSlabs (*make)(int cells, int slabs, unsigned seed)) {
  std::vector<test::Pattern> parallel, sequential;
  for (int seed = 1; seed <= test::seeds; ++seed) {
    parallel.push_back(in_parallel(model, repose, slabs, steps, seed));
    test::SequentialSlabs reference = make(slab_side, slabs, static_cast<unsigned>(seed));
    reference.run(steps);
    sequential.push_back(test::pattern_of({reference.height.begin(), reference.height.end()}));
  }
  test::expect_alike(parallel, sequential);
}

TEST(SlabModels, WernerIsAsOnePollAfterTheOther) { compare("werner", "30", 3, 200, test::sequential_werner); }

TEST(SlabModels, MomijiIsAsOnePollAfterTheOther) {
  compare("momiji", "33.7", 6, 120, test::sequential_momiji);
}

/// Six years of nield_nebkha on a smaller grid: from bare ground, plants have caught sand in mounds.
TEST(SlabModels, NebkhasHaveTheirSandWherePlantsAre) {
  Running scene(shipped("nield_nebkha", {"grid.width=128", "grid.height=128"}));
  scene.run(500).expect_balanced();
  const Field sand = scene.field(Layer::sand), grass = scene.field(Layer::grass),
              mesquite = scene.field(Layer::mesquite), shrub = scene.field(Layer::shrub);
  double planted = 0, bare = 0, of_planted = 0, of_bare = 0, highest = 0, effective_at_top = 0;
  for (std::size_t i = 0; i < sand.values.size(); ++i) {
    const double depth = static_cast<double>(sand.values[i]) / 0.1;  // [slabs]
    const double effect = static_cast<double>(grass.values[i] + mesquite.values[i] + shrub.values[i]);
    (effect > 0.5 ? planted : bare) += depth;
    (effect > 0.5 ? of_planted : of_bare) += 1;
    if (depth > highest) {
      highest = depth;
      effective_at_top = effect;
    }
  }
  ASSERT_GT(of_planted, 100);
  DESERT_REPORT("highest %.0f slabs, effectiveness there %.2f; %.1f slabs on %.1f %% planted, %.1f on others",
                highest, effective_at_top, planted / of_planted, 100 * of_planted / (of_planted + of_bare),
                bare / of_bare);
  EXPECT_GT(planted / of_planted, 4 * bare / of_bare);
  EXPECT_GT(effective_at_top, 0.3);
  EXPECT_GT(highest, 30) << "werner without plants reaches fewer";

  Running without(shipped("nield_nebkha", {"grid.width=128", "grid.height=128", "sand.model=werner"}));
  without.run(500);
  double highest_without = 0;
  for (const float depth : without.field(Layer::sand).values)
    highest_without = std::max(highest_without, static_cast<double>(depth) / 0.1);
  DESERT_REPORT("highest without plants %.0f slabs", highest_without);
  EXPECT_GT(highest, 1.3 * highest_without);
}

/// Bare patches of a planted sheet become hollows with walls of sand in their lee, which bury plants.
TEST(SlabModels, BlowoutsGrowFromBarePatches) {
  Running scene(shipped("nield_blowouts"));
  const auto hollow = [&] {  // cells that have lost more than half of the sand
    const std::vector<float> sand = scene.field(Layer::sand).values;
    return std::count_if(sand.begin(), sand.end(), [](float depth) { return depth < 1.0f; });
  };
  scene.run(400);
  const auto early = hollow();
  scene.run(1200).expect_balanced();
  const auto late = hollow();
  DESERT_REPORT("hollows of %d and %d cells", static_cast<int>(early), static_cast<int>(late));
  EXPECT_GT(early, 30);
  EXPECT_GT(late, 2 * early);
}

}  // namespace
}  // namespace desert_sim
