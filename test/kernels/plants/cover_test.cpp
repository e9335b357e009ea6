// What plants are to the terrain: density, canopy, humus, seeds downwind, light.

#include <cmath>
#include <random>

#include "test/support/plants.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

using test::Plant;
using test::PlantBench;
using test::undemanding;

class PlantCover : public test::OnBackend {
 protected:
  static float species_map(const Buffer<float>& map, const PlantBench& b, int species, int x, int y) {
    return map.download()[static_cast<std::size_t>(species * b.terrain.grid().cells() +
                                                   b.terrain.grid().index(x, y))];
  }
};

/// Plants of all sizes at random places.
std::vector<Plant> thicket(float extent_x, float extent_y, int count, int species) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<Plant> plants;
  for (int n = 0; n < count; ++n) {
    const float size = uniform(random);
    plants.push_back({uniform(random) * extent_x, uniform(random) * extent_y, uniform(random) - 0.5f,
                      0.05f + 19.9f * size * size * size, 1, 0, 0, n % species});
  }
  return plants;
}

float difference(float a, float b, float extent, bool periodic) {
  const float d = a - b;
  return periodic ? d - extent * std::round(d / extent) : d;
}

/// The look-up knew no plants of more than 20 m.
TEST_P(PlantCover, ReachesAsFarAsTheLargestPlant) {
  for (const float largest : {20.0f, 40.0f}) {
    SpeciesTraits s = undemanding();
    s.max_radius = 40;
    PlantBench b(exec(), 400, 4, {s});
    b.work = plants::make_workspace(exec(), b.terrain.grid(), 4, largest, {s}, {1});
    b.put({{119.5f, 2.5f, 0, 36}});
    b.cover();
    EXPECT_EQ(b.terrain.at(Layer::vegetation, 150, 2) > 0, largest > 36) << largest;
  }
}

/// Every plant is asked, wherever it stands.
TEST_P(PlantCover, IsWhatAllPlantsTogetherGive) {
  for (bool periodic : {true, false}) {
    SpeciesTraits low = undemanding(), high = undemanding();
    low.root = 0.4f;
    high.stem = 3;
    PlantBench b(exec(), 70, 90, {low, high}, 1.3, periodic);
    const float extent_x = 70 * 1.3f, extent_y = 90 * 1.3f;
    const std::vector<Plant> plants = thicket(extent_x, extent_y, 60, 2);
    b.put(plants);
    b.cover();
    double worst_density = 0, worst_canopy = 0;
    for (int y = 0; y < 90; ++y)
      for (int x = 0; x < 70; ++x) {
        float sum = 0, canopy = 0;
        for (const Plant& p : plants) {
          const float dx = difference((x + 0.5f) * 1.3f, p.x, extent_x, periodic),
                      dy = difference((y + 0.5f) * 1.3f, p.y, extent_y, periodic);
          const SpeciesTraits& s = p.species ? high : low;
          const float d = plants::density_at(dx * dx + dy * dy, -p.z, p.radius, s.stem, s.root);
          sum += d;
          canopy = std::max(canopy, p.radius * s.stem * d);
        }
        worst_density = std::max(worst_density,
                                 std::abs(b.terrain.at(Layer::vegetation, x, y) - std::min(sum, 1.0f)) + 0.0);
        worst_canopy =
            std::max(worst_canopy, std::abs(b.terrain.at(Layer::canopy_height, x, y) - canopy) + 0.0);
      }
    EXPECT_LT(worst_density, 1e-4) << (periodic ? "periodic" : "open");
    EXPECT_LT(worst_canopy, 1e-3) << (periodic ? "periodic" : "open");
  }
}

