// Steepest sides, crescents and arms of reliefs that are known.

#include "test/support/relief_shape.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace desert_sim {
namespace {

template <class Height>
Field relief_of(const Height& height) {
  Field f;
  f.width = f.height = 64;
  for (int y = 0; y < f.height; ++y)
    for (int x = 0; x < f.width; ++x)
      f.values.push_back(static_cast<float>(height(x + 0.5 - 32, y + 0.5 - 32)));
  return f;
}

TEST(ReliefShape, SteepestCellsFallToTheLee) {
  // Ridges across x that rise over 24 m and fall over 8.
  const Field saw = relief_of([](double x, double) {
    const double place = std::fmod(x + 32, 32);
    return place < 24 ? place / 12 : (32 - place) / 4;
  });
  const Steepest s = steepest(saw, 0.5, 0.1);
  EXPECT_NEAR(s.direction_deg, 0, 1e-6);
  EXPECT_NEAR(s.coherence, 1, 1e-6);
  EXPECT_NEAR(s.slope_deg, std::atan(0.25) / degree, 0.5);
  EXPECT_EQ(s.towards(30), 1);
  EXPECT_EQ(s.towards(90), 0);
  const Crescents c = crescents(saw, 0.5);
  EXPECT_LT(c.skewness, -0.8);
  EXPECT_NEAR(c.lee_divergence, 0, 1e-6);
}

TEST(ReliefShape, FallLinesOfAConePartAndOfAHollowMeet) {
  const Field cone = relief_of([](double x, double y) { return std::max(0.0, 10 - 0.5 * std::hypot(x, y)); });
  EXPECT_GT(crescents(cone, 1).lee_divergence, 0.03);
  EXPECT_NEAR(crescents(cone, 1).skewness, 0, 1e-3);
  Field hollow = cone;
  for (float& h : hollow.values) h = -h;
  EXPECT_LT(crescents(hollow, 1).lee_divergence, -0.03);
}

TEST(ReliefShape, CountsArms) {
  for (int n : {1, 2, 3, 4, 5}) {
    const Field star = relief_of([n](double x, double y) {
      return std::max(0.0, 10 - 0.3 * std::hypot(x, y)) * (1 + 0.3 * std::cos(n * std::atan2(y, x)));
    });
    EXPECT_EQ(arms(star, 32, 32, 15, 0.5, 0.5), n);
    EXPECT_EQ(arms(star, 32, 32, 15, 5, 0.5), 0) << "dips are lower than that";
  }
}

}  // namespace
}  // namespace desert_sim
