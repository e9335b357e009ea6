// Heights, lengths and ends of crests that are known exactly.

#include "src/metrics/crest_lines.hpp"

#include <gtest/gtest.h>

#include <array>

#include "test/src/metrics/fields.hpp"

namespace desert_sim {
namespace {

/// Eight ridges over a periodic grid of 128 m are 1024 m of crests without ends.
TEST(CrestLines, OfEndlessRidgesHaveTheirLengthAndHeightAndNoEnds) {
  for (const bool east : {true, false}) {
    const CrestLines c = crest_lines(test::ridges(128, east ? 8 : 0, east ? 0 : 8), east ? 90 : 0, 1);
    EXPECT_EQ(c.dunes, 8u * 128);
    EXPECT_NEAR(c.mean_height, 2, 1e-3);  // a crest lies on a cell
    EXPECT_NEAR(c.highest, 2, 1e-3);
    EXPECT_NEAR(c.length, 1024, 1e-3);
    EXPECT_EQ(c.terminations, 0u);
  }
}

/// The profiles of an oblique frame cover a periodic grid more than once; the ratio stays.
TEST(CrestLines, OfObliqueRidgesHaveNoEndsEither) {
  const CrestLines c = crest_lines(test::ridges(192, 8, 6), direction_of(8, 6) + 90, 1);
  EXPECT_EQ(c.terminations, 0u);
  EXPECT_NEAR(c.mean_height, 2, 0.03);
  EXPECT_NEAR(c.length / static_cast<double>(c.dunes), 1, 0.01);
}

/// Cells are 3 m: lengths grow, heights do not.
TEST(CrestLines, AreMeasuredInMetres) {
  Field f = test::ridges(128, 8, 0);
  f.cell_size = 3;
  const CrestLines c = crest_lines(f, 90, 3);
  EXPECT_NEAR(c.length, 3072, 1e-2);
  EXPECT_NEAR(c.mean_height, 2, 1e-3);
}

/// Ridges of width 4 at x = 16, 48, ... of which one has gaps, each with two ends.
Field ridges_with_gaps(const std::vector<std::array<int, 3>>& gaps, bool periodic = true) {
  return test::relief(128, 128, 1, periodic, [&](int x, int y) {
    const int ridge = x / 32, from_crest = x % 32 - 16;
    for (const auto& [gapped, first, last] : gaps)
      if (gapped == ridge && y >= first && y <= last) return 0.0;
    return 3 * std::exp(-from_crest * from_crest / 18.0);
  });
}

TEST(CrestLines, EndAtGaps) {
  EXPECT_EQ(crest_lines(ridges_with_gaps({}), 90, 1).terminations, 0u);
  const CrestLines one = crest_lines(ridges_with_gaps({{1, 40, 69}}), 90, 1);
  EXPECT_EQ(one.terminations, 2u);
  EXPECT_NEAR(one.length, 4 * 128 - 30, 4);
  const CrestLines three = crest_lines(ridges_with_gaps({{0, 10, 29}, {1, 40, 69}, {3, 90, 127}}), 90, 1);
  EXPECT_EQ(three.terminations, 6u);
}

TEST(CrestLines, DoNotEndWhereTheTerrainDoes) {
  EXPECT_EQ(crest_lines(ridges_with_gaps({}, false), 90, 1).terminations, 0u);
  EXPECT_EQ(crest_lines(ridges_with_gaps({{2, 60, 80}}, false), 90, 1).terminations, 2u);
}

/// An edge dislocation: eight ridges in the south, nine in the north, so that one ends between others.
TEST(CrestLines, EndAtADislocation) {
  const auto dislocated = [](int count) {
    return test::relief(192, 192, 1, false, [=](int x, int y) {
      double phase = 2 * 180 * degree * 8 * x / 192;
      // From an end to its opposite in pairs, so that no phase is left at the border.
      for (int n = 0; n < count; ++n)
        phase += (n % 2 ? -1 : 1) * std::atan2(x - 96 - 40 * (n - (count - 1) / 2.0), y - 96.3);
      return std::cos(phase);
    });
  };
  EXPECT_EQ(crest_lines(dislocated(0), 90, 2).terminations, 0u);
  EXPECT_EQ(crest_lines(dislocated(1), 90, 2).terminations, 1u);
  EXPECT_EQ(crest_lines(dislocated(2), 90, 2).terminations, 2u);
}

/// A barchan-like hump on flat rock is one dune with two tips, and its height is above the rock.
TEST(CrestLines, OfAHumpHaveTwoEnds) {
  const Field f = test::relief(96, 96, 1, true, [](int x, int y) {
    return 5 * std::exp(-(std::pow((x - 40) / 6.0, 2) + std::pow((y - 50) / 14.0, 2)) / 2);
  });
  const CrestLines c = crest_lines(f, 90, 1);
  EXPECT_EQ(c.terminations, 2u);
  EXPECT_NEAR(c.highest, 5, 0.01);
  EXPECT_LT(c.mean_height, 5);
}

/// Heights of alternating ridges, 3 m and 1 m above the lows, are averaged; the highest is told.
TEST(CrestLines, MeanAndHighest) {
  const Field f = test::relief(128, 32, 1, true, [](int x, int) {
    return (x / 16 % 2 ? 3 : 1.5) * std::pow(std::sin(180 * degree * (x % 16) / 16), 2);
  });
  const CrestLines c = crest_lines(f, 90, 0.5);
  EXPECT_NEAR(c.mean_height, 2.25, 1e-3);
  EXPECT_NEAR(c.highest, 3, 1e-3);
}

/// Lows of 0 m and 1 m in turns: ridges of 3 m are 2.5 m high whichever of them is to windward.
TEST(CrestLines, StandOnTheMeanOfBothLows) {
  const Field f = test::relief(128, 32, 1, true, [](int x, int) {
    const double low = (x + 8) / 16 % 2;
    return low + (3 - low) * std::pow(std::sin(180 * degree * (x % 16) / 16), 2);
  });
  const CrestLines c = crest_lines(f, 90, 0.5);
  EXPECT_NEAR(c.mean_height, 2.5, 1e-3);
  EXPECT_NEAR(c.highest, 2.5, 1e-3);
}

TEST(CrestLines, OfAPlaneAreNone) {
  const CrestLines c = crest_lines(test::relief(64, 64, 1, true, [](int, int) { return 4; }), 90, 2);
  EXPECT_EQ(c.dunes, 0u);
  EXPECT_EQ(c.length, 0);
}

}  // namespace
}  // namespace desert_sim