TEST_P(PlantCover, BuriedAndUprootedPlantsFadeByStemAndRoot) {
  SpeciesTraits s = undemanding();
  s.stem = 2;
  s.root = 0.5f;
  for (const auto& [height, expected] :
       {std::pair{0.0, 1.0}, {2.0, std::exp(-0.5)}, {-0.5, std::exp(-0.5)}, {-1.0, std::exp(-2)}}) {
    PlantBench b(exec(), 32, 32, {s});
    b.put({{16.5f, 16.5f, 0, 2}});
    b.terrain.set(Layer::soil, 100 + height);
    b.cover();
    EXPECT_NEAR(b.terrain.at(Layer::vegetation, 16, 16), expected, 1e-5) << height;
    EXPECT_NEAR(b.terrain.at(Layer::canopy_height, 16, 16), 4 * expected, 1e-4) << height;
  }
}

TEST_P(PlantCover, HumusGrowsWithDensityUpToItsLimit) {
  SpeciesTraits s = undemanding();
  s.humus = 0.01f;
  PlantBench b(exec(), 32, 32, {s});
  b.parameters.humus_limit = 0.03f;
  b.put({{16.5f, 16.5f, 0, 4}});
  b.cover(2);
  EXPECT_NEAR(b.terrain.at(Layer::humus, 16, 16), 0.02, 1e-6);
  EXPECT_NEAR(b.terrain.at(Layer::humus, 18, 16), 0.02 * 0.539, 1e-5);
  b.cover(2);
  EXPECT_NEAR(b.terrain.at(Layer::humus, 16, 16), 0.03, 1e-6);
  EXPECT_NEAR(b.terrain.at(Layer::humus, 18, 16), 0.04 * 0.539, 1e-5);
}

TEST_P(PlantCover, ALookLeavesTheStateAlone) {
  SpeciesTraits s = undemanding();
  s.humus = 0.01f;
  PlantBench b(exec(), 32, 32, {s});
  b.put({{16.5f, 16.5f, 0, 4}});
  b.cover(1, false);
  EXPECT_EQ(b.terrain.at(Layer::vegetation, 16, 16), 0);
  EXPECT_EQ(b.terrain.total(Layer::humus), 0);
  EXPECT_GT(b.terrain.at(Layer::canopy_height, 16, 16), 0);
}

TEST_P(PlantCover, SeedsComeFromMaturePlantsAndDownwind) {
  SpeciesTraits s = undemanding();
  s.max_radius = 10;
  s.maturity_share = 0.3f;
  PlantBench b(exec(), 64, 64, {s, s});
  b.terrain.set(Layer::wind_x, 5);
  b.put({{32.5f, 32.5f, 0, 8, 1, 0, 0, 1}, {12.5f, 32.5f, 0, 2.9f, 1, 0, 0, 1}});
  b.cover();
  const auto& work = b.work;
  EXPECT_NEAR(species_map(work.density, b, 1, 36, 32), 0.539, 1e-3);
  EXPECT_EQ(species_map(work.density, b, 0, 36, 32), 0) << "another species";
  EXPECT_EQ(species_map(work.density, b, 1, 12, 32), 0) << "not mature";
  EXPECT_NEAR(species_map(work.downwind, b, 1, 36, 32), 0.6, 1e-4) << "4 m straight downwind of 10";
  EXPECT_NEAR(species_map(work.downwind, b, 1, 35, 36), 0.6 * 0.5, 1e-4) << "5 m away, at 53 degrees";
  EXPECT_EQ(species_map(work.downwind, b, 1, 28, 32), 0) << "upwind";
  EXPECT_EQ(species_map(work.downwind, b, 1, 32, 32), 0) << "on the spot";
  EXPECT_EQ(species_map(work.downwind, b, 1, 42, 32), 0) << "out of its reach";
}

class PlantLight : public test::OnBackend {};

TEST_P(PlantLight, IsOneInTheOpen) {
  PlantBench b(exec(), 24, 24, {undemanding()});
  b.cover();
  b.illuminate();
  for (Layer layer : {Layer::illumination, Layer::illumination_canopy})
    for (float light : b.terrain.terrain.values(layer)) EXPECT_FLOAT_EQ(light, 1);
}

