// Lift, scatter, deposit, bounce, influx and outflux, by hand.

#include "kernels/sand/tuned/saltation_fused.hpp"
#include "test/support/bench_terrain.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

constexpr double sand_quantum = 1.0 / 1048576;

class SaltationLaw : public test::OnBackend {
 protected:
  /// One cell of sand in calm air that lifts and lands where it was: what is left on the ground and in the
  /// air.
  struct OneCell {
    double sand, air;
  };
  OneCell one_cell(const std::function<void(test::BenchTerrain&)>& change, const SaltationParameters& p = {},
                   float dt = 1) {
    test::BenchTerrain t(exec(), 1, 1);
    // A hop of exactly one cell over a grid of one cell comes back to it.
    t.set(Layer::sand, 10).set(Layer::wind_x, 1);
    change(t);
    t.saltation(p, {}, {}, dt);
    return {t.at(Layer::sand, 0, 0), t.at(Layer::airborne_sand, 0, 0)};
  }
  /// Share of a metre of landing sand that stays, with no lift.
  double deposit_share(const std::function<void(test::BenchTerrain&)>& change, SaltationParameters p = {}) {
    p.lift = 0;
    test::BenchTerrain t(exec(), 1, 1);
    t.set(Layer::airborne_sand, 1).set(Layer::wind_x, 1);
    change(t);
    const double before = t.at(Layer::sand, 0, 0);
    t.saltation(p);
    EXPECT_NEAR(t.at(Layer::sand, 0, 0) - before + t.at(Layer::airborne_sand, 0, 0), 1, 1e-9);
    return t.at(Layer::sand, 0, 0) - before;
  }
};

TEST_P(SaltationLaw, LiftsOneMetreAndDepositsSixTenthsOnSand) {
  const OneCell c = one_cell([](test::BenchTerrain&) {});
  EXPECT_NEAR(c.sand, 10 - 1 + 0.6, 2 * sand_quantum);
  EXPECT_NEAR(c.air, 0.4, 2 * sand_quantum);
}

TEST_P(SaltationLaw, LiftScalesWithTimeStepShadowAndVegetation) {
  EXPECT_NEAR(one_cell([](test::BenchTerrain&) {}, {}, 0.25f).air, 0.25 * 0.4, 2 * sand_quantum);
  EXPECT_NEAR(one_cell([](test::BenchTerrain& t) { t.set(Layer::wind_shadow, 0.25); }).air, 0.75 * 0.4,
              2 * sand_quantum);
  // Vegetation holds more as well: p = 0.6 + 0.5·0.4.
  EXPECT_NEAR(one_cell([](test::BenchTerrain& t) { t.set(Layer::vegetation, 0.5); }).air, 0.5 * 0.2,
              2 * sand_quantum);
}

/// Of 2 m in the air and 1 m that can be lifted a quarter hops in a quarter of a second; the rest waits. Thin
/// sand is bare rock to what lands in it, as it is when all of it hops. When hops took a whole step, all 2 m
/// hopped in a step of any length.
TEST_P(SaltationLaw, AShareHopsInAShareOfTheHopTime) {
  const auto in_the_air = [](test::BenchTerrain& t) { t.set(Layer::airborne_sand, 2); };
  EXPECT_NEAR(one_cell(in_the_air, {}, 0.25f).air, 1.5 + 0.25 * 3 * 0.4, 4 * sand_quantum);
  EXPECT_NEAR(one_cell(in_the_air, {}, 0.25f).sand, 10 - 0.25 + 0.25 * 3 * 0.6, 4 * sand_quantum);
  const OneCell thin = one_cell([](test::BenchTerrain& t) { t.set(Layer::sand, 0.5); }, {}, 0.25f);
  EXPECT_NEAR(thin.air, 0.125 * 0.6, 4 * sand_quantum);
  SaltationParameters slow;
  slow.hop_time = 4;
  EXPECT_NEAR(one_cell(in_the_air, slow, 1).air, 1.5 + 0.25 * (2 + 4) * 0.4, 4 * sand_quantum);
}

TEST_P(SaltationLaw, LiftIsHalvedOnStickyGroundAndRaisedInTheLane) {
  EXPECT_NEAR(one_cell([](test::BenchTerrain& t) { t.set(Layer::echo, 0.5); }).air, 0.5 * 0.4,
              2 * sand_quantum);
  EXPECT_NEAR(one_cell([](test::BenchTerrain& t) { t.set(Layer::echo, -1); }).air, 2,
              2 * sand_quantum);  // lifts 1 + 1, holds none
  EXPECT_NEAR(one_cell([](test::BenchTerrain& t) { t.set(Layer::echo, -1).set(Layer::wind_shadow, 1); }).air,
              1, 2 * sand_quantum);
}

