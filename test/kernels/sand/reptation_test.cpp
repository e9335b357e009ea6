// The table of angles of repose, and the three kinds of reptation.

#include "test/support/bench_terrain.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

double tangent(double degrees) { return std::tan(degrees * 3.14159265358979 / 180); }

TEST(MoistureFactor, IsOneWhenDryOneAndAHalfWhenHalfWetAndSmallWhenSaturated) {
  const repose::MoistureFactor factor(ReposeParameters{});
  EXPECT_FLOAT_EQ(factor(0.0f), 1.0f);
  EXPECT_FLOAT_EQ(factor(0.5f), 1.5f);
  EXPECT_FLOAT_EQ(factor(1.0f), 0.15f);
  EXPECT_FLOAT_EQ(factor(0.25f), 1.25f);
  EXPECT_FLOAT_EQ(factor(0.75f), 0.825f);
}

TEST(MoistureFactor, GoesThroughThoseOfHalfWetAndSaturatedGround) {
  ReposeParameters p;
  p.half_wet = 3;
  p.saturated = 0.5f;
  const repose::MoistureFactor factor(p);
  EXPECT_FLOAT_EQ(factor(0.0f), 1.0f);
  EXPECT_FLOAT_EQ(factor(0.25f), 2.0f);
  EXPECT_FLOAT_EQ(factor(0.5f), 3.0f);
  EXPECT_FLOAT_EQ(factor(0.75f), 1.75f);
  EXPECT_FLOAT_EQ(factor(1.0f), 0.5f);
}

class Reptation : public test::OnBackend {
 protected:
  float tangent_at_one_cell(const ReptationParameters& p,
                            const std::function<void(test::BenchTerrain&)>& change, double strength = 0,
                            const ReposeParameters& repose = {}) {
    test::BenchTerrain t(exec(), 1, 1);
    t.set(Layer::sand, 2);
    t.set_strength([&](int, int) { return strength; });
    change(t);
    t.reptation(p, repose);
    return t.repose.download()[0];
  }
  static ReptationParameters method(ReptationMethod m, float strength = 0.1f) {
    ReptationParameters p;
    p.method = m;
    p.strength = strength;
    return p;
  }
};

TEST_P(Reptation, TangentIsTheTables) {
  const auto off = method(ReptationMethod::off);
  EXPECT_FLOAT_EQ(tangent_at_one_cell(off, [](test::BenchTerrain&) {}), static_cast<float>(tangent(33)));
  EXPECT_FLOAT_EQ(tangent_at_one_cell(off, [](test::BenchTerrain& t) { t.set(Layer::vegetation, 1); }),
                  static_cast<float>(tangent(45)));
  EXPECT_NEAR(tangent_at_one_cell(off, [](test::BenchTerrain& t) { t.set(Layer::vegetation, 0.5); }),
              0.5 * (tangent(33) + 1), 1e-6);
  // Ground of two metres holds 0.3 m: half wet at 0.15 m, saturated at 0.3 m and above.
  EXPECT_NEAR(tangent_at_one_cell(off, [](test::BenchTerrain& t) { t.set(Layer::moisture, 0.15); }),
              1.5 * tangent(33), 1e-5);
  EXPECT_NEAR(tangent_at_one_cell(off, [](test::BenchTerrain& t) { t.set(Layer::moisture, 0.3); }),
              0.15 * tangent(33), 1e-5);
  EXPECT_NEAR(tangent_at_one_cell(off, [](test::BenchTerrain& t) { t.set(Layer::moisture, 3); }),
              0.15 * tangent(33), 1e-5);
}

TEST_P(Reptation, MoistGroundIsAsDeepAsTold) {
  ReposeParameters deep;
  deep.moisture_depth = 2;  // the 2 m of sand then hold 0.6 m
  const auto moist = [](double moisture) {
    return [moisture](test::BenchTerrain& t) { t.set(Layer::moisture, moisture); };
  };
  const auto off = method(ReptationMethod::off);
  EXPECT_NEAR(tangent_at_one_cell(off, moist(0.3), 0, deep), 1.5 * tangent(33), 1e-5);
  EXPECT_NEAR(tangent_at_one_cell(off, moist(0.6), 0, deep), 0.15 * tangent(33), 1e-5);
}