TEST_P(PlantLight, ComesFromTheSouth) {
  // A wall along x: dim north of it, the nearer the dimmer, and full light south of it.
  PlantBench b(exec(), 24, 24, {undemanding()}, 1, false);
  b.terrain.set(Layer::bedrock, [](int, int y) { return y == 12 ? -98 : -100; });
  b.cover();
  b.illuminate();
  const auto light = [&](int y) { return b.terrain.at(Layer::illumination, 12, y); };
  EXPECT_LT(light(13), 0.9);
  EXPECT_LT(light(13), light(14));
  EXPECT_LT(light(14), light(15));
  EXPECT_FLOAT_EQ(light(16), 1) << "too far";
  for (int y = 8; y < 12; ++y) EXPECT_FLOAT_EQ(light(y), 1) << "on the sunny side";
  b.parameters.light_deg = -90;
  b.illuminate();
  EXPECT_FLOAT_EQ(light(13), 1);
  EXPECT_LT(light(11), 0.9);
}

TEST_P(PlantLight, FollowsTheEquation) {
  // One rise of 2 m, at o = (0, 1) and (1, 1) of two cells of half a metre.
  PlantBench b(exec(), 24, 24, {undemanding()}, 0.5, false);
  b.terrain.set(Layer::soil, [](int x, int y) { return x == 12 && y == 12 ? 102 : 100; });
  b.cover();
  b.illuminate();
  const auto expected = [](double straight, double distance) {
    const double e = std::exp(-2 * 0.5 * straight / (distance * distance) * 2 / distance);
    return 2 * (48 + e) / 49 - 1;
  };
  EXPECT_NEAR(b.terrain.at(Layer::illumination, 12, 13), expected(1, 0.5), 1e-6);
  EXPECT_NEAR(b.terrain.at(Layer::illumination, 13, 13), expected(1, 0.5 * std::sqrt(2)), 1e-6);
  EXPECT_NEAR(b.terrain.at(Layer::illumination, 11, 15), expected(3, 0.5 * std::sqrt(10)), 1e-6);
  EXPECT_FLOAT_EQ(static_cast<float>(b.terrain.at(Layer::illumination, 13, 12)), 1);
}

TEST_P(PlantLight, CanopiesShadeTheGroundAndStandInTheLight) {
  SpeciesTraits s = undemanding();
  s.stem = 3;
  PlantBench b(exec(), 48, 48, {s});
  b.put({{24.5f, 24.5f, 0, 6}});
  b.cover();
  b.illuminate();
  EXPECT_LT(b.terrain.at(Layer::illumination, 24, 26), 0.8);
  EXPECT_GT(b.terrain.at(Layer::illumination_canopy, 24, 24), 0.99) << "at the top";
  EXPECT_GT(b.terrain.at(Layer::illumination_canopy, 24, 26), b.terrain.at(Layer::illumination, 24, 26));
}

TEST_P(PlantLight, FadesUnderWater) {
  PlantBench b(exec(), 16, 16, {undemanding()});
  b.parameters.light_decay = 0.25f;
  b.terrain.set(Layer::water, [](int x, int) { return x == 8 ? 4.0 : 0.0; });
  b.cover();
  b.illuminate();
  EXPECT_NEAR(b.terrain.at(Layer::illumination, 8, 8), std::exp(-1), 1e-5);
  EXPECT_NEAR(b.terrain.at(Layer::illumination_canopy, 8, 8), std::exp(-1), 1e-5);
  EXPECT_FLOAT_EQ(static_cast<float>(b.terrain.at(Layer::illumination, 9, 8)), 1);
}

DESERT_ON_EACH_BACKEND(PlantCover);
DESERT_ON_EACH_BACKEND(PlantLight);

}  // namespace
}  // namespace desert_sim