TEST_P(SaltationLaw, LiftStopsAtTheSandThatIsThere) {
  const OneCell c = one_cell([](test::BenchTerrain& t) { t.set(Layer::sand, 0.25); });
  EXPECT_NEAR(c.sand + c.air, 0.25, sand_quantum);
  EXPECT_NEAR(c.air, 0.25 * 0.6, 2 * sand_quantum);  // it lands on bare rock
}

TEST_P(SaltationLaw, LiftFadesWithMoistureAndStopsUnderWater) {
  // Capacity 0.3 of one metre: 0.015 m of moisture is m = 0.05, so M = 0.5; what lands is held half as well.
  const OneCell damp = one_cell([](test::BenchTerrain& t) { t.set(Layer::moisture, 0.015); });
  EXPECT_NEAR(damp.sand + damp.air, 10, sand_quantum);
  EXPECT_NEAR(damp.air, 0.5 * (1 - 0.6 * 0.5), 1e-5);
  EXPECT_LT(one_cell([](test::BenchTerrain& t) { t.set(Layer::moisture, 0.03); }).air,
            1e-5);  // m = 0.1 but for rounding
  EXPECT_EQ(one_cell([](test::BenchTerrain& t) { t.set(Layer::moisture, 0.0301); }).air, 0);
  EXPECT_EQ(one_cell([](test::BenchTerrain& t) { t.set(Layer::water, 2e-5); }).air, 0);
  EXPECT_GT(one_cell([](test::BenchTerrain& t) { t.set(Layer::water, 0.5e-5); }).air, 0);
}

/// The published tenth and hundredth were numbers in the law.
TEST_P(SaltationLaw, MoistureStopsSandAtItsCutOffAndLeavesTheLeastDeposit) {
  SaltationParameters p;
  p.moisture_cutoff = 0.2f;
  const auto moist = [](double moisture) {
    return [moisture](test::BenchTerrain& t) { t.set(Layer::moisture, moisture); };
  };
  EXPECT_NEAR(one_cell(moist(0.03), p).air, 0.5 * (1 - 0.6 * 0.5), 1e-5) << "m = 0.1 is half of the cut-off";
  EXPECT_EQ(one_cell(moist(0.0601), p).air, 0);
  p.least_deposit = 0.25f;
  const auto under = [](Layer layer, double depth) {
    return [=](test::BenchTerrain& t) { t.set(Layer::sand, 2).set(layer, depth); };
  };
  EXPECT_NEAR(deposit_share(under(Layer::water, 1), p), 0.25 * 0.6, 1e-5);
  EXPECT_NEAR(deposit_share(under(Layer::moisture, 0.3), p), 0.25 * 0.6, 1e-5);
  EXPECT_NEAR(deposit_share(under(Layer::moisture, 0.03), p), 0.5 * 0.6, 1e-5);
}

TEST_P(SaltationLaw, StickyGroundLeavesItsShareOfTheLift) {
  EchoDuneParameters echo;
  echo.sticky_lift = 0.25f;
  test::BenchTerrain t(exec(), 1, 1);
  t.set(Layer::sand, 10).set(Layer::wind_x, 1).set(Layer::echo, 0.5);
  t.saltation({}, {}, {}, 1, echo);
  EXPECT_NEAR(t.at(Layer::airborne_sand, 0, 0), 0.25 * 0.4, 2 * sand_quantum);
}

TEST_P(SaltationLaw, NothingIsLiftedBelowTheThresholdSpeed) {
  SaltationParameters p;
  p.threshold_speed = 1.5f;
  EXPECT_EQ(one_cell([](test::BenchTerrain&) {}, p).air, 0);
  p.threshold_speed = 0.5f;
  EXPECT_GT(one_cell([](test::BenchTerrain&) {}, p).air, 0);
}

TEST_P(SaltationLaw, DepositsBySurface) {
  EXPECT_NEAR(deposit_share([](test::BenchTerrain& t) { t.set(Layer::sand, 1); }), 0.6, 2 * sand_quantum);
  EXPECT_NEAR(deposit_share([](test::BenchTerrain& t) { t.set(Layer::soil, 1); }), 0.5, 2 * sand_quantum);
  EXPECT_NEAR(deposit_share([](test::BenchTerrain&) {}), 0.4, 2 * sand_quantum);
  EXPECT_NEAR(deposit_share([](test::BenchTerrain& t) { t.set(Layer::sand, 0.0005); }), 0.4,
              2 * sand_quantum);  // counts as bare
}

