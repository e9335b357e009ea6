// Dunes of known place, size and speed.

#include <cmath>

#include "src/tools/dune_tracker.hpp"
#include "test/support/refusal.hpp"
#include "test/support/run_fixture.hpp"

namespace desert_sim {
namespace {

constexpr double pi_here = 3.14159265358979;
constexpr DuneLimits usual{0.25, 0.5};

struct Heap {
  double x, y, height, sigma;
};

/// Gaussian heaps on a grid of 120 x 80 cells of 2 m; over its borders they go on.
DuneField field(const std::vector<Heap>& heaps, bool periodic = true) {
  DuneField f{120, 80, 2, 1000, -50, periodic, std::vector<float>(120 * 80)};
  for (int y = 0; y < f.height; ++y)
    for (int x = 0; x < f.width; ++x)
      for (const Heap& h : heaps) {
        double dx = 1000 + 2 * (x + 0.5) - h.x, dy = -50 + 2 * (y + 0.5) - h.y;
        if (periodic) dx -= 240 * std::round(dx / 240), dy -= 160 * std::round(dy / 160);
        f.heights[static_cast<std::size_t>(y * f.width + x)] +=
            static_cast<float>(h.height * std::exp(-(dx * dx + dy * dy) / (2 * h.sigma * h.sigma)));
      }
  return f;
}

/// The threshold cuts the heap's foot off: of the height H down to t, 2 pi sigma² (H - t) lies above.
TEST(Dunes, AGaussianHeapHasItsPlaceHeightExtentAndVolume) {
  const std::vector<Dune> dunes = find_dunes(field({{1101.3, 22.7, 4, 9}}), usual, 30);
  ASSERT_EQ(dunes.size(), 1u);
  const Dune& d = dunes[0];
  EXPECT_NEAR(d.crest.x, 1101.3, 0.1);
  EXPECT_NEAR(d.crest.y, 22.7, 0.1);
  EXPECT_NEAR(d.centre.x, 1101.3, 0.02);
  EXPECT_NEAR(d.centre.y, 22.7, 0.02);
  EXPECT_NEAR(d.height, 4, 0.03);
  EXPECT_NEAR(d.volume, 2 * pi_here * 81 * (4 - 0.25), 0.01 * 2 * pi_here * 81 * 4);
  const double diameter = 2 * 9 * std::sqrt(2 * std::log(4 / 0.25));
  EXPECT_NEAR(d.length, diameter, 2);
  EXPECT_NEAR(d.width, diameter, 2);
  EXPECT_FALSE(d.at_edge);
}

/// An ellipse of cells, 60 m by 20 m, whose long axis points to 90 degrees.
TEST(Dunes, LengthIsAlongTheDirectionAndWidthAcross) {
  DuneField f = field({});
  for (int y = 0; y < f.height; ++y)
    for (int x = 0; x < f.width; ++x)
      if (std::pow((x - 60) / 5.0, 2) + std::pow((y - 40) / 15.0, 2) <= 1)
        f.heights[static_cast<std::size_t>(y * f.width + x)] = 1;
  const Dune along = find_dunes(f, usual, 90).at(0), across = find_dunes(f, usual, 0).at(0);
  EXPECT_NEAR(along.length, 62, 1e-9);
  EXPECT_NEAR(along.width, 22, 1e-9);
  EXPECT_NEAR(across.length, 22, 1e-9);
  EXPECT_NEAR(across.width, 62, 1e-9);
}

TEST(Dunes, LowOnesDoNotCountAndEdgesAreNamed) {
  EXPECT_TRUE(find_dunes(field({{1100, 20, 0.45, 9}}), usual, 0).empty());
  EXPECT_TRUE(find_dunes(field({{1002, 20, 4, 9}}, false), usual, 0).at(0).at_edge);
  EXPECT_FALSE(find_dunes(field({{1002, 20, 4, 9}}), usual, 0).at(0).at_edge);
}

/// Two heaps of different speed; the first goes over the border. A time step moves it by 60 % of its length.
TEST(Tracker, FollowsHeapsOverPeriodicBorders) {
  DuneTracker tracker(usual, 0);
  for (int n = 0; n < 12; ++n) {
    const double t = 100.0 * n;
    const auto& dunes =
        tracker.add(t, field({{1010 + 0.26 * t, 60 + 0.03 * t, 3, 6}, {1200 - 0.01 * t, -20, 2, 7}}));
    ASSERT_EQ(dunes.size(), 2u) << n;
    EXPECT_EQ(dunes[0].id, 1);
    EXPECT_EQ(dunes[1].id, 2);
    EXPECT_EQ(dunes[0].event, "");
    EXPECT_GE(dunes[0].dune.crest.x, 1000);
    EXPECT_LE(dunes[0].dune.crest.x, 1240);
    ASSERT_EQ(dunes[0].velocity.has_value(), n > 0);
    if (n == 0) continue;
    const bool first_is_fast = dunes[0].velocity->x > 0;
    const Position v = (first_is_fast ? dunes[0] : dunes[1]).velocity.value(),
                   slow = (first_is_fast ? dunes[1] : dunes[0]).velocity.value();
    EXPECT_NEAR(v.x, 0.26, 0.002) << n;
    EXPECT_NEAR(v.y, 0.03, 0.002) << n;
    EXPECT_NEAR(slow.x, -0.01, 0.002) << n;
    EXPECT_NEAR(slow.y, 0, 0.002) << n;
  }
}

TEST(Tracker, SaysWhichHaveJoined) {
  DuneTracker tracker(usual, 0);
  tracker.add(0, field({{1060, 20, 4, 8}, {1120, 20, 2, 6}}));
  const auto dunes = tracker.add(10, field({{1085, 20, 4, 8}, {1110, 20, 2, 6}}));
  ASSERT_EQ(dunes.size(), 1u);
  EXPECT_EQ(dunes[0].id, 1) << "the largest";
  EXPECT_EQ(dunes[0].event, "joined 2");
  EXPECT_FALSE(dunes[0].velocity);
  const auto later = tracker.add(20, field({{1090, 20, 4, 8}, {1112, 20, 2, 6}}));
  EXPECT_EQ(later.at(0).id, 1);
  EXPECT_TRUE(later.at(0).velocity);
}

TEST(Tracker, SaysWhatHasSplit) {
  DuneTracker tracker(usual, 0);
  tracker.add(0, field({{1100, 20, 4, 8}, {1124, 20, 2, 6}}));
  const auto dunes = tracker.add(10, field({{1100, 20, 4, 8}, {1140, 20, 2, 6}}));
  ASSERT_EQ(dunes.size(), 2u);
  EXPECT_EQ(dunes[0].id, 1);
  EXPECT_FALSE(dunes[0].velocity);
  EXPECT_EQ(dunes[1].id, 2);
  EXPECT_EQ(dunes[1].event, "split 1");
  const auto alone = tracker.add(20, field({{1140, 20, 2, 6}, {1050, -30, 3, 6}}));
  ASSERT_EQ(alone.size(), 2u);
  EXPECT_EQ(alone[0].id, 2);
  EXPECT_EQ(alone[1].id, 3) << "numbers are not used twice";
  EXPECT_EQ(alone[1].event, "");
}

TEST(Tracker, RefusesTimesThatDoNotRiseAndOtherGrids) {
  DuneTracker tracker(usual, 0);
  tracker.add(5, field({}));
  EXPECT_FALSE(test::refusal([&] { tracker.add(5, field({})); }).empty());
  DuneField other = field({});
  other.cell_size = 3;
  EXPECT_FALSE(test::refusal([&] { tracker.add(6, other); }).empty());
}

#ifndef DESERT_DUNES_BINARY
#define DESERT_DUNES_BINARY ""
#endif

class DunesOf : public test::DesertRun {};

/// A heap of sand on rock; its rasters and its NetCDF file give the same table.
TEST_F(DunesOf, ARunAreTheSameFromRastersAndFromNetcdf) {
  if (!DESERT_WITH_IO) GTEST_SKIP() << "this build reads no rasters";
  const std::string heap =
      folder_.write("heap.yaml",
                    "grid: {width: 80, height: 60, cell_size: 1}\n"
                    "terrain: [cone: {layer: sand, shape: gaussian, x: 25, y: 30, height: 4, radius: 6}]\n"
                    "wind: {speed: 5}\nsaltation: {lift: 0.05}\nrun: {steps: 40}\n");
  const std::string program = test::program_path("DESERT_DUNES_BINARY", DESERT_DUNES_BINARY);
  run_cpu({heap, "--out", path("a"), "--every", "10", "--format", "netcdf"});
  run_cpu({heap, "--out", path("b"), "--every", "10"});
  const auto a = test::run_program(program, {path("a"), "--out", path("a.csv"), "--direction", "0"}),
             b = test::run_program(program, {path("b"), "--direction", "0"});
  ASSERT_EQ(a.status, 0) << a.err;
  ASSERT_EQ(b.status, 0) << b.err;
  const std::string table = test::file_bytes(path("a.csv"));
  EXPECT_NE(table.find("\n1,0,25"), std::string::npos) << table;
  EXPECT_NE(table.find("\n1,40,"), std::string::npos) << table;
  EXPECT_NE(a.err.find("1 dunes, 1 of them"), std::string::npos) << a.err;
  // The rasters begin with the tenth step.
  const std::size_t from_a = table.find("\n1,20,"), from_b = b.out.find("\n1,20,");
  ASSERT_NE(from_b, std::string::npos) << b.out;
  EXPECT_EQ(table.substr(from_a), b.out.substr(from_b));
}

TEST_F(DunesOf, WrongArgumentsAreRefused) {
  const std::string program = test::program_path("DESERT_DUNES_BINARY", DESERT_DUNES_BINARY);
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{}, {path("none")}, {folder_.path("")}, {scenario_, "--threshold", "-1"}})
    EXPECT_EQ(test::run_program(program, arguments).status, 2);
}

}  // namespace
}  // namespace desert_sim
