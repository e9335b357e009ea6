// Fine ground near the camera: where it is wanted, that it closes the hole in the blocks, and how it looks.

#include "src/render/near_ground.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "src/render/ray_cast.hpp"
#include "test/src/render/fields.hpp"

namespace {

using namespace render_test;

constexpr float ripple_height = 0.05f;

LayerWindow ground_of(const Height& height) {
  return [height](const std::string& name, const CellRectangle& cells) {
    return name == "elevation" ? window_of(cells, height) : CellWindow();
  };
}

/// Bilinear between the centres of cells, with ripples of a length of 0.8 m.
NearGround rippled(const CellRectangle& cells, int divisions, const Height& height) {
  NearGround near{cells, divisions, true, {}};
  for (int row = 0; row < near.rows(); ++row)
    for (int column = 0; column < near.columns(); ++column) {
      const float x = static_cast<float>(column) / static_cast<float>(divisions),
                  y = static_cast<float>(row) / static_cast<float>(divisions);
      const int i = std::min(static_cast<int>(x), cells.width - 2),
                j = std::min(static_cast<int>(y), cells.height - 2);
      const float a = x - static_cast<float>(i), b = y - static_cast<float>(j);
      const auto at = [&](int di, int dj) { return height(cells.x + i + di, cells.y + j + dj); };
      const float south = at(0, 0) + a * (at(1, 0) - at(0, 0)), north = at(0, 1) + a * (at(1, 1) - at(0, 1));
      near.heights.push_back(south + b * (north - south) +
                             0.5f * ripple_height * std::sin(2 * 3.14159265f * x / 0.8f));
    }
  return near;
}

TerrainGrid grid_of(const CellRectangle& hole = {}) {
  return {BlockLayout(64, 64), 1, std::numeric_limits<float>::quiet_NaN(), 0, hole};
}

TEST(NearWindow, IsWantedWhereRipplesCanBeSeen) {
  const BlockLayout layout(64, 64);
  EXPECT_TRUE(near_window(layout, 1, 32, 32, 0.2).empty()) << "from afar";
  const NearWindow near = near_window(layout, 1, 32, 32, 0.03);
  ASSERT_FALSE(near.empty());
  EXPECT_EQ(near.divisions % 2, 1);
  EXPECT_NEAR(1.0 / near.divisions, 0.03, 0.003);
  EXPECT_TRUE(near.cells.contains(32, 32));
  EXPECT_LE((near.cells.width - 1) * near.divisions, 170);
  EXPECT_TRUE(near_window(layout, 0.005, 0.15, 0.15, 0.001).empty()) << "cells are as fine";
  EXPECT_TRUE(near_window(layout, 1, 32, 32, std::nan("")).empty());
  EXPECT_TRUE(near_window(BlockLayout(3, 64), 1, 1, 32, 0.03).empty());
}

TEST(NearWindow, LiesWithinTheCellsThatHaveNeighbours) {
  const BlockLayout layout(40, 20);
  for (const double x : {-1e9, 0.0, 3.7, 39.9, 1e9})
    for (const double cell : {0.2, 1.0, 30.0}) {
      const NearWindow near = near_window(layout, cell, x * cell, 10 * cell, 0.02);
      if (near.empty()) continue;
      EXPECT_GE(near.cells.x, 1);
      EXPECT_LE(near.cells.right(), 39);
      EXPECT_GE(near.cells.width, 2);
      EXPECT_LE(near.divisions, 201);
    }
}

TEST(NearWindow, DoesNotMoveWithEachStep) {
  const BlockLayout layout(200, 200);
  int windows = 1;
  NearWindow before = near_window(layout, 1, 100, 100, 0.05);
  for (double x = 100; x < 108; x += 0.25) {
    const NearWindow near = near_window(layout, 1, x, 100, 0.05);
    EXPECT_TRUE(near.cells.contains(static_cast<int>(x), 100));
    if (!(near == before)) ++windows;
    before = near;
  }
  EXPECT_LE(windows, 6);
}

TEST(NearGround, ClosesTheHoleInTheBlocks) {
  const CellRectangle hole{20, 24, 7, 6};
  const TerrainGrid grid = grid_of(hole);
  const Mesh near = near_ground_mesh(rippled(hole, 5, dunes), grid, ground_of(dunes), {});
  const Mesh block = build_block(
      grid.layout, 0, 0, 1, window_of(grid.layout.needed_cells(0, 0), dunes),
      [](int, int, float, float, float) {
        return pack({1, 1, 1});
      },
      grid.base, hole);
  const Mesh whole = block_of(grid.layout, 0, 0, dunes);
  EXPECT_EQ(whole.surface_indices - block.surface_indices, 6u * 6 * 5);
  EXPECT_EQ(near.surface_indices, 6u * 30 * 25);
  std::map<std::pair<float, float>, float> edge;
  for (const Vertex& v : block.vertices) edge[{v.x, v.y}] = v.z;
  int shared = 0;
  for (const Vertex& v : near.vertices) {
    const bool at_the_edge = v.x == 20.5f || v.x == 26.5f || v.y == 24.5f || v.y == 29.5f;
    const auto cell = edge.find({v.x, v.y});
    if (!at_the_edge || cell == edge.end()) continue;
    ++shared;
    EXPECT_EQ(v.z, cell->second) << v.x << ", " << v.y;
  }
  EXPECT_EQ(shared, 2 * (6 + 5)) << "the centres of the outermost cells";
}

TEST(NearGround, HasTheHeightsThatItWasGivenAndTheirSlopes) {
  const CellRectangle cells{20, 20, 9, 9};
  const NearGround given = rippled(cells, 9, [](int, int) { return 2.0f; });
  TerrainLook look;
  look.ripples = true;
  const Mesh mesh = near_ground_mesh(given, grid_of(cells), ground_of([](int, int) { return 2.0f; }), look);
  const auto middle = static_cast<std::size_t>(given.rows() / 2 * given.columns());
  float highest = 0, steepest = 0;
  for (int column = 20; column < given.columns() - 20; ++column) {
    const Vertex& v = mesh.vertices[middle + static_cast<std::size_t>(column)];
    EXPECT_NEAR(v.z, given.heights[middle + static_cast<std::size_t>(column)], 1e-6f);
    EXPECT_EQ(v.colour >> 24, 0u) << "ripples that are shapes are no picture, too";
    highest = std::max(highest, v.z);
    steepest = std::max(steepest, -v.normal_x / v.normal_z);
  }
  EXPECT_NEAR(highest, 2 + 0.5f * ripple_height, 1e-3f);
  const float phase = 2 * 3.14159265f / 0.8f / 9;  // of a step: the slope is that over two
  EXPECT_NEAR(steepest, 3.14159265f * ripple_height / 0.8f * std::sin(phase) / phase, 1e-3f);
}

TEST(NearGround, RipplesThatPointsCannotShowAreAPicture) {
  const CellRectangle cells{20, 20, 9, 9};
  NearGround given = rippled(cells, 5, [](int, int) { return 2.0f; });  // four points a wave
  given.ripples = false;
  TerrainLook look;
  look.ripples = true;
  const Mesh mesh = near_ground_mesh(given, grid_of(cells), ground_of([](int, int) { return 2.0f; }), look);
  float highest = 0;
  for (const Vertex& v : mesh.vertices) {
    highest = std::max(highest, std::fabs(v.z - 2));
    EXPECT_EQ(v.colour >> 24, 255u);
  }
  EXPECT_LT(highest, 0.3f * 0.5f * ripple_height);
  const BlockLayout layout(64, 64);
  EXPECT_TRUE(near_window(layout, 1, 32, 32, 0.02, 0.06).ripples) << "with points of a centimetre";
  EXPECT_FALSE(near_window(layout, 1, 32, 32, 0.06, 0.06).ripples) << "from farther away";
  EXPECT_NEAR(1.0 / near_window(layout, 1, 32, 32, 0.02, 0.06).divisions, 0.01, 0.001);
  EXPECT_NEAR(1.0 / near_window(layout, 1, 32, 32, 0.06, 0.06).divisions, 0.06, 0.01);
}

TEST(NearGround, UnknownGroundIsLeftOut) {
  const CellRectangle cells{20, 20, 4, 4};
  const Height holed = [](int x, int y) { return x == 21 && y == 22 ? unknown : 1.0f; };
  NearGround near = rippled(cells, 3, [](int, int) { return 1.0f; });
  const Mesh mesh = near_ground_mesh(near, grid_of(cells), ground_of(holed), {});
  EXPECT_LT(mesh.surface_indices, 6u * 9 * 9);
  EXPECT_GT(mesh.surface_indices, 0u);
  for (const Vertex& v : mesh.vertices) EXPECT_TRUE(std::isfinite(v.x + v.y + v.z + v.normal_x + v.normal_z));
  EXPECT_TRUE(near_ground_mesh({}, grid_of(), ground_of(dunes), {}).empty());
}

TEST(View, ItsMiddleMeetsTheGroundThatItLooksAt) {
  const View view(perspective(), camera_at(10, 20, 30, -90), 600);
  const HeightField field{64, 64, 1, [](int, int) { return 1.0f; }};
  const auto hit = first_hit(field, view.middle());
  ASSERT_TRUE(hit);
  EXPECT_NEAR((*hit - Point(10, 20, 1)).norm(), 0, 1e-6);
}

}  // namespace