TEST_P(SaltationLaw, DepositsAllInShadowNothingOnObstaclesAndInTheLane) {
  EXPECT_NEAR(deposit_share([](test::BenchTerrain& t) { t.set(Layer::wind_shadow, 1); }), 1, sand_quantum);
  EXPECT_NEAR(deposit_share([](test::BenchTerrain& t) { t.set(Layer::wind_shadow, 0.3); }), 0.4,
              2 * sand_quantum);
  EXPECT_NEAR(deposit_share([](test::BenchTerrain& t) { t.set(Layer::echo, 0.9); }), 0.9, 2 * sand_quantum);
  EXPECT_EQ(deposit_share([](test::BenchTerrain& t) { t.set(Layer::echo, -1).set(Layer::wind_shadow, 1); }),
            0);
  EXPECT_EQ(
      deposit_share([](test::BenchTerrain& t) { t.set(Layer::obstacle, 1).set(Layer::wind_shadow, 1); }), 0);
}

TEST_P(SaltationLaw, DepositGrowsWithVegetationAndShrinksWithWetness) {
  EXPECT_NEAR(deposit_share([](test::BenchTerrain& t) { t.set(Layer::vegetation, 0.5); }), 0.4 + 0.5 * 0.6,
              2 * sand_quantum);
  EXPECT_NEAR(deposit_share([](test::BenchTerrain& t) { t.set(Layer::sand, 2).set(Layer::moisture, 0.015); }),
              0.3, 1e-5);
  EXPECT_NEAR(deposit_share([](test::BenchTerrain& t) { t.set(Layer::sand, 2).set(Layer::moisture, 0.3); }),
              0.006, 1e-5);
  EXPECT_NEAR(deposit_share([](test::BenchTerrain& t) { t.set(Layer::sand, 2).set(Layer::water, 1); }), 0.006,
              1e-5);
}

TEST_P(SaltationLaw, SharesAHopBilinearlyAmongFourCells) {
  SaltationParameters p;
  p.hop_spread = 0;
  p.lift = 0;
  p.bounce_on_rock = 1;  // all stays in the air, where it can be seen
  for (const auto& [u, v] : {std::pair{2.25, 1.5}, {-2.25, 1.5}, {-0.25, -3.75}, {1.0, 0.0}}) {
    test::BenchTerrain t(exec(), 8, 8);
    t.set_quanta(Layer::airborne_sand, [](int x, int y) { return x == 4 && y == 4 ? 1 << 20 : 0; });
    t.set(Layer::wind_x, u).set(Layer::wind_y, v);
    t.saltation(p);
    EXPECT_EQ(t.total(Layer::airborne_sand), 1 << 20);
    const int x0 = static_cast<int>(std::floor(4 + u)), y0 = static_cast<int>(std::floor(4 + v));
    const double fx = u - std::floor(u), fy = v - std::floor(v);
    for (int dy = 0; dy < 2; ++dy)
      for (int dx = 0; dx < 2; ++dx)
        EXPECT_EQ(t.quanta_at(Layer::airborne_sand, wrap(x0 + dx, 8), wrap(y0 + dy, 8)),
                  static_cast<Quanta>((dx ? fx : 1 - fx) * (dy ? fy : 1 - fy) * (1 << 20)))
            << u << ", " << v << ": " << dx << ", " << dy;
  }
}

/// All hops were of one length, so that a pattern in thin sand ran on for ever.
TEST_P(SaltationLaw, LandingPointsSpreadByTheirStandardDeviation) {
  for (const auto& [spread, variance] : {std::pair{0.5, 0.25}, {0.25, 0.0625}, {100.0, 0.5}}) {
    SaltationParameters p;
    p.lift = 0;
    p.bounce_on_rock = 1;
    p.hop_spread = static_cast<float>(spread);
    for (const int x0 : {4, 7}) {  // inside, and across the border
      test::BenchTerrain t(exec(), 8, 8);
      t.set_quanta(Layer::airborne_sand, [x0](int x, int y) { return x == x0 && y == 4 ? 1 << 20 : 0; });
      t.set(Layer::wind_x, 1);
      t.saltation(p);
      EXPECT_EQ(t.total(Layer::airborne_sand), 1 << 20);
      double along = 0, across = 0;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const auto at = [&](int x, int y) {
            return t.quanta_at(Layer::airborne_sand, wrap(x0 + 1 + x, 8), 4 + y);
          };
          EXPECT_EQ(at(dx, dy), at(-dx, dy));
          EXPECT_EQ(at(dx, dy), at(dy, dx));
          along += at(dx, dy) * dx * dx / 1048576.0;
          across += at(dx, dy) * dy * dy / 1048576.0;
        }
      EXPECT_NEAR(along, variance, 1e-5) << spread;
      EXPECT_NEAR(across, variance, 1e-5) << spread;
    }
  }
}

