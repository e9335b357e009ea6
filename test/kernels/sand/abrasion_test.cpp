// Abrasion, by hand: bouncing sand wears rock or soil where sand does not cover it.

#include "test/support/bench_terrain.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

constexpr double rock_quantum = 1.0 / 1048576;

class AbrasionLaw : public test::OnBackend {
 protected:
  std::unique_ptr<test::BenchTerrain> worn(const std::function<void(test::BenchTerrain&)>& change,
                                           float rate = 0.01f, float dt = 1, float soil_rate = -1,
                                           float moisture_cutoff = 0.5f) {
    auto t = std::make_unique<test::BenchTerrain>(exec(), 1, 1);
    t->set(Layer::airborne_sand, 0.5).set(Layer::wind_x, 2 / dt).set(Layer::bedrock, 100);
    change(*t);
    SaltationParameters p;
    p.lift = 0;
    p.bounce_on_rock = p.bounce_on_soil = p.bounce_on_sand = 0.98f;
    AbrasionParameters a;
    a.rate = rate;
    a.soil_rate = soil_rate;
    a.moisture_cutoff = moisture_cutoff;
    t->saltation(p, a, {}, dt);
    return t;
  }
};

// Little is deposited, so that it does not cover: p = 0.02, 0.49 m of 0.5 m bounces; wear = rate·|w|·(1 −
// p)·0.49.
TEST_P(AbrasionLaw, WearsBareRockByTheBouncingSand) {
  const auto t = worn([](test::BenchTerrain&) {});
  const double expected = 0.01 * 2 * 0.98 * 0.49;
  EXPECT_NEAR(t->booked(Material::bedrock, 1) * rock_quantum, expected, 2 * rock_quantum);
  EXPECT_EQ(t->booked(Material::bedrock, 1), t->booked(Material::sand, 0));
  EXPECT_NEAR(t->at(Layer::sand, 0, 0), 0.01 + expected, 2 * rock_quantum);
  EXPECT_NEAR(t->at(Layer::bedrock, 0, 0), 100 - expected, 1e-5);
}

TEST_P(AbrasionLaw, IsNothingWithoutWindRateOrBouncingSand) {
  EXPECT_EQ(worn([](test::BenchTerrain& t) { t.set(Layer::wind_x, 0); })->booked(Material::bedrock, 1), 0);
  EXPECT_EQ(worn([](test::BenchTerrain&) {}, 0.0f)->booked(Material::bedrock, 1), 0);
  EXPECT_EQ(worn([](test::BenchTerrain& t) { t.set(Layer::wind_shadow, 1); })->booked(Material::bedrock, 1),
            0);
  EXPECT_EQ(worn([](test::BenchTerrain& t) { t.set(Layer::vegetation, 1); })->booked(Material::bedrock, 1),
            0);
  EXPECT_EQ(
      worn([](test::BenchTerrain& t) { t.set(Layer::erosion_resistance, 1); })->booked(Material::bedrock, 1),
      0);
}

TEST_P(AbrasionLaw, ScalesWithResistance) {
  const auto half = worn([](test::BenchTerrain& t) { t.set(Layer::erosion_resistance, 0.5); });
  const auto none = worn([](test::BenchTerrain&) {});
  EXPECT_NEAR(half->booked(Material::bedrock, 1), 0.5 * none->booked(Material::bedrock, 1), 2);
}

TEST_P(AbrasionLaw, CoverProtects) {
  // What was deposited (0.2 m) would cover; so take away the deposit by a bounce of 1.
  SaltationParameters p;
  p.lift = 0;
  p.bounce_on_rock = p.bounce_on_sand = 1;
  AbrasionParameters a;
  a.rate = 0.01f;
  for (double sand : {0.0, 0.0249, 0.0251}) {
    test::BenchTerrain t(exec(), 1, 1);
    t.set(Layer::airborne_sand, 1).set(Layer::wind_x, 1).set(Layer::sand, sand);
    t.saltation(p, a);
    EXPECT_EQ(t.booked(Material::bedrock, 1) > 0, sand < 0.025) << sand;
  }
}

TEST_P(AbrasionLaw, BouncingSandCountsUpToOneMetre) {
  SaltationParameters p;
  p.lift = 0;
  p.bounce_on_rock = 1;
  AbrasionParameters a;
  a.rate = 0.01f;
  for (double air : {1.0, 5.0}) {
    test::BenchTerrain t(exec(), 1, 1);
    t.set(Layer::airborne_sand, air).set(Layer::wind_x, 1);
    t.saltation(p, a);
    EXPECT_NEAR(t.booked(Material::bedrock, 1) * rock_quantum, 0.01, 2 * rock_quantum) << air;
  }
}

