// Scale bars and the arrow to the north.

#include "src/render/scale_bar.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using desert_sim::render::length_text;
using desert_sim::render::north_angle;
using desert_sim::render::scale_bar;

constexpr double pi = 3.14159265358979323846;

TEST(ScaleBar, IsTheLongestRoundLengthThatFits) {
  for (const auto& [metres_per_pixel, metres] :
       {std::pair{0.031, 2.0}, {0.05, 5.0}, {1.0, 100.0}, {1.99, 200.0}, {3.1, 200.0}, {0.0009, 0.1}}) {
    const auto bar = scale_bar(metres_per_pixel, 120);
    ASSERT_TRUE(bar) << metres_per_pixel;
    EXPECT_NEAR(bar->metres, metres, 1e-9) << metres_per_pixel;
    EXPECT_NEAR(bar->pixels, metres / metres_per_pixel, 1e-6);
  }
}

TEST(ScaleBar, IsNeverLongerThanAskedAndNeverShorterThanTwoFifthsOfIt) {
  for (double scale = 1e-4; scale < 1e3; scale *= 1.01) {
    const auto bar = scale_bar(scale, 150);
    ASSERT_TRUE(bar) << scale;
    EXPECT_LE(bar->pixels, 150 * (1 + 1e-12)) << scale;
    EXPECT_GT(bar->pixels, 150 * 0.4 * (1 - 1e-12)) << scale;
  }
}

TEST(ScaleBar, ThereIsNoneForScalesThatNoPictureHas) {
  for (const double scale : {0.0, -1.0, 1e9, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_FALSE(scale_bar(scale, 150)) << scale;
}

TEST(ScaleBar, SaysLengthsInTheirUsualUnits) {
  EXPECT_EQ(length_text(0.005), "5 mm");
  EXPECT_EQ(length_text(0.2), "20 cm");
  EXPECT_EQ(length_text(1), "1 m");
  EXPECT_EQ(length_text(500), "500 m");
  EXPECT_EQ(length_text(2000), "2 km");
}

TEST(NorthArrow, TurnsAgainstTheCamera) {
  EXPECT_NEAR(north_angle({1, 0, 0}), 0, 1e-12) << "looks north: up";
  EXPECT_NEAR(north_angle({0, -1, 0}), -pi / 2, 1e-12) << "looks east: to the left";
  EXPECT_NEAR(north_angle({0, 1, 0}), pi / 2, 1e-12) << "looks west: to the right";
  EXPECT_NEAR(std::abs(north_angle({-1, 0, 0})), pi, 1e-12) << "looks south: down";
  EXPECT_NEAR(north_angle({std::sqrt(0.5), -std::sqrt(0.5), 0}), -pi / 4, 1e-12) << "looks north-east";
}

}  // namespace