/// The form for GPUs, which computes four cells at a time, runs on a host as well.
TEST(Landing, OfFourCellsIsThatOfEach) {
  for (const Grid& grid :
       {Grid{32, 12, 1, true, true}, Grid{32, 12, 1, false, false}, Grid{8, 5, 1, false, true},
        Grid{8, 5, 1, true, false}, Grid{4, 2, 1, true, true}, Grid{4, 1, 1, false, false}}) {
    std::vector<Quanta> landed;
    for (int i = 0; i < grid.cells(); ++i)
      landed.push_back(static_cast<Quanta>(scrambled(static_cast<std::uint32_t>(i)) >> (i % 3 ? 10 : 5)));
    for (const float spread : {0.0f, 0.3f, 0.6f, 5.0f}) {
      const saltation::Landing landing(grid, landed.data(), spread);
      long long before = 0, after = 0;
      for (int y = 0; y < grid.height; ++y)
        for (int x = 0; x < grid.width; x += 4) {
          const Vec4<Quanta> four = saltation::land_on_four(landing, x, y);
          for (int n = 0; n < 4; ++n) {
            const Quanta one = landing.at<false>(x + n, y);
            EXPECT_EQ(four.values[n], one) << grid.width << ", " << spread << ": " << x + n << ", " << y;
            if (grid.inside(x + n - 1, y - 1) && grid.inside(x + n + 1, y + 1)) {
              EXPECT_EQ(landing.at<true>(x + n, y), one);
            }
            before += landed[static_cast<std::size_t>(grid.index(x + n, y))];
            after += one;
          }
        }
      EXPECT_EQ(after, before) << spread;
    }
  }
}

TEST_P(SaltationLaw, WindAcrossAPeriodicBorderComesBackOnTheOtherSide) {
  SaltationParameters p;
  p.hop_spread = 0;
  p.lift = 0;
  p.bounce_on_rock = 1;
  test::BenchTerrain t(exec(), 5, 3);
  t.set_quanta(Layer::airborne_sand, [](int x, int y) { return x == 4 && y == 2 ? 1000 : 0; });
  t.set(Layer::wind_x, 3).set(Layer::wind_y, 2);
  t.saltation(p);
  EXPECT_EQ(t.quanta_at(Layer::airborne_sand, 2, 1), 1000);
}

TEST_P(SaltationLaw, WhatLeavesOverAnOpenEdgeIsBookedAsOut) {
  SaltationParameters p;
  p.lift = 0;
  p.bounce_on_rock = 1;
  test::BenchTerrain t(exec(), 4, 4, 1, false);
  t.set_quanta(Layer::airborne_sand, [](int, int) { return 1 << 16; });
  t.set(Layer::wind_x, 1.5);
  t.saltation(p);
  EXPECT_EQ(t.booked(Material::sand, 1), 4 * (1 << 16) * 3 / 2);
  EXPECT_EQ(t.booked(Material::sand, 0), 0);
  EXPECT_EQ(t.total(Layer::airborne_sand) + t.booked(Material::sand, 1), 16 * (1 << 16));
}

TEST_P(SaltationLaw, InfluxIsPerMetreOfEdgeAndSecondWhateverHopCellAndTimeStep) {
  for (double cell : {0.5, 2.0})
    for (float dt : {0.5f, 1.0f, 3.0f})
      for (double u : {0.3, 1.0, 4.7, -2.2}) {
        if (std::abs(u) > 15 * cell) continue;  // the first hop must fit the grid
        SaltationParameters p;
        p.lift = 0;
        p.influx = 0.125f;
        test::BenchTerrain t(exec(), 16, 9, cell, false);
        t.set(Layer::wind_x, u);
        t.saltation(p, {}, {}, dt);
        const double volume = t.booked(Material::sand, 0) * sand_quantum * cell * cell;
        // Half a sand_quantum a cell, in each hop of 1 s.
        const double rounding = 0.5 * sand_quantum * 16 * 9 * cell * cell * std::ceil(dt);
        EXPECT_NEAR(volume, 0.125 * dt * 9 * cell, rounding + 1e-6)
            << "cell " << cell << ", dt " << dt << ", u " << u;
        EXPECT_EQ(t.total(Layer::sand) + t.total(Layer::airborne_sand),
                  t.booked(Material::sand, 0) - t.booked(Material::sand, 1));
      }
}

