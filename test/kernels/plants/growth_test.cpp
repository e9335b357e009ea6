// Laws of growth, health and drinking, one at a time: undemanding plants in full light, but for what is
// tested.

#include "kernels/plants/growth.hpp"

#include <cmath>

#include "test/support/plants.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

using test::Plant;
using test::PlantBench;
using test::undemanding;

class PlantGrowth : public test::OnBackend {
 protected:
  /// What becomes of a plant of radius 1 in a step of a second; `change` sets the scene.
  Plant after(SpeciesTraits s, const std::function<void(PlantBench&)>& change,
              Plant plant = {16.5f, 16.5f, 0, 1}, float dt = 1) {
    s.growth = 0.01f;
    PlantBench bench(exec(), 32, 32, {s});
    bench.put({plant});
    change(bench);
    bench.live(dt);
    const std::vector<Plant> plants = bench.plants();
    return plants.empty() ? Plant{0, 0, 0, 0, 0} : plants[0];
  }
  /// The product of its growth factors.
  double factor(SpeciesTraits s, const std::function<void(PlantBench&)>& change) {
    return (after(s, change).radius - 1) / 0.02;
  }
  /// The sum of damages.
  double damage(SpeciesTraits s, const std::function<void(PlantBench&)>& change,
                Plant plant = {16.5f, 16.5f, 0, 1}) {
    s.damage = 0.125f;
    const Plant left = after(s, change, plant);
    if (left.health < 1) {
      EXPECT_LE(left.radius, plant.radius) << "a damaged plant does not grow";
    }
    return (1 - left.health) / 0.125;
  }
};

TEST_P(PlantGrowth, LightIsBestInTheMiddleOfTheInterval) {
  SpeciesTraits s = undemanding();
  s.light_lowest = 0.5f;
  s.light_highest = 1.5f;
  EXPECT_NEAR(factor(s, [](PlantBench&) {}), 1, 1e-4);
  s.light_highest = 2.5f;
  EXPECT_NEAR(factor(s, [](PlantBench&) {}), 0.5, 1e-4);
  s.light_highest = 1;
  EXPECT_NEAR(factor(s, [](PlantBench&) {}), 0, 1e-4);
  s.light_highest = 0.9f;
  EXPECT_GT(damage(s, [](PlantBench&) {}), 0.49);
}

TEST_P(PlantGrowth, LightIsThatOfTheStemsTop) {
  EXPECT_FLOAT_EQ(plants::light_at(0.2f, 1.0f, 4, 1), 0.4f);
  EXPECT_FLOAT_EQ(plants::light_at(0.2f, 1.0f, 4, 9), 1.0f);
  EXPECT_FLOAT_EQ(plants::light_at(0.2f, 1.0f, 4, -1), 0.2f);
  EXPECT_FLOAT_EQ(plants::light_at(0.2f, 0.3f, 0, 1), 0.2f);
}

TEST_P(PlantGrowth, SlopeHinders) {
  SpeciesTraits s = undemanding();
  s.slope = 0.5f;
  s.root_cover = 0;
  const auto ramp = [](double slope) {
    return [slope](PlantBench& b) {
      b.terrain.set(Layer::bedrock, [slope](int x, int) { return -100 + slope * (x - 16); });
    };
  };
  EXPECT_NEAR(factor(s, ramp(0.25)), 0.5, 1e-3);
  EXPECT_NEAR(factor(s, ramp(0.5)), 0, 1e-3);
  EXPECT_NEAR(damage(s, ramp(0.75)), 0.5, 1e-2);
}

TEST_P(PlantGrowth, GroundCountsByHowWellASpeciesGrowsInIt) {
  SpeciesTraits s = undemanding();
  s.soil = 1;
  s.sand = 0.25f;
  // A metre of roots: the upper 0.4 m in sand, the rest in soil.
  EXPECT_NEAR(factor(s, [](PlantBench& b) { b.terrain.set(Layer::sand, 0.4).set(Layer::soil, 99.6); }),
              0.6 + 0.1, 1e-4);
  // Roots that stand half in the air; they bear it.
  s.root_cover = 0.25f;
  EXPECT_NEAR(factor(s, [](PlantBench& b) { b.terrain.set(Layer::soil, 99.5); }), 0.5, 1e-4);
}

