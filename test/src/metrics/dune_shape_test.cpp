// The measures of dunes, on shapes whose answers are known.

#include "test/support/dune_shape.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "src/metrics/correlation.hpp"
#include "src/metrics/crest_orientation.hpp"
#include "src/metrics/slip_faces.hpp"
#include "test/support/imprint.hpp"

namespace desert_sim {
namespace {

constexpr double pi = 3.14159265358979323846;

template <class Value>
Field made(int width, int height, double cell_size, const Value& value) {
  Field f;
  f.width = width;
  f.height = height;
  f.cell_size = cell_size;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) f.values.push_back(static_cast<float>(value(x, y)));
  return f;
}

/// Parallel ridges `wavelength` cells apart whose crests run along `crest_deg`. The grid need not repeat.
Field waves(int n, double cell_size, double wavelength, double crest_deg) {
  const double nx = -std::sin(crest_deg * pi / 180), ny = std::cos(crest_deg * pi / 180);
  Field f =
      made(n, n, cell_size, [&](int x, int y) { return std::sin(2 * pi * (x * nx + y * ny) / wavelength); });
  f.periodic = false;
  return f;
}

TEST(DuneShape, AnglesWrap) {
  EXPECT_DOUBLE_EQ(angle_between_deg(350, 10), 20);
  EXPECT_DOUBLE_EQ(angle_between_deg(-170, 170), 20);
  EXPECT_DOUBLE_EQ(line_angle_between_deg(5, 176), 9);
  EXPECT_DOUBLE_EQ(line_angle_between_deg(0, 90), 90);
}

TEST(DuneShape, QuantileOfNumbers) {
  EXPECT_EQ(quantile({3, 1, 2}, 0.5), 2);
  EXPECT_EQ(quantile({}, 0.5), 0);
}

TEST(DuneShape, CrestOrientationOfWaves) {
  for (double crest : {0.0, 30.0, 75.0, 90.0, 120.0, 179.0}) {
    const Orientation o = crest_orientation(waves(128, 2.0, 20, crest), 2.0);
    EXPECT_LT(line_angle_between_deg(o.crest_deg, crest), 2) << crest;
    EXPECT_GT(o.coherence, 0.9) << crest;
  }
}

TEST(DuneShape, CrestsOfACheckerboardHaveNoDirection) {
  const Field f =
      made(96, 96, 1, [](int x, int y) { return std::sin(2 * pi * x / 16) * std::sin(2 * pi * y / 16); });
  EXPECT_LT(crest_orientation(f, 1).coherence, 0.01);
}

TEST(DuneShape, WavelengthOfWaves) {
  const Field f = made(160, 160, 0.5, [](int x, int) { return std::sin(2 * pi * x / 20.0); });
  EXPECT_NEAR(wavelength(f, 0).value(), 10, 0.1);
  EXPECT_FALSE(wavelength(f, 90));
  EXPECT_NEAR(wavelength(waves(160, 1, 16, 60), 150).value(), 16, 0.5);
  EXPECT_NEAR(roughness(f), std::sqrt(0.5), 1e-3);
}

TEST(DuneShape, SlopesOfARoof) {
  // Falls at 30 degrees to both sides of y = 32, across a periodic grid.
  const double rise = std::tan(30 * pi / 180);
  const Field f = made(64, 64, 1, [&](int, int y) { return rise * std::abs(32 - y); });
  const std::vector<double> histogram = slope_histogram(f, 10);
  EXPECT_NEAR(histogram[2] + histogram[3], 62.0 / 64, 1e-9);
  EXPECT_NEAR(histogram[0], 2.0 / 64, 1e-9);
  std::vector<double> directions = slip_face_directions(f);
  std::sort(directions.begin(), directions.end());
  ASSERT_EQ(directions.size(), 2u);
  EXPECT_NEAR(directions[0], 90, 5);
  EXPECT_NEAR(directions[1], 270, 5);
}

TEST(DuneShape, PyramidHasFourSlipFaces) {
  const Field f = made(64, 64, 1, [](int x, int y) {
    return std::max(0.0, 15 - 0.65 * std::max(std::abs(x - 32), std::abs(y - 32)));
  });
  EXPECT_EQ(slip_face_directions(f).size(), 4u);
}

TEST(DuneShape, NoSlipFacesOnGentleGround) {
  const Field f = made(64, 64, 1, [](int x, int) { return std::sin(2 * pi * x / 64); });
  EXPECT_TRUE(slip_face_directions(f).empty());
}

/// A wedge with a stoss side of 10 and a lee side of 32 degrees, 24 m wide, and two horns of `horn` metres
/// that are 1 m high and run downwind along its flanks. Wind to the east; the crest 5 m high at x = 40 (and
/// 60 % of it elsewhere across, so that there is one highest row).
Field barchan(double horn, int shift_x, int shift_y) {
  const double stoss = std::tan(10 * pi / 180), lee = std::tan(32 * pi / 180);
  return made(128, 64, 1, [&](int px, int py) {
    const int x = ((px - shift_x) % 128 + 128) % 128, y = ((py - shift_y) % 64 + 64) % 64;
    const int across = y - 32;
    if (std::abs(across) > 12) return 0.0;
    const double height = 5 - 0.05 * std::abs(across);
    const double ridge = std::max(0.0, std::min(height - stoss * (40 - x), height - lee * (x - 40)));
    const bool on_horn = std::abs(across) > 9 && x >= 40 && x <= 48 + horn;
    return std::max(ridge, on_horn ? 1.0 : 0.0);
  });
}

TEST(DuneShape, ShapeOfABarchan) {
  const Field f = barchan(12, 0, 0);
  const std::vector<DuneShape> dunes = find_dunes(f, f, 0, 0.3);
  ASSERT_EQ(dunes.size(), 1u);
  const DuneShape& d = dunes[0];
  EXPECT_NEAR(d.height, 5, 1e-6);
  EXPECT_NEAR(d.width, 25, 1e-6);
  EXPECT_NEAR(d.crest_x, 40.5, 1e-6);
  EXPECT_NEAR(d.crest_y, 32.5, 1e-6);
  EXPECT_NEAR(d.stoss_deg, 10, 0.3);
  EXPECT_NEAR(d.slip_face_deg, 32, 0.5);
  EXPECT_LT(angle_between_deg(d.slip_direction_deg, 0), 5);
  EXPECT_NEAR(d.horn_reach, 13, 1.5);
  EXPECT_LT(angle_between_deg(d.horn_direction_deg, 0), 10);
  EXPECT_GT(d.slip_share, 0.05);
}

TEST(DuneShape, HornsUpwindAreTold) {
  Field f = barchan(12, 0, 0);
  std::reverse(f.values.begin(), f.values.end());  // turned by 180 degrees: horns to the west
  const std::vector<DuneShape> dunes = find_dunes(f, f, 0, 0.3);
  ASSERT_EQ(dunes.size(), 1u);
  EXPECT_LT(dunes[0].horn_reach, 0);
  EXPECT_GT(angle_between_deg(dunes[0].slip_direction_deg, 0), 170);
}

TEST(DuneShape, TheBorderDoesNotCutADune) {
  const Field middle = barchan(12, 0, 0), across = barchan(12, 85, 30);
  const DuneShape a = find_dunes(middle, middle, 0)[0], b = find_dunes(across, across, 0)[0];
  EXPECT_EQ(find_dunes(across, across, 0).size(), 1u);
  EXPECT_EQ(a.cells, b.cells);
  EXPECT_NEAR(a.width, b.width, 1e-6);
  EXPECT_NEAR(a.stoss_deg, b.stoss_deg, 1e-3);
  EXPECT_NEAR(a.slip_face_deg, b.slip_face_deg, 1e-3);
  EXPECT_NEAR(a.horn_reach, b.horn_reach, 1e-6);
  EXPECT_NEAR(std::remainder(b.x - a.x - 85, 128), 0, 1e-3);
  Field closed = across;
  closed.periodic = false;
  EXPECT_GT(find_dunes(closed, closed, 0, 0.3, 1).size(), 1u);
}

TEST(DuneShape, WindDirectionTurnsTheMeasures) {
  // The same dune under a wind to the north.
  const Field east = barchan(12, 0, 0);
  const Field north = made(64, 128, 1, [&](int x, int y) { return east.at(y, 63 - x); });
  const DuneShape a = find_dunes(east, east, 0)[0], b = find_dunes(north, north, 90)[0];
  EXPECT_NEAR(a.width, b.width, 1e-6);
  EXPECT_NEAR(a.length, b.length, 1e-6);
  EXPECT_NEAR(a.stoss_deg, b.stoss_deg, 0.1);
  EXPECT_LT(angle_between_deg(b.slip_direction_deg, 90), 5);
  EXPECT_LT(angle_between_deg(b.horn_direction_deg, 90), 10);
}

TEST(DuneShape, SeparateDunesAreCountedLargestFirst) {
  const Field f = made(64, 64, 1, [](int x, int y) {
    const auto cone = [&](double cx, double cy, double r) {
      return std::max(0.0, r - std::hypot(x - cx, y - cy)) * 0.5;
    };
    return cone(16, 16, 8) + cone(48, 16, 11) + cone(32, 48, 5);
  });
  const std::vector<DuneShape> dunes = find_dunes(f, f, 0, 0.2, 10);
  ASSERT_EQ(dunes.size(), 3u);
  EXPECT_NEAR(dunes[0].x, 48.5, 0.1);
  EXPECT_NEAR(dunes[1].x, 16.5, 0.1);
  EXPECT_NEAR(dunes[0].height, 5.5, 0.1);
  EXPECT_GT(dunes[1].volume, dunes[2].volume);
}

TEST(DuneShape, ImprintOfTiles) {
  unsigned state = 1;
  const auto noise = [&] {
    state = state * 1664525u + 1013904223u;
    return (state >> 8) / 16777216.0;
  };
  const Field plain = made(192, 192, 1, [&](int, int) { return noise(); });
  EXPECT_LT(imprint({plain}, 32), 0.2);
  const Field columns = made(192, 192, 1, [&](int x, int) { return noise() + (x / 32) % 2; });
  EXPECT_GT(imprint({columns}, 32), 3);
  const Field rows = made(192, 192, 1, [&](int, int y) { return noise() + (y / 32) % 2; });
  EXPECT_GT(imprint({rows}, 32), 3);
  EXPECT_LT(imprint({rows}, 31), 1) << "seams of another period";
}

TEST(DuneShape, LaneBeforeAWall) {
  const Field wall = made(64, 16, 0.5, [](int x, int) { return x >= 40 && x < 50 ? 1.0 : 0.0; });
  const Field sand = made(64, 16, 0.5, [](int x, int) {
    if (x >= 20 && x < 32) return 2.0 - 0.3 * std::abs(x - 26);
    return x < 20 ? 0.1 : 0.0;
  });
  const WallFront front = wall_front(sand, wall, 4, 12, 0.3, 20);
  EXPECT_NEAR(front.lane, 4.0, 1e-9);  // cells 32…39 are free
  EXPECT_NEAR(front.dune_height, 2, 1e-6);
  EXPECT_NEAR(front.dune_distance, 6.75, 1e-9);
}

TEST(DuneShape, SmoothingKeepsTheMean) {
  const Field f = made(32, 32, 1, [](int x, int y) { return x == 7 && y == 9 ? 1.0 : 0.0; });
  const Field s = smoothed(f, 2);
  double sum = 0;
  for (float v : s.values) sum += v;
  EXPECT_NEAR(sum, 1, 1e-4);
  EXPECT_NEAR(s.at(7, 9), 1 / (2 * pi * 4), 2e-3);
}

}  // namespace
}  // namespace desert_sim