/// Of an oblique wind each edge lets in its part, |u|/|w| and |v|/|w|, and in a corner what has hopped over
/// both edges counts once: tests had winds along an axis, which let in the same without all this.
TEST_P(SaltationLaw, InfluxOfAnObliqueWindIsThroughTheEdgesCrossSection) {
  for (const auto& [u, v] : {std::pair{3.0, 4.0}, {-1.5, 0.8}, {2.5, -2.5}}) {
    SaltationParameters p;
    p.lift = 0;
    p.influx = 0.125f;
    test::BenchTerrain t(exec(), 16, 9, 1, false);
    t.set(Layer::wind_x, u).set(Layer::wind_y, v);
    t.saltation(p);
    const double across = (9 * std::abs(u) + 16 * std::abs(v) - std::abs(u * v)) / std::hypot(u, v);
    EXPECT_NEAR(t.booked(Material::sand, 0) * sand_quantum, 0.125 * across, 16 * 9 * sand_quantum)
        << u << ", " << v;
  }
}

/// It got twice as much, so that a field rose by 3.35 m in its windward corner in 200 steps.
TEST_P(SaltationLaw, InfluxIntoACornerIsThatOfItsEdges) {
  for (const auto& [u, v] : {std::pair{3.0, 4.0}, {-3.0, 2.0}}) {
    SaltationParameters p;
    p.lift = 0;
    p.hop_spread = 0;
    p.influx = 0.125f;
    test::BenchTerrain t(exec(), 16, 16, 1, false);
    t.set(Layer::wind_x, u).set(Layer::wind_y, v);
    t.saltation(p);
    const auto landed = [&](int x, int y) {
      return t.at(Layer::sand, x, y) + t.at(Layer::airborne_sand, x, y);
    };
    const int x = u > 0 ? 0 : 15, y = v > 0 ? 0 : 15;
    const double expected = 0.125 / std::hypot(u, v);
    EXPECT_NEAR(landed(x, y), expected, 2 * sand_quantum) << u << ", " << v;
    EXPECT_NEAR(landed(x, 8), expected, 2 * sand_quantum) << u << ", " << v;
    EXPECT_NEAR(landed(8, y), expected, 2 * sand_quantum) << u << ", " << v;
    EXPECT_EQ(landed(8, 8), 0) << u << ", " << v;
  }
}

TEST_P(SaltationLaw, InfluxEntersOnlyWindwardAndNotOnATorus) {
  SaltationParameters p;
  p.hop_spread = 0;
  p.lift = 0;
  p.influx = 1;
  test::BenchTerrain t(exec(), 8, 8, 1, false), torus(exec(), 8, 8);
  t.set(Layer::wind_y, -1);
  torus.set(Layer::wind_y, -1);
  t.saltation(p);
  torus.saltation(p);
  EXPECT_EQ(torus.total(Layer::sand) + torus.total(Layer::airborne_sand), 0);
  for (int x = 0; x < 8; ++x)
    for (int y = 0; y < 8; ++y) EXPECT_EQ(t.at(Layer::sand, x, y) > 0, y == 7) << x << ", " << y;
}

TEST_P(SaltationLaw, StrengthOfReptationIsWhatArrivedLessVegetation) {
  SaltationParameters p;
  p.lift = 0;
  test::BenchTerrain t(exec(), 1, 1);
  t.set(Layer::airborne_sand, 2).set(Layer::vegetation, 0.25);
  t.saltation(p);
  EXPECT_FLOAT_EQ(t.strength.download()[0], 1.5f);
  // It is that of a whole hop, whatever the time step; it was a share of it.
  t.set(Layer::airborne_sand, 2).set(Layer::sand, 0);
  t.saltation(p, {}, {}, 0.125f);
  EXPECT_FLOAT_EQ(t.strength.download()[0], 1.5f);
}

DESERT_ON_EACH_BACKEND(SaltationLaw);

}  // namespace
}  // namespace desert_sim
