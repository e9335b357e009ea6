// Few rectangles around many boxes.

#include "src/ros/topics/covering_boxes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace desert_sim {
namespace {

long cells(const std::vector<CellBox>& boxes) {
  long sum = 0;
  for (const CellBox& box : boxes) sum += static_cast<long>(box.width()) * box.height();
  return sum;
}

TEST(CoveringBoxes, OneIsTheBoundingBox) {
  const auto one = covering_boxes({{5, 6, 9, 8}, {70, 1, 71, 2}}, 1);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_TRUE(one[0].contains({5, 1, 71, 8}));
  EXPECT_EQ(cells(one), 66 * 7);
  EXPECT_TRUE(covering_boxes({}, 4).empty());
}

TEST(CoveringBoxes, WhatIsFarApartGetsRectanglesOfItsOwn) {
  std::vector<CellBox> boxes;  // two blobs along a diagonal, of four boxes each
  for (int n = 0; n < 4; ++n) {
    boxes.push_back({n % 2 * 10, n / 2 * 10, n % 2 * 10 + 10, n / 2 * 10 + 10});
    boxes.push_back({900 + n % 2 * 10, 700 + n / 2 * 10, 900 + n % 2 * 10 + 10, 700 + n / 2 * 10 + 10});
  }
  EXPECT_EQ(cells(covering_boxes(boxes, 2)), 800);
  EXPECT_EQ(covering_boxes(boxes, 5).size(), 2u) << "more would save nothing";
  EXPECT_EQ(covering_boxes(boxes, 5, 1000000).size(), 1u) << "they are not worth a message";
}

TEST(CoveringBoxes, EachBoxIsInOneOfThem) {
  std::mt19937 random(5);
  const auto below = [&random](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  for (int round = 0; round < 200; ++round) {
    std::vector<CellBox> boxes;
    for (int n = below(60); n >= 0; --n) {
      const int x = below(1000), y = below(1000);
      boxes.push_back({x, y, x + 1 + below(32), y + 1 + below(32)});
    }
    long last = cells(covering_boxes(boxes, 1));
    for (int most = 1; most <= 8; ++most) {
      const std::vector<CellBox> rectangles = covering_boxes(boxes, most);
      ASSERT_LE(rectangles.size(), static_cast<std::size_t>(most));
      for (const CellBox& box : boxes)
        ASSERT_TRUE(std::any_of(rectangles.begin(), rectangles.end(),
                                [&](const CellBox& rectangle) { return rectangle.contains(box); }));
      ASSERT_LE(cells(rectangles), last) << "more rectangles have no more cells";
      last = cells(rectangles);
    }
  }
}

}  // namespace
}  // namespace desert_sim