TEST_P(Reptation, AdaptiveReposeFallsExponentiallyWithImpactsAndWind) {
  const auto adaptive = method(ReptationMethod::adaptive_repose, 0.1f);
  const auto wind = [](test::BenchTerrain& t) { t.set(Layer::wind_x, 3).set(Layer::wind_y, 4); };
  EXPECT_NEAR(tangent_at_one_cell(adaptive, wind, 2), tangent(33) * std::exp(-0.1 * 2 * 5), 1e-6);
  EXPECT_FLOAT_EQ(tangent_at_one_cell(adaptive, wind, 0), static_cast<float>(tangent(33)));
  EXPECT_FLOAT_EQ(tangent_at_one_cell(method(ReptationMethod::smoothing), wind, 2),
                  static_cast<float>(tangent(33)));
}

TEST_P(Reptation, AdaptiveReposeSparesShadowIfAsked) {
  ReptationParameters adaptive = method(ReptationMethod::adaptive_repose, 0.1f);
  const auto sheltered = [](test::BenchTerrain& t) { t.set(Layer::wind_x, 5).set(Layer::wind_shadow, 0.75); };
  EXPECT_NEAR(tangent_at_one_cell(adaptive, sheltered, 2), tangent(33) * std::exp(-0.25), 1e-6);
  adaptive.use_shadow = false;
  EXPECT_NEAR(tangent_at_one_cell(adaptive, sheltered, 2), tangent(33) * std::exp(-1.0), 1e-6);
}

// Two cells, r = 1 and 0.5, |w| = 2 and 1, Δh = 0.4 m: flux = k_r Δh/l · 0.75 · 1.5, an eighth of it moves.
TEST_P(Reptation, SmoothingMovesTheMeanOfBothCellsStrengthAndWind) {
  test::BenchTerrain t(exec(), 2, 1, 1, false);
  t.set(Layer::sand, [](int x, int) { return x ? 1 : 1.4; });
  t.set(Layer::wind_x, [](int x, int) { return x ? 1 : 2; });
  t.set_strength([](int x, int) { return x ? 0.5 : 1; });
  t.reptation(method(ReptationMethod::smoothing, 0.2f));
  EXPECT_NEAR(1.4 - t.at(Layer::sand, 0, 0), 0.2 * 0.4 * 0.75 * 1.5 / 8, 2e-6);
  EXPECT_EQ(t.total(Layer::sand), t.quanta_at(Layer::sand, 0, 0) + t.quanta_at(Layer::sand, 1, 0));
}

/// Between diagonal neighbours the slope is the drop over √2 cells. Obstacles leave the pair alone; tests had
/// straight neighbours, or symmetric heaps, where a distance of 1 passed.
TEST_P(Reptation, SmoothingSeesADiagonalNeighbourAtRootTwo) {
  test::BenchTerrain t(exec(), 2, 2, 1, false);
  t.set(Layer::sand, [](int x, int y) { return x + y == 0 ? 1.4 : 1; });
  t.set(Layer::obstacle, [](int x, int y) { return x == y ? 0 : 1; });
  t.set(Layer::wind_y, 2);
  t.set_strength([](int, int) { return 0.5; });
  t.reptation(method(ReptationMethod::smoothing, 0.2f));
  EXPECT_NEAR(1.4 - t.at(Layer::sand, 0, 0), 0.2 * 0.4 / std::sqrt(2.0) * 0.5 * 2 / 8, 2e-6);
  EXPECT_NEAR(t.at(Layer::sand, 1, 1) - 1, 0.2 * 0.4 / std::sqrt(2.0) * 0.5 * 2 / 8, 2e-6);
}

TEST_P(Reptation, SmoothingIsSymmetricAndKeepsMass) {
  test::BenchTerrain t(exec(), 9, 9);
  t.set(Layer::sand, [](int x, int y) { return 2 + (x == 4 && y == 4 ? 1.5 : 0); });
  t.set(Layer::wind_x, 3);
  t.set_strength([](int, int) { return 0.7; });
  const long long before = t.total(Layer::sand);
  for (int n = 0; n < 5; ++n) t.reptation(method(ReptationMethod::smoothing, 0.3f));
  EXPECT_EQ(t.total(Layer::sand), before);
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 9; ++x) {
      EXPECT_NEAR(t.quanta_at(Layer::sand, x, y), t.quanta_at(Layer::sand, 8 - x, y), 20);
      EXPECT_NEAR(t.quanta_at(Layer::sand, x, y), t.quanta_at(Layer::sand, y, x), 20);
    }
  EXPECT_GT(t.at(Layer::sand, 3, 3), 2);
}

