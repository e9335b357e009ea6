// What the model of plants says in closed form: density, free growth, competition, spawning.

#include <cmath>

#include "test/support/plants.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

using test::Plant;
using test::PlantBench;
using test::undemanding;

class PlantTheory : public test::OnBackend {};

TEST_P(PlantTheory, DensityFallsFromOneToZeroAtTheRadius) {
  // Radius 8.5 and a plant half a cell east of a cell's corner: cells lie at whole metres from it.
  PlantBench bench(exec(), 64, 64, {undemanding()});
  bench.put({{32.5f, 32.5f, 0, 8}});
  bench.cover();
  const double expected[] = {1, 0.849, 0.539, 0.223, 0};
  for (int n = 0; n <= 4; ++n) {
    EXPECT_NEAR(bench.terrain.at(Layer::vegetation, 32 + 2 * n, 32), expected[n], 5e-4) << n << " / 4";
    EXPECT_NEAR(bench.terrain.at(Layer::vegetation, 32, 32 - 2 * n), expected[n], 5e-4) << n << " / 4";
  }
  EXPECT_EQ(bench.terrain.at(Layer::vegetation, 40, 32), 0) << "exactly 0 at its own radius";
  EXPECT_EQ(bench.terrain.at(Layer::vegetation, 24, 32), 0);
  EXPECT_EQ(bench.terrain.at(Layer::vegetation, 45, 32), 0);
}

TEST_P(PlantTheory, DensityIntegratesToItsShareOfTheSquare) {
  for (float radius : {2.3f, 4.7f, 9.1f, 19.6f}) {
    PlantBench bench(exec(), 400, 400, {undemanding()}, 0.125 * radius / 2.3);
    const float extent = bench.terrain.grid().width * bench.terrain.grid().cell_size;
    bench.put({{0.503f * extent, 0.498f * extent, 0, radius}});
    bench.cover();
    double sum = 0;
    for (float v : bench.terrain.terrain.values(Layer::vegetation)) sum += v;
    const double cell = bench.terrain.grid().cell_size;
    EXPECT_NEAR(sum * cell * cell / (radius * radius), 1.0748, 2e-3) << radius;
  }
}

TEST_P(PlantTheory, FreeGrowthIsLinearInTime) {
  SpeciesTraits s = undemanding();
  s.growth = 0.05f;
  s.spawn = 0;
  PlantBench bench(exec(), 64, 64, {s});
  const float start = 0.05f * s.max_radius, dt = 0.1f;
  bench.put({{20, 20, 0, start}});
  for (int n = 1; n <= 100; ++n) {
    bench.live(dt, static_cast<std::uint64_t>(n));
    if (n % 20 != 0) continue;
    // Needs no water: twice as quick; ground of soil alone, flat, in the light: all other factors are 1.
    EXPECT_NEAR(bench.plants()[0].radius, start + 0.05 * 2 * n * dt, 1e-4) << n;
    EXPECT_NEAR(bench.plants()[0].age, n * dt, 1e-4);
  }
}

TEST_P(PlantTheory, GrowthStopsAtTheWidestRadius) {
  SpeciesTraits s = undemanding();
  s.max_radius = 2;
  s.growth = 1;
  PlantBench bench(exec(), 32, 32, {s});
  bench.put({{16, 16, 0, 0.1f}});
  for (std::uint64_t n = 0; n < 50; ++n) bench.live(0.1f, n);
  EXPECT_EQ(bench.plants()[0].radius, 2.0f);
}

TEST_P(PlantTheory, CompetitionOfTwoEqualPlants) {
  // g = 0, 0.75, 1 at a distance of 0, r and 2 r; r is far below what could stop growth.
  for (const auto& [distance, factor] : {std::pair{0.0f, 0.0f}, {1.0f, 0.75f}, {2.0f, 1.0f}, {3.0f, 1.0f}}) {
    SpeciesTraits s = undemanding();
    s.growth = 0.01f;
    PlantBench bench(exec(), 64, 64, {s});
    bench.put({{30, 30, 0, 1}, {30 + distance, 30, 0, 1}});
    bench.live(1);
    for (const Plant& plant : bench.plants()) EXPECT_NEAR(plant.radius, 1 + 0.02 * factor, 1e-5) << distance;
  }
}

