// Meshes of blocks: no cracks between levels, holes where cells are unknown, normals that fit across edges.

#include "src/render/terrain_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

#include "src/render/contour_lines.hpp"
#include "test/src/render/fields.hpp"

namespace {

using namespace render_test;

/// The heights of a mesh's surface on the line x = `line`, by y; and those of the lower ends of its skirts.
struct Edge {
  std::map<float, float> surface, bottom;

  Edge(const Mesh& mesh, float line) {
    for (const Vertex& v : mesh.vertices) {
      if (v.x != line) continue;
      surface[v.y] = surface.count(v.y) ? std::max(surface[v.y], v.z) : v.z;
      bottom[v.y] = bottom.count(v.y) ? std::min(bottom[v.y], v.z) : v.z;
    }
  }
  float at(float y) const { return interpolate(surface, y); }
  float bottom_at(float y) const { return interpolate(bottom, y); }

 private:
  static float interpolate(const std::map<float, float>& line, float y) {
    auto above = line.lower_bound(y);
    if (above->first == y) return above->second;
    const auto below = std::prev(above);
    const float share = (y - below->first) / (above->first - below->first);
    return below->second + share * (above->second - below->second);
  }
};

TEST(TerrainMesh, BlocksOfOneLevelShareTheVerticesOfTheirEdge) {
  const BlockLayout layout(200, 130);
  const Edge west(block_of(layout, 0, 1, dunes), 64.5f), east(block_of(layout, 1, 1, dunes), 64.5f);
  EXPECT_EQ(west.surface, east.surface);
  EXPECT_EQ(west.surface.size(), 33u);
}

TEST(TerrainMesh, SkirtsCoverTheCracksBetweenLevels) {
  const BlockLayout layout(200, 130);
  for (int left = 0; left <= BlockLayout::max_level; ++left)
    for (int right = 0; right <= BlockLayout::max_level; ++right) {
      const Edge west(block_of(layout, 0, left, dunes), 64.5f),
          east(block_of(layout, 1, right, dunes), 64.5f);
      for (float y = 0.5f; y <= 64.5f; y += 0.25f) {
        const bool west_is_higher = west.at(y) >= east.at(y);
        const Edge& higher = west_is_higher ? west : east;
        EXPECT_LE(higher.bottom_at(y), std::min(west.at(y), east.at(y)) + 1e-5f)
            << "levels " << left << " and " << right << ", y = " << y;
      }
    }
}

TEST(TerrainMesh, SkirtsAreNoDeeperThanTheGroundNearby) {
  const BlockLayout layout(200, 130);
  const auto valley = [](int, int y) { return y < 10 ? -100.0f : 0.0f; };
  const Edge west(block_of(layout, 0, 0, valley), 64.5f);
  EXPECT_EQ(west.bottom_at(20.5f), -100);
  EXPECT_EQ(west.bottom_at(40.5f), 0);
}

TEST(TerrainMesh, TheOuterEdgeHasNoSkirt) {
  const BlockLayout layout(65, 65);
  ASSERT_EQ(layout.count(), 1);
  const Mesh mesh = block_of(layout, 0, 0, dunes);
  EXPECT_EQ(mesh.surface_indices, mesh.indices.size());
  EXPECT_EQ(mesh.indices.size(), 6u * 64 * 64);
}

/// From outside, the ends of skirts must not be seen below the terrain.
TEST(TerrainMesh, WallsGoDownToTheBaseWhereTheGridEnds) {
  const BlockLayout layout(129, 65);
  const CellWindow heights = window_of(layout.needed_cells(0, 0), dunes);
  const auto white = [](int, int, float, float, float) { return pack({1, 1, 1}); };
  const Mesh mesh = build_block(layout, 0, 0, 1, heights, white, -50);
  int wall_triangles = 0;
  for (std::size_t n = mesh.surface_indices; n < mesh.indices.size(); n += 3) {
    const Vertex &a = mesh.vertices[mesh.indices[n]], &b = mesh.vertices[mesh.indices[n + 1]],
                 &c = mesh.vertices[mesh.indices[n + 2]];
    if (std::min({a.z, b.z, c.z}) != -50) continue;
    ++wall_triangles;
    EXPECT_EQ(a.normal_z, 0);
    // Its outer side is the one that is seen: the normal by the order of its corners is that of its light.
    const float cross_x = (b.y - a.y) * (c.z - a.z) - (b.z - a.z) * (c.y - a.y);
    const float cross_y = (b.z - a.z) * (c.x - a.x) - (b.x - a.x) * (c.z - a.z);
    EXPECT_GT(cross_x * a.normal_x + cross_y * a.normal_y, 0);
  }
  EXPECT_EQ(wall_triangles, 3 * 64 * 2) << "west, south and north; in the east there is another block";
  const Edge seam(mesh, 64.5f);
  EXPECT_EQ(seam.bottom_at(0.5f), -50);
  EXPECT_GT(seam.bottom_at(1.5f), -9);
  EXPECT_EQ(build_block(layout, 0, 0, 1, heights, white).indices.size(), mesh.surface_indices + 64u * 6)
      << "without a base there is the skirt in the east alone";
}

TEST(TerrainMesh, TrianglesAreCounterClockwiseFromAbove) {
  const BlockLayout layout(40, 50);
  const Mesh mesh = block_of(layout, 0, 2, dunes);
  for (std::size_t n = 0; n < mesh.surface_indices; n += 3) {
    const Vertex &a = mesh.vertices[mesh.indices[n]], &b = mesh.vertices[mesh.indices[n + 1]],
                 &c = mesh.vertices[mesh.indices[n + 2]];
    EXPECT_GT((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x), 0);
  }
}

TEST(TerrainMesh, NormalsFitAcrossTheEdgesOfBlocks) {
  const BlockLayout layout(200, 130);
  std::map<float, Vertex> west;
  for (const Vertex& v : block_of(layout, 0, 0, dunes).vertices)
    if (v.x == 64.5f) west.emplace(v.y, v);
  for (const Vertex& v : block_of(layout, 1, 0, dunes).vertices) {
    if (v.x != 64.5f) continue;
    EXPECT_EQ(v.normal_x, west.at(v.y).normal_x);
    EXPECT_EQ(v.normal_y, west.at(v.y).normal_y);
    EXPECT_EQ(v.normal_z, west.at(v.y).normal_z);
  }
}

TEST(TerrainMesh, APlaneHasItsNormalEverywhere) {
  const BlockLayout layout(100, 70);
  for (int level : {0, 3})
    for (const Vertex& v :
         block_of(
             layout, 1, level,
             [](int x, int y) { return static_cast<float>(x) - 0.5f * static_cast<float>(y); }, 2)
             .vertices) {
      const float length = std::sqrt(1 + 0.25f + 0.0625f);  // slopes are half of those in cells
      EXPECT_NEAR(v.normal_x, -0.5f / length, 1e-5f);
      EXPECT_NEAR(v.normal_y, 0.25f / length, 1e-5f);
      EXPECT_NEAR(v.normal_z, 1 / length, 1e-5f);
    }
}

// Complaint 4: NaN crashes OGRE.
TEST(Complaint4, UnknownCellsAreHolesAndReachNoVertex) {
  const BlockLayout layout(65, 65);
  const auto height = [](int x, int y) {
    return x > 20 && x < 30 && y > 5 && y < 40 ? unknown : dunes(x, y);
  };
  for (int level = 0; level <= BlockLayout::max_level; ++level) {
    const Mesh mesh = block_of(layout, 0, level, height);
    ASSERT_FALSE(mesh.empty());
    for (const Vertex& v : mesh.vertices)
      for (const float value : {v.x, v.y, v.z, v.normal_x, v.normal_y, v.normal_z})
        EXPECT_TRUE(std::isfinite(value));
    const Box box = bounding_box(mesh);
    EXPECT_TRUE(std::isfinite(box.min().z()) && std::isfinite(box.max().z()));
  }
  const Mesh fine = block_of(layout, 0, 0, height);
  for (std::size_t n = 0; n < fine.indices.size(); n += 3) {
    float x = 0, y = 0;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      x += fine.vertices[fine.indices[n + corner]].x / 3;
      y += fine.vertices[fine.indices[n + corner]].y / 3;
    }
    EXPECT_FALSE(x > 21.5f && x < 29.5f && y > 6.5f && y < 39.5f)
        << "a triangle in the hole: " << x << ", " << y;
  }
}

