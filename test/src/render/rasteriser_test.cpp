// Pictures without a screen: the camera shows its subject, and the nearest surface wins.

#include "src/render/rasteriser.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using namespace desert_sim::render;

constexpr int width = 160, height = 90;
const Box subject(Point(0, 0, -2), Point(300, 200, 25));
constexpr Colour red{1, 0, 0}, green{0, 1, 0}, white{1, 1, 1};

Point corner(const Box& box, int n) { return box.corner(static_cast<Box::CornerType>(n)); }

TEST(Camera, ShowsAllOfItsSubjectAndFillsThePicture) {
  for (double azimuth : {-60.0, 0.0, 123.0, 270.0})
    for (double elevation : {1.0, 32.0, 90.0}) {
      const Projection projection({azimuth, elevation}, subject, width, height);
      double left = width, right = 0, top = height, bottom = 0;
      for (int n = 0; n < 8; ++n) {
        const PicturePoint p = projection.project(corner(subject, n));
        ASSERT_TRUE(p.in_front);
        EXPECT_LT(p.depth, 0);
        left = std::min(left, p.column);
        right = std::max(right, p.column);
        top = std::min(top, p.row);
        bottom = std::max(bottom, p.row);
      }
      EXPECT_GE(left, 0);
      EXPECT_LE(right, width);
      EXPECT_GE(top, 0);
      EXPECT_LE(bottom, height);
      EXPECT_NEAR(std::max((right - left) / width, (bottom - top) / height), 0.95, 1e-6);
    }
}

TEST(Camera, StandsWhereItsAzimuthSays) {
  const Projection from_south({-90, 30}, subject, width, height);
  const PicturePoint near = from_south.project({150, 0, 0}), far = from_south.project({150, 200, 0});
  EXPECT_LT(near.depth, far.depth);
  EXPECT_GT(near.row, far.row);
  EXPECT_LT(from_south.project({0, 100, 0}).column, from_south.project({300, 100, 0}).column)
      << "east is right";
}

TEST(Camera, ZoomEnlargesTheMiddle) {
  const Projection whole({-60, 40, 1}, subject, width, height), half({-60, 40, 2}, subject, width, height);
  const PicturePoint a = whole.project({100, 60, 5}), b = half.project({100, 60, 5});
  EXPECT_NEAR(b.column - width / 2.0, 2 * (a.column - width / 2.0), 1e-9);
  EXPECT_NEAR(b.row - height / 2.0, 2 * (a.row - height / 2.0), 1e-9);
}

/// A level square around the middle of the subject.
Mesh square(float z, const Colour& colour, float alpha = 1) {
  const PackedColour packed = pack(colour, alpha);
  Mesh mesh;
  for (const auto& [x, y] : {std::pair{100.0f, 60.0f}, {200.0f, 60.0f}, {200.0f, 140.0f}, {100.0f, 140.0f}})
    mesh.vertices.push_back({x, y, z, 0, 0, 1, packed});
  mesh.indices = {0, 1, 2, 0, 2, 3};
  mesh.surface_indices = mesh.indices.size();
  return mesh;
}

std::vector<PackedColour> background_of(const Colour& colour) {
  return std::vector<PackedColour>(std::size_t{4} * width * height, pack(colour));
}

class Drawing : public ::testing::Test {
 protected:
  Drawing() { rasteriser_.clear(background_of(white)); }
  PackedColour at(double x, double y, double z) const {
    const PicturePoint p = projection_.project({x, y, z});
    const Picture picture = rasteriser_.picture();
    return picture
        .pixels[static_cast<std::size_t>(p.row / 2) * width + static_cast<std::size_t>(p.column / 2)];
  }
  const Projection projection_{{-70, 50}, subject, 2 * width, 2 * height};
  Rasteriser rasteriser_{width, height, 2};
};

TEST_F(Drawing, TheNearestSurfaceWinsInAnyOrder) {
  rasteriser_.draw(square(10, red), projection_, 1);
  rasteriser_.draw(square(0, green), projection_, 1);
  EXPECT_EQ(at(150, 100, 10), pack(red));
  rasteriser_.draw(square(20, green), projection_, 1);
  EXPECT_EQ(at(150, 100, 20), pack(green));
}

TEST_F(Drawing, HeightsAreExaggerated) {
  rasteriser_.draw(square(10, red), projection_, 1);
  rasteriser_.draw(square(6, green), projection_, 2);
  EXPECT_EQ(at(150, 100, 12), pack(green));
}

TEST_F(Drawing, ThereAreNoHolesBetweenTriangles) {
  rasteriser_.draw(square(0, red), projection_, 1);
  for (double x = 106; x < 194; x += 1.7)
    for (double y = 67; y < 132; y += 1.3) ASSERT_EQ(at(x, y, 0), pack(red)) << x << ", " << y;
}

TEST_F(Drawing, BlendedSurfacesCoverByTheirAlphaAndHideNothing) {
  rasteriser_.draw(square(0, red), projection_, 1);
  rasteriser_.blend(square(10, green, 0.5f), projection_, 1);
  const PackedColour mixed = at(150, 100, 10);
  EXPECT_NEAR(mixed & 255, 127, 2);
  EXPECT_NEAR(mixed >> 8 & 255, 128, 2);
  rasteriser_.blend(square(-5, green, 0.5f), projection_, 1);
  EXPECT_EQ(at(150, 100, 10), mixed) << "below the ground";
}

TEST_F(Drawing, LinesOnASurfaceAreSeenAndThoseBelowAreNot) {
  rasteriser_.draw(square(0, red), projection_, 1);
  Mesh line;
  for (float z : {0.0f, -3.0f})
    for (float x : {110.0f, 190.0f})
      line.vertices.push_back({x, z < 0 ? 80.0f : 120.0f, z, 0, 0, 1, pack(green)});
  line.indices = {0, 1, 2, 3};
  rasteriser_.draw_lines(line, projection_, 1);
  EXPECT_GT(at(150, 120, 0) >> 8 & 255, 60u);
  const PicturePoint hidden = projection_.project({150, 80, -3});
  const Picture picture = rasteriser_.picture();
  EXPECT_EQ(picture.pixels[static_cast<std::size_t>(hidden.row / 2) * width +
                           static_cast<std::size_t>(hidden.column / 2)],
            pack(red));
}

TEST_F(Drawing, WhatIsOutsideOrBehindTheCameraIsLeftOut) {
  Mesh outside = square(0, red);
  for (Vertex& v : outside.vertices) v.x += 1e5f;
  rasteriser_.draw(outside, projection_, 1);
  Mesh behind = square(1e6f, red);
  rasteriser_.draw(behind, projection_, 1);
  const Picture picture = rasteriser_.picture();
  EXPECT_EQ(std::count(picture.pixels.begin(), picture.pixels.end(), pack(white)), width * height);
}

}  // namespace