TEST_P(PlantGrowth, RootsFindRoomOnlyAboveTheRock) {
  SpeciesTraits s = undemanding();
  s.root = 2;
  const auto shallow = [](double depth) {
    return [depth](PlantBench& b) { b.terrain.set(Layer::bedrock, -depth).set(Layer::soil, depth); };
  };
  EXPECT_EQ(after(s, shallow(2)).radius, 1) << "just room enough, none to grow";
  EXPECT_NEAR(damage(s, shallow(1)), (1 - 0.55) / 0.55, 1e-3) << "twice too wide";
  s.shrink = 0.25f;
  EXPECT_NEAR(after(s, shallow(1)).radius, 0.75, 1e-6);
  EXPECT_NEAR(after(s, shallow(1.7)).radius, 0.85, 1e-6) << "not below what there is room for";
}

TEST_P(PlantGrowth, OvergrownPlantsAreThoseBeyondTheirShare) {
  SpeciesTraits s = undemanding();
  s.shrink = 0.25f;
  for (const float overgrown : {1.2f, 1.5f}) {
    const auto shallow = [=](PlantBench& b) {
      b.parameters.overgrown = overgrown;
      b.terrain.set(Layer::bedrock, -0.75).set(Layer::soil, 0.75);  // a plant of radius 1 is 4/3 too wide
    };
    EXPECT_EQ(after(s, shallow).radius, overgrown > 1.4f ? 1.0f : 0.75f) << overgrown;
    EXPECT_EQ(after(s, shallow).health < 1, overgrown < 1.3f) << overgrown;
  }
}

TEST_P(PlantGrowth, BuriedStemsAndBareRootsDamage) {
  SpeciesTraits s = undemanding();
  s.stem = 2;
  s.stem_cover = 0.25f;
  s.root_cover = 0.75f;
  const auto ground_at = [](double height) {
    return [height](PlantBench& b) { b.terrain.set(Layer::soil, 100 + height); };
  };
  EXPECT_EQ(damage(s, ground_at(0)), 0);
  EXPECT_EQ(damage(s, ground_at(0.5)), 0) << "a quarter of the stem";
  EXPECT_NEAR(damage(s, ground_at(1.25)), (0.625 - 0.25) / 0.75, 1e-4);
  EXPECT_NEAR(damage(s, ground_at(5)), 1, 1e-4);
  EXPECT_EQ(damage(s, ground_at(-0.25)), 0) << "three quarters of the roots";
  EXPECT_NEAR(damage(s, ground_at(-0.625)), 0.5, 1e-4);
  EXPECT_NEAR(damage(s, ground_at(-3)), 1, 1e-4);
}

TEST_P(PlantGrowth, PlantsFollowTheGround) {
  SpeciesTraits s = undemanding();
  s.root_cover = 0;
  s.position_adjust = 0.125f;
  const auto ground_at = [](double height) {
    return [height](PlantBench& b) { b.terrain.set(Layer::soil, 100 + height); };
  };
  EXPECT_EQ(after(s, ground_at(0.5)).z, 0.125f);
  EXPECT_EQ(after(s, ground_at(-0.5)).z, -0.125f);
  EXPECT_EQ(after(s, ground_at(0.0625)).z, 0.0625f) << "no farther than the ground";
  EXPECT_EQ(after(s, ground_at(0.5), {16.5f, 16.5f, 0, 1}, 0.5f).z, 0.0625f) << "half the time, half the way";
}

TEST_P(PlantGrowth, StandingWaterHindersAndThenDrowns) {
  SpeciesTraits s = undemanding();
  s.water_resistance = 0.5f;
  const auto deep = [](double depth) {
    return [depth](PlantBench& b) { b.terrain.set(Layer::water, depth); };
  };
  EXPECT_NEAR(factor(s, deep(0.125)), 0.75, 1e-4);
  EXPECT_NEAR(damage(s, deep(0.75)), 0.25, 1e-4);
  s.water_resistance = 1;
  EXPECT_NEAR(factor(s, deep(10)), 1, 1e-4) << "a water plant";
  EXPECT_GE(damage(s, deep(0)), 1) << "a water plant on land";
  EXPECT_EQ(after(s, deep(1)).radius, 1) << "no higher than the water";
}