TEST(Complaint4, ATerrainOfUnknownCellsHasNoMesh) {
  const BlockLayout layout(65, 65);
  const Mesh mesh = block_of(layout, 0, 0, [](int, int) { return unknown; });
  EXPECT_TRUE(mesh.empty());
  EXPECT_TRUE(contour_lines(mesh, 1).empty());
}

TEST(TerrainMesh, OneUnknownCellLeavesTheTrianglesAroundIt) {
  const BlockLayout layout(5, 5);
  const Mesh mesh = block_of(layout, 0, 0, [](int x, int y) { return x == 2 && y == 2 ? unknown : 0.0f; });
  EXPECT_EQ(mesh.indices.size(), 3u * (2 * 12 + 4))
      << "each of the four quads at the cell keeps one triangle";
}

TEST(TerrainMesh, WaterEndsInTheGround) {
  const CellRectangle cells{0, 0, 20, 5};
  const CellWindow ground = window_of(cells, [](int x, int) { return 0.1f * static_cast<float>(x); });
  const CellWindow depth =
      window_of(cells, [](int x, int) { return std::max(0.0f, 0.95f - 0.1f * static_cast<float>(x)); });
  const CellWindow water = water_surface(ground, depth, 0);
  EXPECT_FLOAT_EQ(water.at(0, 2), 0.95f);
  EXPECT_FLOAT_EQ(water.at(9, 2), 0.95f);
  EXPECT_FLOAT_EQ(water.at(10, 2), 0.95f) << "level beyond the shore, where the ground hides it";
  EXPECT_TRUE(std::isnan(water.at(11, 2)));
}

TEST(ContourLines, LieOnTheirHeights) {
  const BlockLayout layout(65, 65);
  const Mesh mesh = block_of(layout, 0, 0, [](int x, int) { return 0.1f * static_cast<float>(x); });
  const Mesh lines = contour_lines(mesh, 1);
  ASSERT_FALSE(lines.empty());
  std::map<float, float> length;  // by height
  for (std::size_t n = 0; n + 1 < lines.indices.size(); n += 2) {
    const Vertex &a = lines.vertices[lines.indices[n]], &b = lines.vertices[lines.indices[n + 1]];
    EXPECT_EQ(a.z, b.z);
    length[a.z] += std::hypot(b.x - a.x, b.y - a.y);
  }
  EXPECT_EQ(length.size(), 7u) << "0, 1, ... 6 m";
  for (const auto& [z, metres] : length) {
    EXPECT_EQ(z, std::round(z));
    EXPECT_NEAR(metres, 64, 0.01) << "each line crosses the whole block once, at " << z << " m";
  }
}

}  // namespace
