// Which level of detail a block has, in perspective and orthographic views.

#include "src/render/level_of_detail.hpp"

#include <gtest/gtest.h>

#include "test/src/render/fields.hpp"

namespace {

using namespace render_test;

constexpr int picture_height = 800;  // [pixels]

std::vector<int> levels_of(const BlockLayout& layout, const View& view,
                           DetailLimits limits = {4, 100000000}) {
  const std::vector<Box> boxes = flat_boxes(layout, 1);
  return choose_levels(layout, 1, view, boxes, std::vector<int>(boxes.size(), -1), limits);
}

std::int64_t triangles_seen(const BlockLayout& layout, const View& view, const std::vector<int>& levels) {
  const std::vector<Box> boxes = flat_boxes(layout, 1);
  std::int64_t count = 0;
  for (int block = 0; block < layout.count(); ++block)
    if (view.sees(boxes[static_cast<std::size_t>(block)]))
      count += surface_triangles(layout, block, levels[static_cast<std::size_t>(block)]);
  return count;
}

TEST(LevelOfDetail, IsCoarserWithDistance) {
  const BlockLayout layout(1024, 1024);
  const View view(perspective(), camera_at(512, -10, 20, -10), picture_height);
  const std::vector<int> levels = levels_of(layout, view);
  int before = 0;
  for (int row = 0; row < layout.rows(); ++row) {
    const int level = levels[static_cast<std::size_t>(row * layout.columns() + layout.columns() / 2)];
    EXPECT_GE(level, before);
    before = level;
  }
  EXPECT_EQ(levels[static_cast<std::size_t>(layout.columns() / 2)], 0);
  EXPECT_GE(before, 2);
}

// Complaint 7: the wrong level of detail in the top-down view, where the camera's distance says nothing.
TEST(Complaint7, OrthographicViewsHaveOneLevelByScaleWhereverTheCameraIs) {
  const BlockLayout layout(1024, 1024);
  for (const double height : {-500.0, 10.0, 50000.0}) {
    for (const auto& [metres, level] : {std::pair(100.0, 0), std::pair(800.0, 2), std::pair(3200.0, 4)}) {
      const View view(orthographic(metres), camera_at(512, 512, height, -90), picture_height);
      ASSERT_TRUE(view.orthographic());
      const std::vector<int> levels = levels_of(layout, view);
      // A pixel is metres / 800 wide, and a quad four pixels.
      for (const int one : levels) EXPECT_EQ(one, level) << metres << " m, camera at " << height << " m";
    }
  }
}

/// From far away a block that was drawn at the level before the coarsest one kept that.
TEST(Complaint7, TheCoarsestLevelIsReachedFromEachOther) {
  const BlockLayout layout(1024, 1024);
  const std::vector<Box> boxes = flat_boxes(layout, 1);
  const View view(orthographic(8000), camera_at(512, 512, 100, -90), picture_height);
  for (int present = -1; present <= BlockLayout::max_level; ++present)
    for (const int level :
         choose_levels(layout, 1, view, boxes, std::vector<int>(boxes.size(), present), {4, 100000000}))
      EXPECT_EQ(level, BlockLayout::max_level) << "from " << present;
}

TEST(Complaint7, PerspectiveFromAboveAgreesWithTheOrthographicViewOfThatScale) {
  const BlockLayout layout(256, 256);
  const View from_above(perspective(), camera_at(128, 128, 900, -90),
                        picture_height);  // 1600 m at the ground
  const View top_down(orthographic(1800), camera_at(128, 128, 900, -90), picture_height);
  EXPECT_EQ(levels_of(layout, from_above), levels_of(layout, top_down));
}

// Complaint 1: big maps stall rviz.
TEST(Complaint1, TheNumberOfTrianglesIsBoundedOnGridsOfAnySize) {
  for (const int side : {256, 1024, 2048, 4096}) {
    const BlockLayout layout(side, side);
    for (const double pitch : {-90.0, -30.0, -5.0}) {
      const View view(perspective(), camera_at(0.5 * side, 0, 40, pitch), picture_height);
      EXPECT_LE(triangles_seen(layout, view, levels_of(layout, view, {1, 100000})), 100000)
          << side << " cells, pitch " << pitch;
    }
    const View all(orthographic(side), camera_at(0.5 * side, 0.5 * side, 100, -90), picture_height);
    EXPECT_LE(triangles_seen(layout, all, levels_of(layout, all, {1, 100000})), 100000);
    EXPECT_LE(layout.count(), 1024) << "draw calls";
  }
}

TEST(LevelOfDetail, StaysWhileTheCameraMovesALittle) {
  const BlockLayout layout(64, 64);
  const std::vector<Box> boxes = flat_boxes(layout, 1);
  int changes = 0;
  std::vector<int> levels{-1};
  for (int n = 0; n < 100; ++n) {
    const double metres = 400 * (1 + 0.05 * std::sin(0.7 * n));  // around the border between two levels
    const View view(orthographic(metres), camera_at(32, 32, 10, -90), picture_height);
    const std::vector<int> next = choose_levels(layout, 1, view, boxes, levels, {4, 100000});
    changes += next != levels ? 1 : 0;
    levels = next;
  }
  EXPECT_EQ(changes, 1) << "the first choice";
}

TEST(View, SeesWhatIsInThePicture) {
  const View view(perspective(), camera_at(0, 0, 100, -90), picture_height);
  const auto box = [](double x, double y) { return Box(Point(x - 1, y - 1, 0), Point(x + 1, y + 1, 1)); };
  EXPECT_TRUE(view.sees(box(0, 0)));
  EXPECT_TRUE(view.sees(box(95, 95)));
  EXPECT_FALSE(view.sees(box(110, 0)));
  EXPECT_FALSE(view.sees(box(0, -110)));
  EXPECT_FALSE(view.sees(Box(Point(-1, -1, 150), Point(1, 1, 160)))) << "behind the camera";
  EXPECT_NEAR(view.distance(box(0, 0)), 99, 1e-9);
  EXPECT_NEAR(view.pixels_per_metre(box(0, 0)), 400 / 99.0, 1e-9);
}

}  // namespace
