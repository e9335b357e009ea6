// The colours of costs on the ground.

#include "src/render/cost_colours.hpp"

#include <gtest/gtest.h>

#include <set>

namespace {

using namespace desert_sim::render;

int alpha_of(PackedColour pixel) { return static_cast<int>(pixel >> 24); }

TEST(CostColours, FreeGroundIsNotHidden) {
  for (const CostPalette palette : {CostPalette::present, CostPalette::forecast})
    EXPECT_EQ(alpha_of(cost_pixel(palette, free_cost, 1, 3, 4)), 0);
}

TEST(CostColours, HigherCostsHideMore) {
  float before = 0;
  for (int cost = 1; cost <= 100; ++cost) {
    const float opacity = cost_opacity(static_cast<std::int8_t>(cost), 0.6f, 0, 0);
    EXPECT_GE(opacity, before) << cost;
    EXPECT_LE(opacity, 0.6f) << cost;
    before = opacity;
  }
  EXPECT_FLOAT_EQ(before, 0.6f);
}

TEST(CostColours, LethalInscribedPassableAndForecastAreToldApart) {
  std::set<PackedColour> colours;
  for (const CostPalette palette : {CostPalette::present, CostPalette::forecast})
    for (const std::int8_t cost :
         {std::int8_t{1}, std::int8_t{50}, std::int8_t{98}, inscribed_cost, lethal_cost})
      colours.insert(pack(cost_colour(palette, cost)));
  EXPECT_EQ(colours.size(), 10u);
}

TEST(CostColours, UnknownCellsAreHatched) {
  for (const std::int8_t cost : {std::int8_t{-1}, std::int8_t{-128}, std::int8_t{101}}) {
    int drawn = 0;
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) drawn += alpha_of(cost_pixel(CostPalette::present, cost, 0.5f, x, y)) > 0;
    EXPECT_EQ(drawn, 32) << static_cast<int>(cost);
  }
}

TEST(CostColours, PixelsCanBeInterpolated) {
  const PackedColour free = cost_pixel(CostPalette::present, free_cost, 1, 0, 0);
  const PackedColour lowest = pack(cost_colour(CostPalette::present, 1));
  for (const int bits : {0, 8, 16})
    EXPECT_NEAR(static_cast<int>(free >> bits & 255), static_cast<int>(lowest >> bits & 255), 3)
        << "beside free ground no dark seam";
  EXPECT_NEAR(alpha_of(cost_pixel(CostPalette::present, lethal_cost, 0.5f, 0, 0)), 128, 1);
}

}  // namespace