TEST_P(PlantGrowth, WetGroundRots) {
  SpeciesTraits s = undemanding();
  s.moisture_highest = 0.5f;
  // Capacity 0.3 of a metre.
  EXPECT_EQ(damage(s, [](PlantBench& b) { b.terrain.set(Layer::moisture, 0.149); }), 0);
  EXPECT_NEAR(damage(s, [](PlantBench& b) { b.terrain.set(Layer::moisture, 0.225); }), 0.5, 1e-3);
}

TEST_P(PlantGrowth, DeadPlantsLeaveHumus) {
  SpeciesTraits s = undemanding();
  s.damage = 2;
  s.root_cover = 1;
  s.humus = 0.01f;
  PlantBench bench(exec(), 16, 16, {s});
  bench.parameters.litter = 10;
  bench.put({{4.5f, 4.5f, 0, 1}, {10.5f, 4.5f, 3, 1}, {10.6f, 4.4f, 3, 1}});
  bench.live();
  ASSERT_EQ(bench.plants().size(), 1u);
  EXPECT_EQ(bench.plants()[0].x, 4.5f);
  EXPECT_NEAR(bench.terrain.at(Layer::humus, 10, 4), 0.2, 1e-5) << "of two plants";
  EXPECT_EQ(bench.terrain.at(Layer::humus, 4, 4), 0);
}

TEST_P(PlantGrowth, WhoIsNotMatureInTimeDies) {
  SpeciesTraits s = undemanding();
  s.maturity_time = 10;
  s.maturity_share = 0.1f;  // of 20 m
  const auto none = [](PlantBench&) {};
  EXPECT_EQ(after(s, none, {16, 16, 0, 1.9f, 1, 0, 8.5f}).radius > 0, true) << "there is still time";
  EXPECT_EQ(after(s, none, {16, 16, 0, 1.9f, 1, 0, 9.5f}).radius, 0) << "dead";
  EXPECT_GT(after(s, none, {16, 16, 0, 2.1f, 1, 0, 9.5f}).radius, 2) << "mature";
  EXPECT_GT(after(s, none, {16, 16, 0, 1.9f, 1, 0, 30}).radius, 1.9) << "was mature in its time, and shrank";
}

TEST_P(PlantGrowth, HealthRecoversUpToOne) {
  const SpeciesTraits s = undemanding();
  EXPECT_NEAR(after(s, [](PlantBench&) {}, {16, 16, 0, 1, 0.5f}).health, 0.52, 1e-5);
  EXPECT_EQ(after(s, [](PlantBench&) {}, {16, 16, 0, 1, 0.99f}).health, 1);
}

class PlantThirst : public test::OnBackend {
 protected:
  static SpeciesTraits thirsty() {
    SpeciesTraits s = undemanding();
    s.growth = 0.01f;
    s.damage = 0.125f;
    s.water_use = 0.25f;
    s.water_capacity = 0;
    return s;
  }
};

TEST_P(PlantThirst, TakesTheShareOfItsRootsOutOfItsOwnCellAndBooksIt) {
  // Half soaked: 0.5 of the roots' volume is there, 0.25 is needed: half of the moisture.
  PlantBench bench(exec(), 16, 16, {thirsty()});
  bench.parameters.draw = 1;
  bench.terrain.set(Layer::moisture, 0.15);
  bench.put({{4.5f, 4.5f, 0, 1}});
  const long long before = bench.terrain.total(Layer::moisture);
  bench.live();
  EXPECT_NEAR(bench.terrain.at(Layer::moisture, 4, 4), 0.075, 1e-6);
  EXPECT_EQ(bench.terrain.quanta_at(Layer::moisture, 5, 4), bench.terrain.quanta_at(Layer::moisture, 9, 9));
  EXPECT_EQ(before - bench.terrain.total(Layer::moisture), bench.terrain.booked(Material::moisture, 1));
  EXPECT_EQ(bench.terrain.booked(Material::moisture, 0), 0);
  // Twice the need is about the roots: the best there is.
  EXPECT_NEAR(bench.plants()[0].radius, 1.02, 1e-5);
}

