// Where new plants come up, and how many.

#include "kernels/plants/spawning.hpp"

#include <cmath>
#include <set>

#include "test/support/plants.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

using test::Plant;
using test::PlantBench;
using test::undemanding;

/// So many seeds that one comes up wherever the place suits.
SpeciesTraits everywhere() {
  SpeciesTraits s = undemanding();
  s.spawn = 1e9f;
  s.growth = 0;
  s.slope = 100;
  return s;
}

class PlantSpawning : public test::OnBackend {
 protected:
  /// Whether a plant comes up in the eastern half, of which `change` is told x ≥ 8, and in the western.
  struct Halves {
    int west = 0, east = 0;
  };
  Halves halves(const SpeciesTraits& s, const std::function<void(PlantBench&)>& change) {
    PlantBench bench(exec(), 16, 16, {s}, 1, false);
    change(bench);
    bench.cover();
    bench.live();
    Halves found;
    for (const Plant& plant : bench.plants()) ++(plant.x < 8 ? found.west : found.east);
    return found;
  }
  void expect_only_west(const SpeciesTraits& s, const std::function<void(PlantBench&)>& change) {
    const Halves found = halves(s, change);
    EXPECT_EQ(found.west, 128);
    EXPECT_EQ(found.east, 0);
  }
  static std::function<double(int, int)> east(double value, double elsewhere = 0) {
    return [=](int x, int) { return x < 8 ? elsewhere : value; };
  }
};

TEST_P(PlantSpawning, SeedlingsAreHealthyAndSmallAndLieOnTheGround) {
  SpeciesTraits s = everywhere();
  s.root = 10;
  PlantBench bench(exec(), 8, 8, {s});
  bench.terrain.set(Layer::soil, [](int x, int) { return x == 0 ? 0.0 : 10 * x; });
  bench.live();
  const std::vector<Plant> plants = bench.plants();
  ASSERT_EQ(plants.size(), 56u) << "none on bare rock";
  std::set<std::pair<int, int>> cells;
  for (const Plant& p : plants) {
    cells.emplace(static_cast<int>(p.x), static_cast<int>(p.y));
    EXPECT_FLOAT_EQ(p.radius, 0.05f * std::min(static_cast<int>(p.x) * 1.0f, 20.0f));
    EXPECT_FLOAT_EQ(p.z, -100 + 10.0f * static_cast<int>(p.x));
    EXPECT_EQ(p.health, 1);
    EXPECT_EQ(p.water, 0);
    EXPECT_EQ(p.age, 0);
  }
  EXPECT_EQ(cells.size(), plants.size()) << "one a cell";
}

TEST_P(PlantSpawning, SeedlingsHaveTheirShareOfTheRoom) {
  PlantBench bench(exec(), 8, 8, {everywhere()});
  bench.parameters.seedling_share = 0.2f;
  bench.terrain.set(Layer::soil, 10);
  bench.live();
  ASSERT_EQ(bench.plants().size(), 64u);
  for (const Plant& p : bench.plants()) EXPECT_FLOAT_EQ(p.radius, 2);
}

TEST_P(PlantSpawning, NeedsMoistureBetweenItsLimits) {
  SpeciesTraits s = everywhere();
  s.moisture_lowest = 0.2f;
  s.moisture_highest = 0.8f;
  expect_only_west(s, [](PlantBench& b) { b.terrain.set(Layer::moisture, east(0.05, 0.15)); });
  expect_only_west(s, [](PlantBench& b) { b.terrain.set(Layer::moisture, east(0.27, 0.15)); });
}

TEST_P(PlantSpawning, StaysOutOfDeepWaterOrInIt) {
  SpeciesTraits s = everywhere();
  s.water_resistance = 0.25f;  // of a stem of 1 m
  expect_only_west(s, [](PlantBench& b) { b.terrain.set(Layer::water, east(0.3, 0.2)); });
  s.water_resistance = 1;
  expect_only_west(s, [](PlantBench& b) { b.terrain.set(Layer::water, east(0.5, 2)); });
}