TEST_P(Reptation, SmoothingSubStepsSoThatStrongDiffusionDoesNotRing) {
  test::BenchTerrain t(exec(), 16, 16);
  t.set(Layer::sand, [](int x, int y) { return 5 + ((x + y) % 2 ? 1 : -1); });
  t.set(Layer::wind_x, 30);
  t.set_strength([](int, int) { return 3; });
  t.reptation(method(ReptationMethod::smoothing, 1));
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) EXPECT_NEAR(t.at(Layer::sand, x, y), 5, 0.01);
}

/// Beside another method it does not overshoot however strong it is, without sub-steps: the alternation of
/// ±1 m decays and keeps its sign.
TEST_P(Reptation, StrongSmoothingBesideAnotherMethodDoesNotRing) {
  ReptationParameters p = method(ReptationMethod::adaptive_repose, 0.1f);
  p.smoothing_strength = 1;
  test::BenchTerrain t(exec(), 16, 16);
  t.set(Layer::sand, [](int x, int y) { return 5 + ((x + y) % 2 ? 1 : -1); });
  t.set(Layer::wind_x, 30);
  t.set_strength([](int, int) { return 3; });
  for (double left = 1; left > 0.01; left *= 0.5) {
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x)
        EXPECT_NEAR((t.at(Layer::sand, x, y) - 5) * ((x + y) % 2 ? 1 : -1), left, 1e-4);
    t.reptation(p);  // four straight neighbours get 1/16 of the drop each
  }
}

/// `smoothing_strength` smooths beside adaptive_repose, and adds to the strength of the method `smoothing`.
/// There was one method at a time.
TEST_P(Reptation, SmoothingActsBesideOtherMethods) {
  const auto given = [&](ReptationParameters p) {
    test::BenchTerrain t(exec(), 2, 1, 1, false);
    t.set(Layer::sand, [](int x, int) { return x ? 1 : 1.4; });
    t.set(Layer::wind_x, 1);
    t.set_strength([](int, int) { return 1; });
    t.reptation(p);
    return 1.4 - t.at(Layer::sand, 0, 0);
  };
  ReptationParameters both = method(ReptationMethod::adaptive_repose, 0.1f);
  EXPECT_NEAR(given(both), 0, 1e-6);
  both.smoothing_strength = 0.2f;
  EXPECT_NEAR(given(both), 0.2 * 0.4 / 8, 2e-6);
  both.method = ReptationMethod::smoothing;
  EXPECT_NEAR(given(both), 0.3 * 0.4 / 8, 2e-6);
  both.method = ReptationMethod::off;
  EXPECT_NEAR(given(both), 0, 1e-6);
}

TEST_P(Reptation, SmoothingLeavesObstaclesAndDoesNotDigBelowTheSand) {
  test::BenchTerrain t(exec(), 5, 5);
  t.set(Layer::bedrock, [](int x, int y) { return x == 2 && y == 2 ? 9 : 0; });
  t.set(Layer::sand, [](int x, int y) { return x == 2 && y == 2 ? 0.001 : (x == 0 && y == 0 ? 4 : 0); });
  t.set(Layer::obstacle, [](int x, int y) { return x == 0 && y == 0 ? 1 : 0; });
  t.set(Layer::wind_x, 9);
  t.set_strength([](int, int) { return 2; });
  t.reptation(method(ReptationMethod::smoothing, 1));
  EXPECT_EQ(t.at(Layer::sand, 0, 0), 4);
  for (Quanta v : t.quanta(Layer::sand)) EXPECT_GE(v, 0);
}

// A certain event (r so large that e^−r = 0) on a slope: `slab` goes to the two steepest neighbours by their
// slopes.
TEST_P(Reptation, SteepestSharesASlabByTheTwoSteepestSlopes) {
  test::BenchTerrain t(exec(), 3, 3, 1, false);
  t.set(Layer::bedrock, [](int x, int y) {
    return x == 1 && y == 1 ? 10 : (x == 0 && y == 1 ? 4 : (x == 2 && y == 1 ? 7 : 20));
  });
  t.set(Layer::sand, [](int x, int y) { return x == 1 && y == 1 ? 1 : 0; });
  t.set_strength([](int x, int y) { return x == 1 && y == 1 ? 100 : 0; });
  ReptationParameters p = method(ReptationMethod::steepest);
  p.slab = 0.1f;
  t.reptation(p);
  EXPECT_NEAR(t.at(Layer::sand, 1, 1), 0.9, 2e-6);
  EXPECT_NEAR(t.at(Layer::sand, 0, 1), 0.1 * 7 / 11, 2e-6);  // slopes 7 and 4
  EXPECT_NEAR(t.at(Layer::sand, 2, 1), 0.1 * 4 / 11, 2e-6);
  EXPECT_EQ(t.total(Layer::sand), 1 << 20);
}