TEST_P(PlantTheory, TheCompetitionMatrixSaysWhoHindersWhom) {
  SpeciesTraits s = undemanding();
  s.growth = 0.01f;
  PlantBench bench(exec(), 64, 64, {s, s}, 1, true, 0, {1, 0.5f, 0, 1});
  bench.put({{30, 30, 0, 1, 1, 0, 0, 0}, {31, 30, 0, 1, 1, 0, 0, 1}});
  bench.live(1);
  for (const Plant& plant : bench.plants())
    EXPECT_NEAR(plant.radius, 1 + 0.02 * (plant.species == 0 ? 1 - 0.125 : 1), 1e-5) << plant.species;
}

TEST_P(PlantTheory, SpawningIsABernoulliTrialACell) {
  // Σp = 3 a second over 60 s: 180 plants, within the bounds of 99.9 %. They never grow, so that none
  // hinders.
  SpeciesTraits one = undemanding(), two = undemanding();
  one.spawn = 2;
  two.spawn = 1;
  for (SpeciesTraits* s : {&one, &two}) {
    s->growth = 0;
    s->spawn_density = s->spawn_wind = 0;
    s->separation = 10;
  }
  PlantBench bench(exec(), 256, 256, {one, two}, 4);
  for (std::uint64_t n = 0; n < 600; ++n) bench.live(0.1f, n);
  const std::vector<Plant> plants = bench.plants();
  EXPECT_GE(plants.size(), 138u);
  EXPECT_LE(plants.size(), 226u);
  int first = 0;
  for (const Plant& plant : plants) first += plant.species == 0;
  // Two thirds are of the first; four standard deviations of 120.
  EXPECT_NEAR(first, plants.size() * 2.0 / 3.0, 4 * std::sqrt(plants.size() * 2.0 / 9.0));
}

TEST(PlantTheoryOf, EventsAreAsManyASecondWhateverTheTimeStep) {
  constexpr int draws = 100000;
  for (double q : {0.0, 3e-3, 0.2, 0.9, 1.0})
    for (double dt : {0.01, 0.1, 1.0, 2.5}) {
      double events = 0;
      for (int n = 0; n < draws; ++n) events += plants::number_of_events(q, dt, (n + 0.5) / draws);
      EXPECT_NEAR(events / draws, q * dt, 1.0 / draws) << q << " a second, steps of " << dt << " s";
    }
}

/// With the published probability 1 − (1 − q)^Δt of one plant a cell and step, there were 100 times as many
/// plants in steps of 0.01 s as in steps of 1 s where q = 1, and half as many in steps of 2 s.
TEST_P(PlantTheory, AsManyPlantsComeUpWhateverTheTimeStep) {
  for (double q : {0.1, 1.0})
    for (double dt : {2.5, 2.0, 1.0, 0.5, 0.1, 0.01}) {
      SpeciesTraits s = undemanding();
      s.growth = 0;
      s.spawn = static_cast<float>(q * 20 * 20);
      s.spawn_density = s.spawn_wind = 0;
      s.separation = 10;
      PlantBench bench(exec(), 20, 20, {s}, 1, true, 1 << 13);
      const int steps = static_cast<int>(std::lround(10 / dt));
      for (int n = 0; n < steps; ++n) bench.live(static_cast<float>(dt), static_cast<std::uint64_t>(n));
      const double expected = q * 20 * 20 * 10;
      EXPECT_NEAR(bench.work.count, expected, 4 * std::sqrt(expected))
          << q << " a second, steps of " << dt << " s";
    }
}

DESERT_ON_EACH_BACKEND(PlantTheory);

}  // namespace
}  // namespace desert_sim