TEST_P(AbrasionLaw, BouncingSandCountsUpToTheMostOfIt) {
  SaltationParameters p;
  p.lift = 0;
  p.bounce_on_rock = 1;
  AbrasionParameters a;
  a.rate = 0.01f;
  a.most_bouncing = 2;
  for (double air : {1.0, 2.0, 5.0}) {
    test::BenchTerrain t(exec(), 1, 1);
    t.set(Layer::airborne_sand, air).set(Layer::wind_x, 1);
    t.saltation(p, a);
    EXPECT_NEAR(t.booked(Material::bedrock, 1) * rock_quantum, 0.01 * std::min(air, 2.0), 2 * rock_quantum);
  }
}

TEST_P(AbrasionLaw, OfSoilFadesToNothingAtItsCutOff) {
  const auto wear = [&](double moisture) {
    return worn([&](test::BenchTerrain& t) { t.set(Layer::soil, 2).set(Layer::moisture, moisture); }, 0.1f, 1,
                -1, 0.8f)
        ->booked(Material::soil, 1);
  };
  EXPECT_GT(wear(0.06), 1000) << "m = 0.2, where as little is deposited as on wetter ground";
  EXPECT_NEAR(wear(0.12), 0.5 / 0.75 * wear(0.06), 2) << "m = 0.4 is half of the cut-off";
  EXPECT_EQ(wear(0.2401), 0);
}

TEST_P(AbrasionLaw, WearsSoilFirstAndNeverMoreThanThereIs) {
  const auto deep = worn([](test::BenchTerrain& t) { t.set(Layer::soil, 1); }, 0.1f);
  EXPECT_GT(deep->booked(Material::soil, 1), 0);
  EXPECT_EQ(deep->booked(Material::bedrock, 1), 0);
  EXPECT_EQ(deep->booked(Material::soil, 1), deep->booked(Material::sand, 0));
  const auto thin =
      worn([](test::BenchTerrain& t) { t.set_quanta(Layer::soil, [](int, int) { return 3; }); }, 0.1f);
  EXPECT_EQ(thin->booked(Material::soil, 1), 3);
  EXPECT_EQ(thin->quanta_at(Layer::soil, 0, 0), 0);
}

TEST_P(AbrasionLaw, OfSoilFadesToNothingAtHalfMoisture) {
  // Ground of 1 m, capacity 0.3: 0.15 m of moisture is m = 0.5.
  const auto wear = [&](double moisture) {
    return worn([&](test::BenchTerrain& t) { t.set(Layer::soil, 2).set(Layer::moisture, moisture); }, 0.1f)
        ->booked(Material::soil, 1);
  };
  EXPECT_EQ(wear(0.15), 0);
  EXPECT_EQ(wear(0.3), 0);
  EXPECT_GT(wear(0.14), 0);
}

/// Soil of resistance 1 wore like any other.
TEST_P(AbrasionLaw, OfSoilScalesWithResistance) {
  const auto wear = [&](double resistance) {
    return worn([&](test::BenchTerrain& t) {
             t.set(Layer::soil, 1).set(Layer::erosion_resistance, resistance);
           })
        ->booked(Material::soil, 1);
  };
  EXPECT_GT(wear(0), 1000);
  EXPECT_NEAR(wear(0.5), 0.5 * wear(0), 2);
  EXPECT_EQ(wear(1), 0);
}

/// Without a rate of its own, soil wears by that of rock.
TEST_P(AbrasionLaw, OfSoilHasItsOwnRate) {
  const auto soil = [](test::BenchTerrain& t) { t.set(Layer::soil, 1); };
  const auto usual = worn(soil)->booked(Material::soil, 1);
  EXPECT_EQ(worn(soil, 0.5f, 1, 0.01f)->booked(Material::soil, 1), usual);
  EXPECT_NEAR(worn(soil, 0, 1, 0.005f)->booked(Material::soil, 1), usual / 2, 2);
  EXPECT_EQ(worn(soil, 0.01f, 1, 0)->booked(Material::soil, 1), 0);
  const auto rock = worn([](test::BenchTerrain&) {}, 0.01f, 1, 0.5f);
  EXPECT_EQ(rock->booked(Material::bedrock, 1),
            worn([](test::BenchTerrain&) {})->booked(Material::bedrock, 1));
}

/// An obstacle wore more than rock, because nothing is deposited on it (10486 quanta), and so did rock under
/// water (10422).
TEST_P(AbrasionLaw, IsNothingOnObstaclesAndUnderWater) {
  const auto total = [](const test::BenchTerrain& t) {
    return t.booked(Material::bedrock, 1) + t.booked(Material::soil, 1);
  };
  for (double soil : {0.0, 1.0}) {
    EXPECT_EQ(total(*worn([=](test::BenchTerrain& t) { t.set(Layer::obstacle, 1).set(Layer::soil, soil); })),
              0);
    EXPECT_EQ(total(*worn([=](test::BenchTerrain& t) { t.set(Layer::water, 0.1).set(Layer::soil, soil); })),
              0);
  }
}

DESERT_ON_EACH_BACKEND(AbrasionLaw);

}  // namespace
}  // namespace desert_sim