/// A diagonal drop of 7 is a slope of 4.95, less than a straight drop of 6.
TEST_P(Reptation, SteepestSharesByTheSlopesOfDiagonalNeighboursToo) {
  test::BenchTerrain t(exec(), 3, 3, 1, false);
  t.set(Layer::bedrock, [](int x, int y) {
    return x == 1 && y == 1 ? 10 : (x == 2 && y == 2 ? 4 : (x == 0 && y == 1 ? 5 : 20));
  });
  t.set(Layer::sand, [](int x, int y) { return x == 1 && y == 1 ? 1 : 0; });
  t.set_strength([](int x, int y) { return x == 1 && y == 1 ? 100 : 0; });
  ReptationParameters p = method(ReptationMethod::steepest);
  p.slab = 0.1f;
  t.reptation(p);
  const double straight = 6, diagonal = 7 / std::sqrt(2.0);  // with the metre of sand
  EXPECT_NEAR(t.at(Layer::sand, 0, 1), 0.1 * straight / (straight + diagonal), 2e-6);
  EXPECT_NEAR(t.at(Layer::sand, 2, 2), 0.1 * diagonal / (straight + diagonal), 2e-6);
}

TEST_P(Reptation, SteepestMovesNoMoreThanLevelsThePair) {
  test::BenchTerrain t(exec(), 2, 1, 1, false);
  t.set(Layer::sand, [](int x, int) { return x ? 1 : 1.1; });
  t.set_strength([](int x, int) { return x ? 0 : 100; });
  ReptationParameters p = method(ReptationMethod::steepest);
  p.slab = 5;
  t.reptation(p);
  EXPECT_NEAR(t.at(Layer::sand, 0, 0), 1.05, 2e-6);
}

// r = (deposited + bounced)(1 − v) has the plants' share already: of cells with v = 0.25 and r = 0.5, the
// part 1 − e^−0.5 = 0.393 has an event, where multiplying by 1 − v again gave 0.295 of them.
TEST_P(Reptation, SteepestHappensAsOftenAsItsImpactsSay) {
  test::BenchTerrain t(exec(), 200, 200, 1);
  t.set(Layer::bedrock, [](int x, int y) { return (x + y) % 2 ? 0 : 5; });
  t.set(Layer::sand, [](int x, int y) { return (x + y) % 2 ? 0 : 1; });
  t.set(Layer::vegetation, 0.25);
  t.set_strength([](int, int) { return 0.5; });
  ReptationParameters p = method(ReptationMethod::steepest);
  t.reptation(p, {}, 1, 3);
  long moved = 0;
  const auto sand = t.quanta(Layer::sand);
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 200; ++x)
      moved += (x + y) % 2 == 0 && sand[static_cast<std::size_t>(y * 200 + x)] < (1 << 20);
  const double share = 1 - std::exp(-0.5), expected = share * 20000;
  EXPECT_NEAR(static_cast<double>(moved), expected, 4 * std::sqrt(expected * (1 - share)));
}

/// Rarer events, not smaller ones, in a shorter step: half the drop, which bounds an event, is then the same.
/// Before, a tenth of the slab moved in each event of a step of 0.1 s.
TEST_P(Reptation, SteepestMovesWholeSlabsAtShortSteps) {
  ReptationParameters p = method(ReptationMethod::steepest);
  p.slab = 0.1f;
  long long moved = 0;
  for (std::uint64_t tick = 0; tick < 10; ++tick) {
    test::BenchTerrain t(exec(), 100, 2, 1, false);
    t.set(Layer::bedrock, [](int, int y) { return y ? 0 : 5; });
    t.set(Layer::sand, [](int, int y) { return y ? 0 : 1; });
    t.set_strength([](int, int) { return 100; });
    t.reptation(p, {}, 0.1f, tick);
    for (int x = 0; x < 100; ++x) {
      const double left = t.at(Layer::sand, x, 0);
      EXPECT_TRUE(left == 1 || std::abs(left - 0.9) < 1e-5) << left;
      moved += left < 1 ? 1 : 0;
    }
  }
  EXPECT_NEAR(static_cast<double>(moved), 100, 40);  // a tenth of 1000
}

DESERT_ON_EACH_BACKEND(Reptation);

}  // namespace
}  // namespace desert_sim
