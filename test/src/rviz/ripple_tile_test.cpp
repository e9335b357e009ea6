// The light on ripples: their length, direction and contrast, and that tiles fit side by side.

#include "src/rviz/ripple_tile.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

namespace {

using namespace desert_sim;

MicroReliefState wind(double x, double y, float wavelength = 0.15f) {
  MicroReliefState state;
  state.mean_wind_x = x;
  state.mean_wind_y = y;
  state.mean_speed = std::hypot(x, y);
  state.ripple_wavelength = wavelength;
  state.ripple_height = 0.05f * wavelength;
  state.seed = 7;
  return state;
}

/// How much of a wave with so many periods in a tile there is in its brightness.
double part_of(const RippleTile& tile, int periods_x, int periods_y) {
  constexpr double turn = 6.283185307179586;
  std::complex<double> sum = 0;
  for (int row = 0; row < RippleTile::pixels; ++row)
    for (int column = 0; column < RippleTile::pixels; ++column)
      sum += std::polar<double>(tile.brightness[static_cast<std::size_t>(row) * RippleTile::pixels +
                                                static_cast<std::size_t>(column)],
                                turn * (periods_x * column + periods_y * row) / RippleTile::pixels);
  return std::abs(sum) / (RippleTile::pixels * RippleTile::pixels);
}

/// The part of waves within a sixth of this wave vector.
double parts_near(const RippleTile& tile, int periods_x, int periods_y) {
  double sum = 0;
  for (int dy = -4; dy <= 4; ++dy)
    for (int dx = -4; dx <= 4; ++dx) sum += std::pow(part_of(tile, periods_x + dx, periods_y + dy), 2);
  return std::sqrt(sum);
}

TEST(RippleTile, RipplesLieAcrossTheWindAndHaveItsLength) {
  const RippleTile tile = ripple_tile(wind(9, 0));
  const int periods = static_cast<int>(std::lround(tile.side / 0.15f));
  EXPECT_GT(parts_near(tile, periods, 0), 5);
  EXPECT_LT(parts_near(tile, 0, periods), 1);
  const RippleTile turned = ripple_tile(wind(0, 9));
  EXPECT_LT(parts_near(turned, periods, 0), 1);
  EXPECT_GT(parts_near(turned, 0, periods), 2) << "less, because the sun stands more along their crests";
}

TEST(RippleTile, TilesFitSideBySide) {
  const RippleTile tile = ripple_tile(wind(7, 4));
  constexpr int n = RippleTile::pixels;
  const auto step = [&](int a, int b, int row) {
    return std::abs(tile.brightness[static_cast<std::size_t>(row * n + a)] -
                    tile.brightness[static_cast<std::size_t>(row * n + b)]);
  };
  double inside = 0, across = 0;
  for (int row = 0; row < n; ++row) {
    inside += step(n / 2, n / 2 + 1, row);
    across += step(n - 1, 0, row);
  }
  EXPECT_LT(across, 2 * inside);
}

TEST(RippleTile, TheMeanIsTheLightOnLevelGround) {
  const RippleTile tile = ripple_tile(wind(9, 0));
  double sum = 0;
  for (const std::uint8_t value : tile.brightness) sum += value;
  EXPECT_NEAR(sum / static_cast<double>(tile.brightness.size()), 128, 4);
}

TEST(RippleTile, WithoutRipplesItIsEven) {
  for (const MicroReliefState& state : {MicroReliefState(), wind(9, 0, 0)})
    for (const std::uint8_t value : ripple_tile(state).brightness) ASSERT_EQ(value, 128);
}

TEST(RippleTile, IsDrawnAnewForAnotherWindOnly) {
  EXPECT_FALSE(ripples_differ(wind(9, 0), wind(9, 0.1)));
  EXPECT_TRUE(ripples_differ(wind(9, 0), wind(9, 1)));
  EXPECT_TRUE(ripples_differ(wind(9, 0), wind(-9, 0)));
  EXPECT_TRUE(ripples_differ(wind(9, 0), wind(9, 0, 0.2f)));
  EXPECT_TRUE(ripples_differ(wind(9, 0), wind(9, 0, 0)));
}

}  // namespace
