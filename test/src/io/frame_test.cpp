#include "src/io/frame.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace desert_sim {
namespace {

constexpr int side = 64;

/// Hills of 20 m about a height.
double hills(int x, int y, double height) { return height + 20 * std::sin(0.3 * x) * std::cos(0.25 * y); }

template <class Value>
Raster raster(const Value& value) {
  Raster r;
  r.width = r.height = side;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) r.values.push_back(static_cast<float>(value(x, y)));
  return r;
}

/// Of a raster that was turned by some degrees: four triangles, each along one edge.
bool in_collar(int x, int y) { return 10 * x < y || 10 * (side - 1 - x) < side - 1 - y || y < x / 10; }

TEST(FrameOf, ARotatedRasterIsFound) {
  const auto found = find_frame(raster([](int x, int y) { return in_collar(x, y) ? 0 : hills(x, y, 850); }));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->value, 0);
  EXPECT_NEAR(found->step, 850, 20);
  long long cells = 0;
  for (int i = 0; i < side * side; ++i) cells += in_collar(i % side, i / side);
  EXPECT_EQ(found->cells, cells);
}

TEST(FrameOf, APlateauIsFound) {
  EXPECT_TRUE(find_frame(raster([](int x, int y) { return in_collar(x, y) ? -9999 : 850; })));
}

TEST(FrameOf, ASeaAroundAnIslandIsNone) {
  EXPECT_FALSE(
      find_frame(raster([](int x, int y) { return std::max(0.0, 200 - 8 * std::hypot(x - 32, y - 32)); })));
}

TEST(FrameOf, GroundThatReachesTheEdgeIsNone) {
  EXPECT_FALSE(find_frame(raster([](int x, int y) { return hills(x, y, 850); })));
  EXPECT_FALSE(find_frame(raster([](int, int) { return 850; })));
  EXPECT_FALSE(find_frame(raster([](int x, int) { return x < 32 ? 100 : 200; }))) << "a cliff";
  EXPECT_FALSE(find_frame(raster([](int x, int y) { return x == 30 && y == 30 ? 0 : hills(x, y, 850); })));
}

TEST(FrameOf, AFlatEdgeOfWholeNumbersIsNone) {
  EXPECT_FALSE(find_frame(raster([](int x, int y) {
    return x < 2 || y < 2 || x > side - 3 || y > side - 3 ? 848 : std::round(850 + 0.06 * hills(x, y, 0));
  }))) << "neighbours are mostly equal, and a step of two metres is no cliff among steps of one";
}

TEST(FrameOf, APartOfItIsFoundInAPart) {
  const auto frame_in_the_west = [](int x, int y) { return x < 8 ? 0 : hills(x, y, 850); };
  EXPECT_FALSE(find_frame(raster(frame_in_the_west)));
  const auto found = find_frame(raster(frame_in_the_west), true);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->cells, 8 * side);
  EXPECT_EQ(found->cell % side, 0u);
  EXPECT_FALSE(find_frame(raster([](int x, int y) { return hills(x, y, 850); }), true));
}

TEST(FrameOf, ASmallRasterIsNone) {
  Raster r;
  r.width = r.height = 1;
  r.values = {3};
  EXPECT_FALSE(find_frame(r));
}

}  // namespace
}  // namespace desert_sim
