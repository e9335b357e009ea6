// The scenes of Desertscape Simulation (Paris et al. 2019) show what their headers say, on smaller grids.

#include <algorithm>
#include <cmath>
#include <numeric>

#include "test/support/relief_shape.hpp"
#include "test/support/running.hpp"

namespace desert_sim {
namespace {

Settings cells(int width, int height) {
  return {"grid.width=" + std::to_string(width), "grid.height=" + std::to_string(height)};
}

/// Without the roughness of single slabs, which are steep to all sides.
Field without_slabs(const Field& field) { return smoothed(field, 2); }

/// Crescents on bare rock: steep lees, hollow between the horns.
TEST(Desertscape, BarchansHaveHornsDownwind) {
  Settings settings = cells(128, 72);
  settings.push_back("seed=2");  // with some others one ridge goes round so narrow a grid
  Running scene(shipped("desertscape_barchan", settings));
  const Field top = scene.run(1300).field(Layer::elevation), sand = scene.field(Layer::sand);
  const double bare = static_cast<double>(std::count_if(sand.values.begin(), sand.values.end(),
                                                        [](float depth) { return depth < 0.02f; })) /
                      static_cast<double>(sand.values.size());
  const Crescents c = crescents(top, 1.5);
  DESERT_REPORT(
      "bare rock %.2f; skewness of the slope %.2f, divergence of lees %.3f, of stosses %.3f per metre", bare,
      c.skewness, c.lee_divergence, c.stoss_divergence);
  EXPECT_GT(bare, 0.4);
  EXPECT_LT(c.skewness, -0.2);
  EXPECT_LT(c.lee_divergence, -0.015);
  EXPECT_GT(c.stoss_divergence, 0.03);
  scene.expect_balanced();
}

/// Ridges across the wind with slip faces downwind, that join.
TEST(Desertscape, TransverseDunesJoin) {
  Running scene(shipped("desertscape_transverse", cells(128, 128)));
  const double early = wavelength(scene.run(200).field(Layer::elevation), 0).value_or(0);
  const Field top = without_slabs(scene.run(500).field(Layer::elevation));
  const double late = wavelength(top, 0).value_or(0);
  const Orientation o = crest_orientation(top, 3);
  const Steepest lee = steepest(top, 0.5);
  DESERT_REPORT(
      "crests at %.0f degrees (coherence %.2f), %.1f then %.1f m apart; steepest %.1f degrees to %.0f "
      "(coherence %.2f)",
      o.crest_deg, o.coherence, early, late, lee.slope_deg, lee.direction_deg, lee.coherence);
  EXPECT_LT(line_angle_between_deg(o.crest_deg, 90), 20);
  EXPECT_GT(o.coherence, 0.4);
  EXPECT_LT(angle_between_deg(lee.direction_deg, 0), 20);
  EXPECT_GT(lee.coherence, 0.5);
  EXPECT_GT(lee.slope_deg, 20);
  EXPECT_GT(late, 1.1 * early);
  scene.expect_balanced();
}

/// Ridges along the mean of two winds, whose steep side is the lee of the wind that blew last.
TEST(Desertscape, LinearDunesLieAlongTheResultant) {
  Running scene(shipped("desertscape_linear", cells(128, 128)));
  const Steepest south = steepest(scene.run(960).field(Layer::elevation), 2);
  const Field top = without_slabs(scene.run(40).field(Layer::elevation));
  const Steepest north = steepest(top, 0.5);
  const Orientation o = crest_orientation(top, 3);
  DESERT_REPORT(
      "crests at %.0f degrees (coherence %.2f); steepest %.1f degrees, %.2f to the south, then %.2f to the "
      "north",
      o.crest_deg, o.coherence, north.slope_deg, south.towards(270), north.towards(90));
  EXPECT_LT(line_angle_between_deg(o.crest_deg, 0), 20);  // 6 and 14 of two seeds
  EXPECT_GT(o.coherence, 0.6);
  EXPECT_GT(north.slope_deg, 20);
  EXPECT_GT(south.towards(270), 0.5);
  EXPECT_GT(north.towards(90), 0.5);
  scene.expect_balanced();
}

/// Large ridges grow out of small waves as the hops get longer, and stay rough on a small scale.
TEST(Desertscape, MegaDunesHaveManySizes) {
  Running scene(shipped("desertscape_mega", cells(128, 128)));
  double large[2], small[2], apart[2];
  for (int look = 0; look < 2; ++look) {
    const Field elevation = scene.run(look ? 650 : 150).field(Layer::elevation), top = smoothed(elevation, 5);
    Field rest = smoothed(elevation, 1);
    for (std::size_t i = 0; i < rest.values.size(); ++i) rest.values[i] -= top.values[i];
    large[look] = roughness(top);
    small[look] = roughness(rest);
    apart[look] = wavelength(top, 0).value_or(64);
    DESERT_REPORT("ridges %.2f m rms, %.1f m apart; small bumps %.2f m rms", large[look], apart[look],
                  small[look]);
  }
  EXPECT_GT(large[1], 5 * large[0]);
  EXPECT_GT(apart[1], 1.4 * apart[0]);
  EXPECT_GT(small[1], 0.9 * small[0]);
  scene.expect_balanced();
}

/// Two heaps apart: of each, three arms or four, and slip faces to all sides, while its centre stays.
TEST(Desertscape, StarDunesHaveArmsAndStay) {
  Settings settings = cells(128, 128);
  settings.push_back("seed=2");  // with others heaps lie on each other in so small a grid
  Running scene(shipped("desertscape_star", settings));
  const auto heaps = [&] {
    return find_dunes(without_slabs(scene.field(Layer::elevation)), without_slabs(scene.field(Layer::sand)),
                      0, 1, 500);
  };
  const std::vector<DuneShape> before = heaps(), after = (scene.run(576), heaps());
  ASSERT_EQ(before.size(), 2u);
  ASSERT_EQ(after.size(), 2u);
  const Field top = without_slabs(scene.field(Layer::elevation));
  for (std::size_t n = 0; n < 2; ++n) {
    const DuneShape& d = after[n];
    const double moved = std::min(std::hypot(d.x - before[0].x, d.y - before[0].y),
                                  std::hypot(d.x - before[1].x, d.y - before[1].y));
    const int found = arms(top, d.crest_x, d.crest_y, 18, 1, 1);
    DESERT_REPORT("%.1f m high (before %.1f m), moved by %.1f m, %d arms", d.height, before[n].height, moved,
                  found);
    EXPECT_GT(d.height, 11) << "heaps grow";
    EXPECT_LT(moved, 5);
    EXPECT_GE(found, 3);
  }
  EXPECT_GE(slip_face_directions(top).size(), 3u);
  scene.expect_balanced();
}

/// A mound in each patch of plants, with a tail in its lee.
TEST(Desertscape, NebkhasHoldSand) {
  Running scene(shipped("desertscape_nebkha", cells(160, 160)));
  const Field plants = scene.field(Layer::vegetation);
  const Field sand = scene.run(300).field(Layer::sand);
  double all = 0, on = 0, lee = 0, upwind = 0, planted = 0, beside = 0;
  for (int y = 0; y < sand.height; ++y)
    for (int x = 0; x < sand.width; ++x) {
      all += static_cast<double>(sand.at(x, y)) / static_cast<double>(sand.values.size());
      if (plants.at(x, y) > 0.5) ++planted, on += static_cast<double>(sand.at(x, y));
      // The first bare cells beyond the eastern edge of a patch, and before the western one.
      if (plants.at(x, y) == 0 && plants.at(x - 1, y) > 0) {
        ++beside;
        for (int away = 2; away < 12; ++away) lee += static_cast<double>(sand.at(x + away, y)) / 10;
      }
      if (plants.at(x, y) == 0 && plants.at(x + 1, y) > 0)
        for (int away = 2; away < 12; ++away) upwind += static_cast<double>(sand.at(x - away, y)) / 10;
    }
  on /= planted, lee /= beside, upwind /= beside;
  DESERT_REPORT("sand: mean %.2f m, among plants %.2f m, in their lee %.2f m, upwind %.2f m", all, on, lee,
                upwind);
  EXPECT_GT(on, 4 * all);
  EXPECT_GT(lee, 1.5 * upwind);
  scene.expect_balanced();
}

/// Ridges of rock along the wind; hard rock stands, soft rock is swept out.
TEST(Desertscape, YardangsLieAlongTheWind) {
  Settings settings = cells(96, 80);
  settings.push_back("terrain.1.noise.stretch=1");  // hardness that varies alike in all directions
  Running scene(shipped("desertscape_yardang", settings));
  const Field before = scene.field(Layer::bedrock), hardness = scene.field(Layer::erosion_resistance);
  const Field after = scene.run(400).field(Layer::bedrock);
  const Orientation first = crest_orientation(before, 2), o = crest_orientation(after, 2);
  double worn[2] = {0, 0}, n[2] = {0, 0};
  for (std::size_t i = 0; i < after.values.size(); ++i) {
    const bool hard = hardness.values[i] > 0.8;
    if (!hard && hardness.values[i] > 0.2) continue;
    worn[hard] += static_cast<double>(before.values[i] - after.values[i]);
    n[hard] += 1;
  }
  DESERT_REPORT("ridges at %.1f degrees (coherence %.2f, before %.2f); worn: soft %.2f m, hard %.2f m",
                o.crest_deg, o.coherence, first.coherence, worn[0] / n[0], worn[1] / n[1]);
  EXPECT_LT(line_angle_between_deg(o.crest_deg, 0), 10);
  EXPECT_GT(o.coherence, 0.25);
  EXPECT_LT(first.coherence, 0.2);
  EXPECT_GT(worn[0] / n[0], 2 * worn[1] / n[1]);
  scene.expect_balanced();
}

/// Each stage of the session has what its events make, and the books close through all of them.
TEST(Desertscape, TheSessionGoesThroughItsStages) {
  Running scene(shipped("desertscape_session", cells(128, 96)));
  const auto mean = [](const Field& f) {
    return std::accumulate(f.values.begin(), f.values.end(), 0.0) / static_cast<double>(f.values.size());
  };
  const Orientation rock_before = crest_orientation(scene.field(Layer::bedrock), 2);
  const Field barchans = scene.run(600).field(Layer::sand);
  const auto bare =
      std::count_if(barchans.values.begin(), barchans.values.end(), [](float d) { return d < 0.02f; });
  const Field rock = scene.run(600).field(Layer::bedrock);
  const Orientation yardangs = crest_orientation(rock, 2);
  const Field worn = scene.field(Layer::sand), ridges = scene.run(300).field(Layer::sand);
  const Steepest lee = steepest(without_slabs(scene.field(Layer::elevation)), 0.5);
  DESERT_REPORT(
      "bare %.2f; rock at %.1f degrees (coherence %.2f, before %.2f); sand %.2f, then %.2f m; lee %.1f "
      "degrees to %.0f",
      static_cast<double>(bare) / (128 * 96), yardangs.crest_deg, yardangs.coherence, rock_before.coherence,
      mean(worn), mean(ridges), lee.slope_deg, lee.direction_deg);
  EXPECT_GT(bare, 128 * 96 * 0.3);
  EXPECT_LT(line_angle_between_deg(yardangs.crest_deg, 0), 10);
  EXPECT_GT(yardangs.coherence, rock_before.coherence + 0.2);
  EXPECT_NEAR(mean(ridges) - mean(worn), 3, 0.1);
  EXPECT_LT(angle_between_deg(lee.direction_deg, 0), 20);

  const Field sand = scene.run(300).field(Layer::sand), plants = scene.field(Layer::vegetation);
  double held = 0, planted = 0;
  for (std::size_t i = 0; i < sand.values.size(); ++i)
    if (plants.values[i] > 0.5f) held += static_cast<double>(sand.values[i]), planted += 1;
  const Field mega = scene.run(600).field(Layer::elevation);
  const Field cut = scene.run(1).field(Layer::sand);
  const Field domes = scene.run(1199).field(Layer::elevation);
  const std::size_t faces = slip_face_directions(without_slabs(domes)).size();
  DESERT_REPORT("sand among plants %.2f m (mean %.2f); %.2f, then %.2f m rms; slip faces to %zu sides",
                held / planted, mean(sand), roughness(without_slabs(scene.field(Layer::elevation))),
                roughness(mega), faces);
  EXPECT_GT(held / planted, 1.3 * mean(sand));
  EXPECT_GT(roughness(mega), 1.15 * roughness(ridges)) << "dunes grow";
  EXPECT_LT(*std::max_element(cut.values.begin(), cut.values.end()), 6) << "4 m, and a step";
  EXPECT_EQ(mean(scene.field(Layer::vegetation)), 0);
  EXPECT_GE(faces, 3u);
  scene.expect_balanced();
}

}  // namespace
}  // namespace desert_sim
