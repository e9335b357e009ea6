// A living population, over many steps: the same bits whatever the threads, through a checkpoint, after a
// reset; exact books; and plants that do to wind and sand what they should.

#include <algorithm>
#include <random>

#include "src/simulation/checkpoint.hpp"
#include "src/simulation/session.hpp"
#include "test/support/plants.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

/// Wet ground with ponds under a breeze; bushes, seaweed and palms that come up, grow, drink and die.
const char* const garden =
    "grid: {width: 90, height: 70, cell_size: 1.5, boundary: open}\n"
    "terrain:\n"
    "  - noise: {layer: bedrock, low: 0, high: 4, scale: 40}\n"
    "  - noise: {layer: soil, low: 0.5, high: 3, scale: 20, seed: 2}\n"
    "  - noise: {layer: sand, low: 0, high: 2, scale: 20, threshold: 0.5, seed: 3}\n"
    "  - noise: {layer: moisture, low: 0.01, high: 0.25, scale: 30, seed: 4}\n"
    "  - noise: {layer: water, low: 0, high: 5, scale: 30, threshold: 0.7, seed: 5}\n"
    "wind: {speed: 4, direction_deg: 20}\n"
    "vegetation: {enabled: true}\n"
    "species:\n"
    "  - {preset: bush, light_highest: 2, moisture_lowest: 0.02, spawn: 4, spawn_density: 1000, growth: "
    "0.3}\n"
    "  - {preset: seaweed, spawn: 5}\n"
    "  - {preset: palm, moisture_lowest: 0.02, spawn: 2, growth: 0.2}\n";

class Garden : public test::OnBackend {};

TEST_P(Garden, GrowsAndDiesAndKeepsItsBooks) {
  auto s = simulation(garden);
  int most = 0;
  for (int n = 0; n < 12; ++n) {
    test::run(*s, 10);
    test::expect_sound(*s, "at step " + std::to_string(s->steps()));
    most = std::max(most, s->state().plants.count);
  }
  EXPECT_GT(most, 100);
  const auto counts = s->state().plant_counts();
  ASSERT_EQ(counts.size(), 3u);
  int all = 0;
  for (const PlantCount& c : counts) {
    EXPECT_GT(c.plants, 0) << c.species;
    all += c.plants;
  }
  EXPECT_EQ(all, s->state().plants.count);
  EXPECT_GT(counts[0].mature, 0);
  const auto balance = s->state().balance()[static_cast<std::size_t>(Material::moisture)];
  EXPECT_GT(balance.out, 0) << "plants drank";
  EXPECT_EQ(balance.in, 0);
}

TEST_P(Garden, IsTheSameThroughACheckpoint) {
  const test::TemporaryFolder folder;
  auto whole = simulation(garden), half = simulation(garden);
  test::run(*whole, 80);
  test::run(*half, 40);
  ASSERT_GT(half->state().plants.count, 50);
  save_checkpoint(folder.path("half.ck"), *half);
  auto resumed = load_checkpoint(folder.path("half.ck"), exec());
  EXPECT_EQ(resumed->state().hash(), half->state().hash());
  EXPECT_EQ(plants::words(resumed->state().plants), plants::words(half->state().plants));
  resumed->views().snapshot(resumed->state().layers_in_use());
  EXPECT_EQ(resumed->state().hash(), half->state().hash()) << "a look changes nothing";
  test::run(*resumed, 40);
  EXPECT_EQ(resumed->state().hash(), whole->state().hash());
  EXPECT_EQ(plants::words(resumed->state().plants), plants::words(whole->state().plants));
}

TEST(GardenOf, TheHashDoesNotDependOnTheNumberOfThreads) {
  CpuExec one(1), three(3);
  auto a = test::simulate(one, garden), b = test::simulate(three, garden);
  for (int n = 0; n < 4; ++n) {
    test::run(*a, 10);
    test::run(*b, 10);
    EXPECT_EQ(a->state().hash(), b->state().hash()) << a->steps();
  }
  EXPECT_GT(a->state().plants.count, 50);
}

TEST(GardenOf, TheHashIsOfThePlantsToo) {
  CpuExec exec(1);
  const std::string still =
      "grid: {width: 16, height: 16}\nterrain: [uniform: {layer: soil, value: 3}]\nwind: {speed: 0}\n"
      "vegetation: {enabled: true, draw: 0}\nspecies: [{name: a, light_highest: 2, moisture_lowest: 0, "
      "water_use: 0, ";
  auto a = test::simulate(exec, still + "spawn: 20, humus: 0}]\n"),
       b = test::simulate(exec, still + "spawn: 40, humus: 0}]\n");
  a->step();
  b->step();
  ASSERT_NE(a->state().plants.count, b->state().plants.count);
  EXPECT_NE(a->state().hash(), b->state().hash());
}

TEST(GardenOf, AResetBeginsAnew) {
  Session session(test::scenario_of(garden), no_raster_loader, "cpu", 1);
  const std::uint64_t start = session.simulation().state().hash();
  for (int n = 0; n < 20; ++n) session.step();
  ASSERT_GT(session.simulation().state().plants.count, 0);
  session.apply(command::Reset{});
  EXPECT_EQ(session.simulation().state().plants.count, 0);
  EXPECT_EQ(session.simulation().state().hash(), start);
}