TEST_P(PlantSpawning, NeedsGroundThatItGrowsIn) {
  SpeciesTraits s = everywhere();
  s.sand = 0;
  expect_only_west(s, [](PlantBench& b) { b.terrain.set(Layer::sand, east(2)); });
}

TEST_P(PlantSpawning, KeepsOffObstacles) {
  expect_only_west(everywhere(), [](PlantBench& b) { b.terrain.set(Layer::obstacle, east(1)); });
}

TEST_P(PlantSpawning, KeepsOffSteepSlopes) {
  SpeciesTraits s = everywhere();
  s.slope = 0.5f;
  const Halves found = halves(s, [](PlantBench& b) {
    b.terrain.set(Layer::bedrock, [](int x, int) { return -100 + 0.7 * std::max(x - 8, 0); });
  });
  EXPECT_EQ(found.west, 128);
  EXPECT_EQ(found.east, 16 * 2) << "at the foot, and beside the edge, where the terrain goes on level";
}

TEST_P(PlantSpawning, KeepsItsDistanceFromItsLikeOnly) {
  SpeciesTraits s = everywhere(), other = undemanding();
  s.separation = 0.25f;
  for (int kind : {0, 1}) {
    PlantBench bench(exec(), 32, 32, {s, other});
    bench.put({{16.5f, 16.5f, 0, 8, 1, 0, 0, kind}});
    bench.cover();
    bench.live();
    int near = 0;
    for (const Plant& p : bench.plants()) near += p.age == 0 && std::hypot(p.x - 16.5f, p.y - 16.5f) < 4;
    EXPECT_EQ(near > 0, kind == 1);
  }
}

TEST_P(PlantSpawning, MoreComeUpAmongTheirLikeAndDownwind) {
  SpeciesTraits s = undemanding();
  s.spawn = 2;
  s.spawn_density = 3;
  s.spawn_wind = 5;
  EXPECT_FLOAT_EQ(plants::weight_of(s, 0, 0), 2);
  EXPECT_FLOAT_EQ(plants::weight_of(s, 0.5f, 0), 2 * 2.5f);
  EXPECT_FLOAT_EQ(plants::weight_of(s, 7, 0.2f), 2 * (1 + 3 + 1));
}

TEST_P(PlantSpawning, WhereThereIsRoomForSomeTheyAreSpreadEvenly) {
  PlantBench bench(exec(), 32, 32, {everywhere()}, 1, true, 64);
  bench.live();
  EXPECT_EQ(bench.work.count, 64);
  int rows[4] = {};
  for (const Plant& p : bench.plants()) ++rows[static_cast<int>(p.y) / 8];
  for (int n : rows) EXPECT_EQ(n, 16);
  bench.live(1, 1);
  EXPECT_EQ(bench.work.count, 64) << "full, and lives on";
}

TEST_P(PlantSpawning, NewPlantsComeFromSeedsThatAreSpreadEvenly) {
  for (long long room : {1, 7, 99, 100, 101}) {
    const long long plants = std::min(room, 100LL);
    int before = -1;
    for (int n = 0; n < plants; ++n) {
      const int seed = plants::seed_of(n, 100, room);
      EXPECT_GT(seed, before) << "plant " << n << " where there is room for " << room;
      EXPECT_EQ((seed + 1) * plants / 100, n + 1);
      before = seed;
    }
    EXPECT_LT(before, 100);
  }
}

TEST_P(PlantSpawning, OtherStepsAndSeedsDrawOtherCells) {
  SpeciesTraits s = undemanding();
  s.spawn = 100;
  const auto places = [&](std::uint64_t step, std::uint64_t seed) {
    PlantBench bench(exec(), 32, 32, {s});
    bench.live(1, step, seed);
    std::vector<float> found;
    for (const Plant& p : bench.plants()) found.push_back(p.x);
    return found;
  };
  EXPECT_EQ(places(3, 1), places(3, 1));
  EXPECT_NE(places(3, 1), places(4, 1));
  EXPECT_NE(places(3, 1), places(3, 2));
  EXPECT_NE(places(3, 1), places(3 + (1ULL << 32), 1));
}

DESERT_ON_EACH_BACKEND(PlantSpawning);

}  // namespace
}  // namespace desert_sim
