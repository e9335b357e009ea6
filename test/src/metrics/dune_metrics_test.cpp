// Slip faces, bare ground, flux, stacks and migration of made-up terrains.

#include "src/metrics/dune_metrics.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "test/src/metrics/fields.hpp"
#include "test/support/refusal.hpp"

namespace desert_sim {
namespace {

/// Ridges across an east wind, every 32 m: windward 10 degrees, lee `lee_deg`, on bare rock between.
DuneSurface ridges_with_lee(double lee_deg, double shift = 0) {
  const double stoss = std::tan(10 * degree), lee = std::tan(lee_deg * degree), height = 3;
  DuneSurface s;
  s.sand = test::relief(128, 64, 1, true, [=](int px, int) {
    const double x = std::fmod(px - shift + 320, 32);  // the crest at 20
    return std::max(0.0, std::min(height - stoss * (20 - x), height - lee * (x - 20)));
  });
  s.elevation = s.relief = s.sand;
  s.wind_x = test::relief(128, 64, 1, true, [](int, int) { return 5; });
  s.wind_y = test::relief(128, 64, 1, true, [](int, int) { return 0; });
  return s;
}

/// 3 m at 33 degrees are 4.6 m: the cells at 21, 22 and 23 m have both neighbours on the lee side.
TEST(SlipFaces, AreTheCellsOfTheLeeSide) {
  const DuneSurface s = ridges_with_lee(33);
  const SlipFaces faces = slip_faces(s.elevation, s.sand, s.wind_x, s.wind_y);
  EXPECT_NEAR(faces.share, 3 / 32.0, 1e-9);
  EXPECT_EQ(faces.lee_share.value(), 1);
  EXPECT_NEAR(angle_between_deg(faces.direction_deg, 0), 0, 1e-6);
  EXPECT_NEAR(faces.direction_coherence, 1, 1e-6);
  ASSERT_EQ(faces.directions_deg.size(), 1u);
}

TEST(SlipFaces, GentlerOnesAreNone) {
  const DuneSurface s = ridges_with_lee(29);
  EXPECT_EQ(slip_faces(s.elevation, s.sand, s.wind_x, s.wind_y).share, 0);
  EXPECT_GT(slip_faces(s.elevation, s.sand, s.wind_x, s.wind_y, 28).share, 0);
}

TEST(SlipFaces, AgainstTheWindAreNotLee) {
  DuneSurface s = ridges_with_lee(33);
  for (float& w : s.wind_x.values) w = -5;
  const SlipFaces faces = slip_faces(s.elevation, s.sand, s.wind_x, s.wind_y);
  EXPECT_NEAR(faces.share, 3 / 32.0, 1e-9);
  EXPECT_EQ(faces.lee_share.value(), 0);
  for (float& w : s.wind_x.values) w = 0;
  EXPECT_FALSE(slip_faces(s.elevation, s.sand, s.wind_x, s.wind_y).lee_share) << "still air";
}

TEST(SlipFaces, OfRockDoNotCount) {
  DuneSurface s = ridges_with_lee(33);
  s.sand.values.assign(s.sand.values.size(), 0.0f);
  EXPECT_EQ(slip_faces(s.elevation, s.sand, s.wind_x, s.wind_y).share, 0);
}

/// A cone of 35 degrees falls to all sides; its area above the plain is known.
TEST(SlipFaces, OfAConeFallToAllSides) {
  DuneSurface s = ridges_with_lee(33);
  s.elevation = s.sand = test::relief(128, 64, 1, true, [](int x, int y) {
    return std::max(0.0, std::tan(35 * degree) * (20 - std::hypot(x - 60, y - 32)));
  });
  const SlipFaces faces = slip_faces(s.elevation, s.sand, s.wind_x, s.wind_y);
  EXPECT_NEAR(faces.share * 128 * 64, 180 * degree * 400, 0.08 * 180 * degree * 400);
  EXPECT_LT(faces.direction_coherence, 0.02);
  EXPECT_NEAR(faces.lee_share.value(), 0.5, 0.02);
}

TEST(DuneMetrics, CountBareGroundStacksAndFlux) {
  DuneSurface s = ridges_with_lee(33);
  s.flux_x = test::relief(128, 64, 1, true, [](int x, int) { return x % 2 ? 6e-6 : 0; });
  s.flux_y = test::relief(128, 64, 1, true, [](int, int) { return 3e-6; });
  MetricSettings settings;
  settings.slab_height = 1 / 3.0;
  const DuneMetrics m = measure_dunes(s, settings);
  // The windward side begins at 2.99 m, with 3 mm at the cell at 3 m; the lee side ends at 24.6 m.
  EXPECT_NEAR(m.bare_share, (32 - 21) / 32.0, 1e-9);
  EXPECT_NEAR(m.highest_stack.value(), 9, 1e-5);
  EXPECT_NEAR(m.flux->amount, std::hypot(3e-6, 3e-6), 1e-12);
  EXPECT_NEAR(m.flux->direction_deg, 45, 1e-4);
  EXPECT_NEAR(m.wavelength.value(), 32, 0.05);
  EXPECT_NEAR(m.lines.mean_height, 3, 1e-5);
  EXPECT_EQ(m.lines.terminations, 0u);
  EXPECT_EQ(m.terminations_per_metre.value(), 0);
}

TEST(DuneMetrics, OfFlatSandHaveNoCrests) {
  DuneSurface s = ridges_with_lee(33);
  s.sand.values.assign(s.sand.values.size(), 2.0f);
  s.relief = s.elevation = s.sand;
  const DuneMetrics m = measure_dunes(s, {});
  EXPECT_FALSE(m.crests || m.wavelength || m.terminations_per_metre || m.highest_stack || m.flux);
  EXPECT_EQ(m.rms_relief, 0);
  EXPECT_EQ(m.deepest_sand, 2);
}

TEST(DuneMetrics, RefuseWhatIsNotANumber) {
  DuneSurface s = ridges_with_lee(33);
  s.sand.values[128 + 7] = std::numeric_limits<float>::quiet_NaN();
  const std::string why = test::refusal([&] { measure_dunes(s, {}); });
  EXPECT_NE(why.find("sand"), std::string::npos) << why;
  EXPECT_NE(why.find("(7, 1)"), std::string::npos) << why;
}

/// Five metres in 20 s.
TEST(Migration, IsDistanceOverTime) {
  DuneSurface before = ridges_with_lee(33), after = ridges_with_lee(33, 5);
  before.time = 100;
  after.time = 120;
  const auto moved = migration(before, after);
  ASSERT_TRUE(moved);
  EXPECT_NEAR(moved->velocity.amount, 0.25, 1e-3);
  EXPECT_NEAR(angle_between_deg(moved->velocity.direction_deg, 0), 0, 1e-3);
  EXPECT_NEAR(moved->correlation, 1, 1e-3);
  after.time = 100;
  EXPECT_FALSE(test::refusal([&] { migration(before, after); }).empty());
}

}  // namespace
}  // namespace desert_sim