TEST(GardenOf, MemoryIsWhatWasPlanned) {
  CpuExec exec(1);
  const Scenario scenario = test::scenario_of(garden);
  Simulation s(exec, scenario, no_raster_loader);
  std::size_t held = 0;
  for (const MemoryPart& part : s.memory())
    if (part.name == "plants") held = part.bytes;
  EXPECT_GT(held, std::size_t{90} * 70 * 64);
  test::run(s, 20);
  for (const MemoryPart& part : s.memory())
    if (part.name == "plants") {
      EXPECT_EQ(part.bytes, held) << "a step allocates nothing";
    }
}

TEST_P(Garden, TheOrderInWhichPlantsAreGivenDoesNotMatter) {
  std::mt19937 random(9);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<test::Plant> plants;
  for (int n = 0; n < 200; ++n)
    plants.push_back(
        {uniform(random) * 40, uniform(random) * 40, 0, 0.1f + 3 * uniform(random), 1, 0, 0, n % 2});
  const auto lived = [&] {
    SpeciesTraits s = test::undemanding();
    s.water_use = 0.1f;
    s.humus = 0.01f;
    test::PlantBench b(exec(), 40, 40, {s, s});
    b.terrain.set(Layer::moisture, 0.2);
    b.put(plants);
    for (std::uint64_t n = 0; n < 5; ++n) b.step(1, n);
    std::vector<test::Plant> found = b.plants();
    std::sort(found.begin(), found.end(), [](const auto& p, const auto& q) { return p.x < q.x; });
    return found;
  };
  const std::vector<test::Plant> first = lived();
  std::shuffle(plants.begin(), plants.end(), random);
  const std::vector<test::Plant> second = lived();
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t n = 0; n < first.size(); ++n) {
    EXPECT_EQ(first[n].x, second[n].x);
    EXPECT_NEAR(first[n].radius, second[n].radius, 1e-4);  // sums round by order
    EXPECT_NEAR(first[n].health, second[n].health, 1e-4);
    EXPECT_NEAR(first[n].water, second[n].water, 1e-3);
  }
}

TEST_P(Garden, MovesWithItsTorus) {
  // The same plants, moved by whole look-up cells over the border: what they do to each other is the same.
  const auto radii = [&](float shift) {
    SpeciesTraits s = test::undemanding();
    test::PlantBench b(exec(), 80, 80, {s});
    std::mt19937 random(9);
    std::uniform_real_distribution<float> uniform(0, 1);
    std::vector<test::Plant> plants;
    for (int n = 0; n < 150; ++n) {
      const float x = uniform(random) * 64, y = uniform(random) * 64;
      plants.push_back({std::fmod(std::floor(x * 64) / 64 + shift, 80.0f),
                        std::fmod(std::floor(y * 64) / 64 + shift, 80.0f), 0, 0.1f + 6 * uniform(random), 1,
                        0, static_cast<float>(n)});
    }
    b.put(plants);
    b.live();
    std::vector<float> found(150, 0);
    for (const test::Plant& p : b.plants()) found[static_cast<std::size_t>(p.age) - 1] = p.radius;
    return found;
  };
  const std::vector<float> here = radii(0), there = radii(40);
  for (std::size_t n = 0; n < here.size(); ++n) EXPECT_NEAR(here[n], there[n], 1e-5) << n;
}

TEST_P(Garden, CanopiesBlockTheWind) {
  const std::string yaml =
      "grid: {width: 64, height: 48}\nterrain: [uniform: {layer: soil, value: 20}]\n"
      "wind: {speed: 5, direction_deg: 0, warping: false, projection: false}\nsaltation: {enabled: false}\n"
      "species: [{preset: tree, light_highest: 2, moisture_lowest: 0, water_use: 0, spawn: 3, growth: 2}]\n";
  auto with = simulation(yaml + "vegetation: {enabled: true}\n");
  auto without = simulation(yaml + "vegetation: {enabled: true, canopy_shadow: false}\n");
  test::run(*with, 6);
  test::run(*without, 6);
  ASSERT_GT(with->state().plants.count, 3);
  const auto shaded = [](Simulation& s) {
    const std::vector<float> shadow = test::real(s, Layer::wind_shadow);
    return std::count_if(shadow.begin(), shadow.end(), [](float v) { return v > 0.5f; });
  };
  EXPECT_GT(shaded(*with), 50);
  EXPECT_EQ(shaded(*without), 0);
}

TEST_P(Garden, ADesertWithoutPlantsHasNoneOfTheirLayers) {
  auto s = simulation("grid: {width: 16, height: 16}\nspecies: [{preset: tree}]\n");
  s->step();
  for (Layer layer : {Layer::canopy_height, Layer::illumination, Layer::illumination_canopy,
                      Layer::vegetation, Layer::humus})
    EXPECT_FALSE(s->terrain().has(layer));
  EXPECT_TRUE(s->state().plant_counts().empty());
}

DESERT_ON_EACH_BACKEND(Garden);

}  // namespace
}  // namespace desert_sim
