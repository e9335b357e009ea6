// The scenes in real units show what their headers say, on smaller grids or for a shorter time.

#include <algorithm>
#include <cmath>

#include "test/support/relief_shape.hpp"
#include "test/support/running.hpp"

namespace desert_sim {
namespace {

Running& run_until_day(Running& scene, double day) {
  while (scene.simulation().time() < day * 86400 - 1) scene.run(1);
  return scene;
}

/// Ridges along the mean of two winds, whose steep side is the lee of the wind that blew last.
TEST(Continuum, SeifChangesSides) {
  Running scene(shipped("seif", {"grid.width=128", "grid.height=128"}));
  const Steepest north = steepest(run_until_day(scene, 188).field(Layer::elevation), 1);
  const Field top = run_until_day(scene, 192).field(Layer::elevation);
  const Steepest south = steepest(top, 1);
  const Orientation o = crest_orientation(top, 4);
  DESERT_REPORT(
      "crests at %.0f degrees (coherence %.2f), %.1f degrees steep; %.2f to the north, then %.2f to the "
      "south",
      o.crest_deg, o.coherence, south.slope_deg, north.towards(90), south.towards(270));
  EXPECT_LT(line_angle_between_deg(o.crest_deg, 0), 10);
  EXPECT_GT(o.coherence, 0.6);
  EXPECT_GT(south.slope_deg, 15);
  EXPECT_GT(north.towards(90), 0.6);
  EXPECT_GT(south.towards(270), 0.6);
  scene.expect_balanced();
}

/// Ridges across the wind, which join and grow farther apart (of seed 2, 32 m apart, not before day 200).
TEST(Continuum, TransverseDunesJoin) {
  Running scene(shipped("transverse_continuum", {"grid.width=128", "grid.height=96"}));
  const double early = wavelength(run_until_day(scene, 90).field(Layer::elevation), 0).value_or(0);
  const Field top = run_until_day(scene, 200).field(Layer::elevation);
  const double late = wavelength(top, 0).value_or(64);
  const Orientation o = crest_orientation(top, 3);
  const Steepest lee = steepest(top, 1);
  DESERT_REPORT(
      "crests at %.0f degrees (coherence %.2f), %.1f then %.1f m apart; steepest %.1f degrees to %.0f",
      o.crest_deg, o.coherence, early, late, lee.slope_deg, lee.direction_deg);
  EXPECT_LT(line_angle_between_deg(o.crest_deg, 90), 10);
  EXPECT_GT(o.coherence, 0.6);
  EXPECT_GT(early, 20);
  EXPECT_LT(early, 35);
  EXPECT_GT(late, 1.15 * early);
  EXPECT_LT(angle_between_deg(lee.direction_deg, 0), 15);
  EXPECT_GT(lee.slope_deg, 18);
  scene.expect_balanced();
}

/// Three arms, towards where the winds come from, with slip faces in the lee of each wind.
TEST(Continuum, StarHasThreeArmsAndSlipFaces) {
  Running scene(shipped("star_continuum",
                        {"grid.width=144", "grid.height=144", "terrain.1.cone.x=72", "terrain.1.cone.y=72"}));
  const Field top = run_until_day(scene, 60).field(Layer::elevation);
  const auto highest = std::max_element(top.values.begin(), top.values.end());
  const auto place = static_cast<int>(highest - top.values.begin());
  const double x = place % top.width + 0.5, y = place / top.width + 0.5;
  const std::vector<double> lees = slip_face_directions(top);
  std::string text;
  for (double d : lees) text += " " + std::to_string(static_cast<int>(d));
  DESERT_REPORT("peak of %.1f m at %.0f, %.0f; arms 15 and 25 m from it: %d, %d; slip faces to%s",
                static_cast<double>(*highest), x, y, arms(top, x, y, 15, 0.5, 1), arms(top, x, y, 25, 0.5, 1),
                text.c_str());
  EXPECT_GT(*highest, 15) << "sand is piled up";
  EXPECT_LT(std::hypot(x - 72, y - 72), 10) << "it stays";
  EXPECT_EQ(arms(top, x, y, 15, 0.5, 1), 3);
  EXPECT_EQ(arms(top, x, y, 25, 0.5, 1), 3);
  EXPECT_EQ(lees.size(), 3u);
  for (double wind : {0, 120, 240})
    EXPECT_TRUE(std::any_of(lees.begin(), lees.end(), [&](double d) {
      return angle_between_deg(d, wind) < 20;
    })) << wind;
  scene.expect_balanced();
}

/// The wind digs a hollow where no plants are, down to the rock, and its sand runs on over those behind it.
TEST(Continuum, BlowoutIsDugToTheRock) {
  Running scene(shipped("blowout", {"grid.width=160", "grid.height=80", "terrain.3.column.y=40"}));
  const Field plants = scene.field(Layer::vegetation);
  const Field sand = run_until_day(scene, 150).field(Layer::sand);
  double patch = 0, bare = 0, highest = 0;
  int lobe = 0;  // its eastern end [m]
  for (int y = 0; y < sand.height; ++y)
    for (int x = 0; x < sand.width; ++x) {
      const double depth = sand.at(x, y);
      if (plants.at(x, y) == 0) ++patch, bare += depth < 0.1 ? 1 : 0;
      highest = std::max(highest, depth);
      if (depth > 3.3 && plants.at(x, y) > 0) lobe = std::max(lobe, x);
    }
  DESERT_REPORT("bare rock in %.2f of the patch, sand up to %.1f m, over the plants to x = %d m",
                bare / patch, highest, lobe);
  EXPECT_GT(bare / patch, 0.15);
  EXPECT_GT(highest, 4);
  EXPECT_GT(lobe, 105);
  scene.expect_balanced();
}

/// Crescents that run tens of metres a year, small ones faster.
TEST(Continuum, BarchansOfMoroccoRun) {
  Running scene(shipped("barchan_morocco", {"run.time_step=14400"}));
  const auto dunes = [&](double day) {
    run_until_day(scene, day);
    return find_dunes(scene.field(Layer::elevation), scene.field(Layer::sand), 0, 0.3, 60);
  };
  const std::vector<DuneShape> before = dunes(60), after = dunes(120);
  ASSERT_EQ(before.size(), 5u);
  ASSERT_EQ(after.size(), 5u);
  double last = 0;                       // speed of the next higher dune [m/a]
  for (std::size_t n = 0; n < 5; ++n) {  // by volume
    const double speed = std::remainder(after[n].x - before[n].x, 301) / 60 * 365.25;
    DESERT_REPORT("%.1f m high, %.0f m wide: %.0f m a year, horns %.0f m long to %.0f, slip face to %.0f",
                  after[n].height, after[n].width, speed, after[n].horn_reach, after[n].horn_direction_deg,
                  after[n].slip_direction_deg);
    EXPECT_GT(after[n].height, 2);
    EXPECT_LT(after[n].height, 7);
    EXPECT_GT(speed, 20);
    EXPECT_LT(speed, 120);
    EXPECT_GT(speed, 1.05 * last);
    EXPECT_LT(angle_between_deg(after[n].slip_direction_deg, 0), 20);
    if (after[n].height > 3) {
      EXPECT_GT(after[n].horn_reach, 1);
    }
    last = speed;
  }
  scene.expect_balanced();
}

#if DESERT_WITH_IO
/// Sand that comes over the western and southern edges stays in gullies and behind steps, off the heights.
TEST(Continuum, SandSheetFillsGulliesAndLees) {
  Running scene(shipped("sand_sheet_dem"));
  const Field rock = scene.field(Layer::bedrock), broad = smoothed(rock, 16), slope = smoothed(rock, 4);
  const Field sand = run_until_day(scene, 20).field(Layer::sand);
  double sum[5] = {}, count[5] = {};
  const char* names[] = {"gullies", "heights", "level", "windward slopes", "lee slopes"};
  for (int y = 1; y + 1 < sand.height; ++y)
    for (int x = 1; x + 1 < sand.width; ++x) {
      const double relative = rock.at(x, y) - broad.at(x, y);
      const double rise = ((slope.at(x + 1, y) - slope.at(x - 1, y)) * std::cos(30 * degree) +
                           (slope.at(x, y + 1) - slope.at(x, y - 1)) * std::sin(30 * degree)) /
                          (2 * rock.cell_size);
      const bool is[] = {relative<-3, relative> 3, std::abs(relative) < 1, rise > 0.3, rise < -0.3};
      for (int n = 0; n < 5; ++n)
        if (is[n]) sum[n] += static_cast<double>(sand.at(x, y)), ++count[n];
    }
  for (int n = 0; n < 5; ++n) {
    ASSERT_GT(count[n], 100) << names[n];
    sum[n] /= count[n];
    DESERT_REPORT("%s: %.4f m", names[n], sum[n]);
  }
  EXPECT_GT(sum[0], 5 * sum[2]);
  EXPECT_LT(sum[1], 0.5 * sum[2]);
  EXPECT_GT(sum[3], sum[2]);
  EXPECT_GT(sum[4], 2 * sum[3]);
  scene.expect_balanced();
}
#endif

}  // namespace
}  // namespace desert_sim
