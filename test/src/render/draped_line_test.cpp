// Lines on the terrain, and the ruler's figures.

#include "src/render/draped_line.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "test/src/render/fields.hpp"

namespace {

using namespace render_test;

TEST(DrapedLine, MeasuresASlope) {
  const HeightField slope{100, 100, 1, [](int x, int) { return 0.75f * static_cast<float>(x); }};
  const Measurement m = measure(drape(slope, {{10, 50}, {50, 50}}));
  EXPECT_NEAR(m.horizontal, 40, 1e-9);
  EXPECT_NEAR(m.height_difference, 30, 1e-6);
  EXPECT_NEAR(m.along_surface, 50, 1e-6);
  EXPECT_NEAR(m.slope, std::atan(0.75), 1e-9);
  EXPECT_NEAR(measure(drape(slope, {{50, 50}, {10, 50}})).slope, -std::atan(0.75), 1e-9);
}

TEST(DrapedLine, IsLongerOverARidge) {
  const HeightField ridge{100, 10, 1,
                          [](int x, int) { return 50.0f - std::abs(static_cast<float>(x) - 50); }};
  const Measurement m = measure(drape(ridge, {{30.5, 5}, {70.5, 5}}));
  EXPECT_NEAR(m.height_difference, 0, 1e-6);
  EXPECT_NEAR(m.slope, 0, 1e-9);
  EXPECT_NEAR(m.along_surface, 40 * std::sqrt(2.0), 1e-6);
}

TEST(DrapedLine, HasGapsWhereTheGroundIsUnknown) {
  const float unknown = std::numeric_limits<float>::quiet_NaN();
  const HeightField hole{100, 10, 1, [&](int x, int) { return x > 40 && x < 60 ? unknown : 2.0f; }};
  const std::vector<Point> line = drape(hole, {{10, 5}, {90, 5}});
  const Measurement m = measure(line);
  EXPECT_TRUE(std::isnan(m.along_surface));
  EXPECT_NEAR(m.height_difference, 0, 1e-9);
  Mesh mesh;
  append_line(mesh, line, 3, pack({1, 1, 1}));
  ASSERT_FALSE(mesh.empty());
  for (std::size_t n = 0; n < mesh.indices.size(); n += 2) {
    const Vertex &a = mesh.vertices[mesh.indices[n]], &b = mesh.vertices[mesh.indices[n + 1]];
    EXPECT_LE(b.x - a.x, 1.001f) << "no line crosses the hole";
    EXPECT_EQ(a.z, 6) << "heights are exaggerated";
  }
}

TEST(DrapedLine, IsBounded) {
  const HeightField flat{10000, 10000, 0.1, [](int, int) { return 0.0f; }};
  EXPECT_LE(drape(flat, {{0, 0}, {1000, 1000}}).size(), 4096u);
  EXPECT_LE(drape(flat, circle({500, 500}, 400)).size(), 4096u);
  EXPECT_GE(drape(flat, circle({500, 500}, 0.01)).size(), 96u);
}

}  // namespace