TEST_P(PlantThirst, ASmallPlantTakesFromThePartOfTheCellThatItCovers) {
  PlantBench bench(exec(), 16, 16, {thirsty()}, 4);
  bench.parameters.draw = 0.5f;
  bench.terrain.set(Layer::moisture, 0.15);
  bench.put({{18, 18, 0, 1}});
  bench.live();
  EXPECT_NEAR(bench.terrain.at(Layer::moisture, 4, 4), 0.15 - 0.5 * 0.075 * 3.14159 / 16, 1e-6);
}

TEST_P(PlantThirst, LessThanItNeedsIsDamage) {
  PlantBench bench(exec(), 16, 16, {thirsty()});
  bench.terrain.set(Layer::moisture, 0.3 / 8);  // half of what is needed
  bench.put({{4.5f, 4.5f, 0, 1}});
  bench.live();
  EXPECT_EQ(bench.plants()[0].radius, 1);
  EXPECT_NEAR(bench.plants()[0].health, 1 - 0.125 * 0.5, 1e-5);
}

TEST_P(PlantThirst, StoresWaterAndLivesOnIt) {
  SpeciesTraits s = thirsty();
  s.water_capacity = 0.25f;
  PlantBench bench(exec(), 16, 16, {s});
  const double volume = 2.0943951;
  bench.terrain.set(Layer::moisture, 0.3);
  bench.put({{4.5f, 4.5f, 0, 1}});
  bench.live();
  EXPECT_NEAR(bench.plants()[0].water, 0.25 * 2 * volume, 1e-4) << "full";
  const double need = 0.25 * volume * std::pow(bench.plants()[0].radius, 3);
  bench.terrain.set(Layer::moisture, 0);
  bench.live();
  EXPECT_NEAR(bench.plants()[0].water, 0.5 * volume - need, 1e-4);
  EXPECT_EQ(bench.plants()[0].health, 1);
}

TEST_P(PlantThirst, ManyInACellNeverTakeMoreThanThereIs) {
  PlantBench bench(exec(), 8, 8, {thirsty()});
  bench.parameters.draw = 1;
  bench.terrain.set_quanta(Layer::moisture, [](int x, int y) { return x == 4 && y == 4 ? 60001 : 0; });
  std::vector<Plant> plants;
  for (int n = 0; n < 37; ++n) plants.push_back({4.0f + 0.026f * n, 4.5f, 0, 0.7f + 0.01f * n});
  bench.put(plants);
  bench.live();
  const Quanta left = bench.terrain.quanta_at(Layer::moisture, 4, 4);
  EXPECT_GE(left, 0);
  EXPECT_LT(left, 37) << "all but what rounding leaves";
  EXPECT_EQ(bench.terrain.booked(Material::moisture, 1), 60001 - left);
}

/// Less than a quantum a step is taken on average: seedlings took a whole quantum each step, 100 times what
/// they need.
TEST_P(PlantThirst, ADropIsNeitherFreeNorAQuantum) {
  SpeciesTraits s = thirsty();
  s.growth = 0;
  s.water_use = 0.01f;
  PlantBench bench(exec(), 8, 8, {s});
  bench.terrain.set(Layer::moisture, 0.15);
  std::vector<Plant> seedlings;
  for (int n = 0; n < 64; ++n)
    seedlings.push_back({static_cast<float>(n % 8) + 0.5f, static_cast<float>(n / 8) + 0.5f, 0, 0.01f});
  bench.put(seedlings);
  constexpr int steps = 500;
  for (int n = 0; n < steps; ++n) bench.live();
  const double needed = 0.01 * s.stem / (0.5 * s.root);  // as a share of what the roots can reach
  const double expected = steps * 64 * bench.parameters.draw * 3.14159e-4 * 0.15 * 1048576 * needed;
  EXPECT_GT(expected, 100);
  EXPECT_NEAR(static_cast<double>(bench.terrain.booked(Material::moisture, 1)) / expected, 1, 0.3);
}

DESERT_ON_EACH_BACKEND(PlantGrowth);
DESERT_ON_EACH_BACKEND(PlantThirst);

}  // namespace
}  // namespace desert_sim
