// Light and shade: how bright slopes are, where shadows fall, and that blocks agree on them.

#include "src/render/sunlight.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "src/render/sky.hpp"
#include "src/render/terrain_colours.hpp"
#include "test/src/render/fields.hpp"

namespace {

using namespace render_test;

float mean_channel(const Colour& c) { return (c.r + c.g + c.b) / 3; }

TEST(Illumination, TheSunStandsInTheWestNorthWest) {
  const Colour level = illumination(0, 0, 1);
  for (const float channel : {level.r, level.g, level.b}) EXPECT_NEAR(channel, 1, 1e-5f);
  EXPECT_GT(mean_channel(illumination(-0.5f, 0, 0.866f)), 1);
  EXPECT_LT(mean_channel(illumination(0.5f, 0, 0.866f)), 0.6f);
  EXPECT_GT(mean_channel(illumination(0, 0.5f, 0.866f)), mean_channel(illumination(0, -0.5f, 0.866f)));
  EXPECT_NEAR(towards_sun().norm(), 1, 1e-3);
}

TEST(Illumination, ShadeIsDarkAndBlue) {
  const Colour shade = illumination(0, 0, 1, 0);
  EXPECT_LT(mean_channel(shade), 0.4f);
  EXPECT_GT(shade.b, 1.1f * shade.r);
}

constexpr int side = 60;
constexpr CellRectangle grid{0, 0, side, side};

CellWindow sun_on_grid(const Height& height, double cell_size = 1, float exaggeration = 1) {
  return sun_visibility(grid, window_of(grid, height), cell_size, exaggeration);
}

TEST(SunVisibility, LevelGroundAndGentleSlopesLieInTheSun) {
  for (const float slope : {0.0f, 0.2f, -0.2f}) {
    const CellWindow sun = sun_on_grid([&](int x, int) { return slope * static_cast<float>(x); });
    for (const float share : sun.values()) EXPECT_EQ(share, 1);
  }
}

/// A tower of one cell casts a shadow from the sun away, as long as its height over the tangent of the
/// sun's height.
TEST(SunVisibility, AWallCastsAShadowOfItsLengthAwayFromTheSun) {
  constexpr float height = 8;
  const CellWindow sun = sun_on_grid([](int x, int) { return x == 20 ? height : 0.0f; });
  const Point& to_sun = towards_sun();
  const double length = static_cast<double>(height) * -to_sun.x() / to_sun.z();  // along x [cells]
  for (int y = 0; y < side / 2; ++y) {  // further north the wall's end is near
    for (int x = 0; x < 19; ++x) EXPECT_EQ(sun.at(x, y), 1) << x << ' ' << y;
    for (int x = 21; x < 20 + length - 1; ++x) EXPECT_EQ(sun.at(x, y), 0) << x << ' ' << y;
    for (int x = static_cast<int>(20 + length + 2); x < side; ++x)
      EXPECT_EQ(sun.at(x, y), 1) << x << ' ' << y;
  }
}

TEST(SunVisibility, ShadowsPointToTheEastSouthEast) {
  const CellWindow sun =
      sun_on_grid([](int x, int y) { return x >= 20 && x < 24 && y >= 40 && y < 44 ? 12.0f : 0.0f; });
  // Ten cells east of the tower's middle its shadow lies ten times sun_y / sun_x further south.
  EXPECT_LT(sun.at(32, 38), 0.1f);
  EXPECT_EQ(sun.at(32, 45), 1);
  EXPECT_EQ(sun.at(12, 41), 1) << "towards the sun";
}

TEST(SunVisibility, FollowsCellsAndExaggeration) {
  const Height dune = [](int x, int) {
    return 6 * std::exp(-0.05f * static_cast<float>((x - 20) * (x - 20)));
  };
  const Height twice = [&](int x, int y) { return 2 * dune(x, y); };
  EXPECT_EQ(sun_on_grid(twice).values(), sun_on_grid(dune, 1, 2).values());
  EXPECT_EQ(sun_on_grid(twice, 2).values(), sun_on_grid(dune, 1).values());
}

TEST(SunVisibility, UnknownGroundCastsNoShadow) {
  const CellWindow sun = sun_on_grid([](int x, int) { return x == 20 ? unknown : 0.0f; });
  for (const float share : sun.values()) EXPECT_EQ(share, 1);
}

/// However the ground is divided, each cell has the same light: what shades it lies in cells_that_shade().
TEST(SunVisibility, BlocksAgreeWithTheWhole) {
  const int reach = shadow_reach(16, 1);
  EXPECT_GT(reach, 16);
  const CellWindow whole = sun_on_grid(dunes);
  const CellRectangle part{30, 10, 20, 20};
  const CellWindow shares =
      sun_visibility(part, window_of(cells_that_shade(part, reach).clipped(grid), dunes), 1, 1);
  int shaded = 0;
  for (int y = part.y; y < part.top(); ++y)
    for (int x = part.x; x < part.right(); ++x) {
      EXPECT_NEAR(shares.at(x, y), whole.at(x, y), 1e-4f) << x << ' ' << y;
      shaded += whole.at(x, y) < 1;
    }
  EXPECT_GT(shaded, 50);
}

TEST(SunVisibility, WhatShadesACellIsInTheShadeOfIt) {
  const int reach = shadow_reach(10, 0.5);
  const CellRectangle cell{100, 100, 1, 1};
  const CellRectangle shading = cells_that_shade(cell, reach);
  for (const auto& [x, y] : {std::pair(shading.x, shading.y), std::pair(shading.x, shading.top() - 1)})
    EXPECT_TRUE(cells_in_shade_of({x, y, 1, 1}, reach).contains(cell.x, cell.y)) << x << ' ' << y;
  EXPECT_TRUE(cells_in_shade_of({5, 5, 0, 0}, reach).empty());
  EXPECT_EQ(shadow_reach(0, 1), 1);
  EXPECT_EQ(shadow_reach(1e9, 1), longest_shadow);
  EXPECT_EQ(shadow_reach(std::nan(""), 1), 0);
}

TerrainBlock block_at_edge_of_sand(bool shadows, const Height& height) {
  const BlockLayout layout(65, 65);
  TerrainLook look;
  look.shadows = shadows;
  return build_terrain_block(
      {layout, 1, unknown, shadows ? shadow_reach(20, 1) : 0}, 0, 0,
      [&](const std::string& layer, const CellRectangle& cells) {
        if (layer == "elevation") return window_of(cells, height);
        if (layer == "sand_depth") return window_of(cells, [](int x, int) { return x < 20 ? 1.0f : 0.0f; });
        return CellWindow();
      },
      look);
}

Colour unpack(PackedColour c) {
  const auto channel = [&](int shift) { return static_cast<float>(c >> shift & 255) / 255; };
  return {channel(0), channel(8), channel(16)};
}

TEST(TerrainBlock, SandFadesIntoRockOverItsLastCells) {
  const TerrainBlock block = block_at_edge_of_sand(false, [](int, int) { return 0.0f; });
  const auto red = [&](std::size_t x) { return unpack(block.ground.vertices[30 * 65 + x].colour).r; };
  EXPECT_EQ(red(18), red(10));
  EXPECT_EQ(red(21), red(30));
  EXPECT_NEAR(red(19), red(10) + 0.25f * (red(30) - red(10)), 0.01f);
  EXPECT_NEAR(red(20), red(10) + 0.75f * (red(30) - red(10)), 0.01f);
}

TEST(TerrainBlock, AHillCastsItsShadowOnTheGround) {
  const Height hill = [](int x, int) { return x >= 30 && x < 34 ? 10.0f : 0.0f; };
  const TerrainBlock with = block_at_edge_of_sand(true, hill), without = block_at_edge_of_sand(false, hill);
  const auto at = [](const TerrainBlock& block, std::size_t x) {
    return mean_channel(unpack(block.ground.vertices[20 * 65 + x].colour));
  };
  EXPECT_LT(at(with, 40), 0.5f * at(without, 40));
  EXPECT_EQ(at(with, 60), at(without, 60));
}

/// A quad with one odd corner is divided so that the corner has a triangle of its own.
TEST(TerrainMesh, QuadsAreDividedAlongTheDiagonalThatLooksAlike) {
  for (const int odd : {0, 1, 2, 3}) {
    const BlockLayout layout(2, 2);
    const Mesh mesh = build_block(layout, 0, 0, 1, window_of({0, 0, 2, 2}, [](int, int) { return 0.0f; }),
                                  [&](int x, int y, float, float, float) {
                                    return pack(x + 2 * y == odd ? Colour{1, 1, 1} : Colour{0, 0, 0});
                                  });
    ASSERT_EQ(mesh.surface_indices, 6u);
    int triangles = 0;
    for (const std::uint32_t corner : mesh.indices) triangles += corner == static_cast<std::uint32_t>(odd);
    EXPECT_EQ(triangles, 1) << odd;
  }
}

TEST(Sky, IsBlueAbovePaleAtTheHorizonAndBrightAroundTheSun) {
  const Colour above = sky_colour({0, 0, 1}), level = sky_colour({0, 1, 0});
  EXPECT_GT(above.b, above.r + 0.2f);
  EXPECT_NEAR(level.b, level.r, 0.1f);
  EXPECT_GT(mean_channel(sky_colour(towards_sun())), mean_channel(sky_colour(Point(1, 0, 0.7).normalized())));
}

TEST(Sky, TheDomeSurroundsTheEyeAndEndsWithTheSun) {
  const Mesh dome = sky_dome(100);
  const Box box = bounding_box(dome);
  EXPECT_NEAR(box.min().z(), -100, 1e-3);
  EXPECT_NEAR(box.max().z(), 100, 1e-3);
  for (const std::uint32_t index : dome.indices) ASSERT_LT(index, dome.vertices.size());
  const Vertex& last = dome.vertices[dome.indices.back()];
  EXPECT_EQ(last.colour, pack(sun_disc_colour));
  EXPECT_GT(Point(static_cast<double>(last.x), static_cast<double>(last.y), static_cast<double>(last.z))
                .dot(towards_sun()),
            99);
}

}  // namespace
