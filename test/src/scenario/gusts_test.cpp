// Gusts: how far a wind varies around its regime, and that draws depend on nothing else than they should.

#include "src/scenario/gusts.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "src/scenario/wind_regime.hpp"

namespace desert_sim {
namespace {

struct Polar {
  double speed = 0, direction_deg = 0;
};

Polar polar(wind::Vector w) {
  Polar p;
  speed_and_direction(w, p.speed, p.direction_deg);
  return p;
}

Gusts gusts(double speed, double direction_deg, std::uint32_t member = 1) {
  Gusts g;
  g.gust_speed = speed;
  g.gust_direction_deg = direction_deg;
  g.gust_time = 2;
  g.seed = 7;
  g.member = member;
  g.start_time = 100;
  return g;
}

TEST(Gusts, WithoutDeviationsAreTheRegime) {
  const wind::Vector regime = wind_vector(30, 5), gusty = gusts(0, 0).around(regime, 123);
  EXPECT_EQ(gusty.x, regime.x);
  EXPECT_EQ(gusty.y, regime.y);
  const wind::Vector calm = gusts(1, 90).around({0, 0}, 123);
  EXPECT_EQ(calm.x, 0);
  EXPECT_EQ(calm.y, 0);
}

TEST(Gusts, HaveTheMeansAndDeviationsThatAreAskedFor) {
  const Gusts g = gusts(0.1, 8);
  const int count = 20000;
  double speed = 0, speed2 = 0, direction = 0, direction2 = 0;
  for (int n = 0; n < count; ++n) {
    const Polar p = polar(g.around(wind_vector(30, 5), 100 + 2 * n));
    const double s = p.speed / 5 - 1, d = p.direction_deg - 30;
    speed += s, speed2 += s * s, direction += d, direction2 += d * d;
  }
  const double error = 5 / std::sqrt(count);  // five standard errors of a mean, in deviations
  EXPECT_NEAR(speed / count, 0, 0.1 * error);
  EXPECT_NEAR(direction / count, 0, 8 * error);
  EXPECT_NEAR(std::sqrt(speed2 / count), 0.1, 0.1 * error);
  EXPECT_NEAR(std::sqrt(direction2 / count), 8, 8 * error);
}

TEST(Gusts, LastTheirTimeAndFollowTheRegime) {
  const Gusts g = gusts(0.3, 20);
  const Polar first = polar(g.around(wind_vector(0, 4), 100)),
              still = polar(g.around(wind_vector(0, 4), 101.9)),
              next = polar(g.around(wind_vector(0, 4), 102)), twice = polar(g.around(wind_vector(0, 8), 100));
  EXPECT_EQ(first.speed, still.speed);
  EXPECT_NE(first.speed, next.speed);
  EXPECT_NE(first.direction_deg, next.direction_deg);
  EXPECT_NEAR(twice.speed, 2 * first.speed, 1e-4) << "a gust changes a share of the speed";
  EXPECT_NEAR(twice.direction_deg, first.direction_deg, 1e-3);
}

TEST(Gusts, OfMembersAndSeedsDiffer) {
  Gusts other_seed = gusts(0.3, 20);
  other_seed.seed = 8;
  const wind::Vector regime = wind_vector(0, 4), one = gusts(0.3, 20, 1).around(regime, 100);
  EXPECT_NE(one.x, gusts(0.3, 20, 2).around(regime, 100).x);
  EXPECT_NE(one.x, other_seed.around(regime, 100).x);
}

TEST(Gusts, NeitherReverseTheWindNorExceedTheFastestRegime) {
  const Gusts g = gusts(1, 0);
  int calm = 0, fastest = 0;
  for (int n = 0; n < 2000; ++n) {
    const Polar p = polar(g.around(wind_vector(0, 90), 100 + 2 * n));
    EXPECT_LE(p.speed, 100.001);
    EXPECT_NEAR(p.direction_deg, 0, 1e-3);
    calm += p.speed == 0;
    fastest += p.speed > 99.999;
  }
  EXPECT_GT(calm, 0) << "one in six is below no wind";
  EXPECT_GT(fastest, 0);
}

}  // namespace
}  // namespace desert_sim
