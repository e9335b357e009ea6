// The scenes of a thesis on slab models of sand and snow show what their headers say.

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "test/support/field_means.hpp"
#include "test/support/running.hpp"

namespace desert_sim {
namespace {

/// Correlation of cells with those four cells north of them, which is high where crests across the wind are
/// long.
double along_crests(const Field& field, const Box& box) {
  const double mean = mean_in(field, box);
  double products = 0, squares = 0;
  for (int y = box.south; y < box.north - 4; ++y)
    for (int x = box.west; x < box.east; ++x) {
      const double here = field.at(x, y) - mean, there = field.at(x, y + 4) - mean;
      products += here * there;
      squares += (here * here + there * there) / 2;
    }
  return products / squares;
}

double highest_of(const Field& field) { return *std::max_element(field.values.begin(), field.values.end()); }

/// Ridges along the mean of the winds whose flanks are alike. Three seeds had crests at -4, 4 and 0 degrees
/// (coherence 0.89 to 0.95), and 51.5 % of the cells steeper than 15 degrees fell north.
TEST(ThesisScenes, WernerLinear) {
  Running scene(shipped("werner_linear", {"grid.width=160", "grid.height=160"}));
  const Field ground = smoothed(scene.run(800).field(Layer::elevation), 2);
  const Orientation o = crest_orientation(ground, 2);
  const Slopes s = slopes(ground);
  double steep = 0, north = 0;
  for (std::size_t i = 0; i < s.slope_deg.size(); ++i) {
    if (s.slope_deg[i] < 15) continue;
    steep += 1;
    north += angle_between_deg(s.direction_deg[i], 90) < 90;
  }
  DESERT_REPORT("crests at %.1f degrees (coherence %.2f); %.0f steep cells, %.3f of them fall north",
                o.crest_deg, o.coherence, steep, north / steep);
  EXPECT_LT(line_angle_between_deg(o.crest_deg, 0), 15);
  EXPECT_GT(o.coherence, 0.6);
  EXPECT_GT(steep, 0.1 * static_cast<double>(s.slope_deg.size()));
  EXPECT_NEAR(north / steep, 0.5, 0.1);
  scene.expect_balanced();
}

/// Three seeds had 0.02 m of sand on the rocks, 11.4 m before them and 13.1 m behind them, where 3.3 m lay to
/// begin with; crests at 89 to 93 degrees, whose coherence (0.3) the ramps lower.
TEST(ThesisScenes, ThreeRocks) {
  Running scene(shipped("three_rocks"));
  const Field sand = scene.run(500).field(Layer::sand);
  double top = 0, before = 0, behind = 0;
  for (const Box& rock : {Box{68, 92, 170, 210}, Box{138, 162, 100, 140}, Box{78, 102, 30, 70}}) {
    top += mean_in(sand, rock) / 3;
    before += mean_in(sand, {rock.west - 6, rock.west, rock.south, rock.north}) / 3;
    behind += mean_in(sand, {rock.east, rock.east + 6, rock.south, rock.north}) / 3;
  }
  const Orientation o = crest_orientation(sand, 2);
  DESERT_REPORT("sand on the rocks %.2f m, before them %.1f m, behind them %.1f m; crests at %.0f (%.2f)",
                top, before, behind, o.crest_deg, o.coherence);
  EXPECT_LT(top, 0.1);
  EXPECT_GT(before, 9);
  EXPECT_GT(behind, 9);
  EXPECT_LT(line_angle_between_deg(o.crest_deg, 90), 15);
  EXPECT_GT(o.coherence, 0.2);
  scene.expect_balanced();
}

/// Three seeds had 1.14 to 1.29 m of sand at the lee edges and 1.97 to 2.02 m beside the islands, crests at
/// 90 or 91 degrees, and highest stacks of 51 to 53 slabs, of which the thesis has 57.
TEST(ThesisScenes, NieldRandomIslands) {
  Running scene(shipped("nield_random_islands"));
  const Field shrub = scene.field(Layer::shrub);
  const Field sand = scene.run(200).field(Layer::sand);
  const Orientation o = crest_orientation(sand, 2);
  DESERT_REPORT("highest stack %.0f slabs, crests at %.0f degrees (%.2f)", highest_of(sand) / 0.1,
                o.crest_deg, o.coherence);
  EXPECT_NEAR(highest_of(sand) / 0.1, 57, 10);
  EXPECT_LT(line_angle_between_deg(o.crest_deg, 90), 10);
  EXPECT_GT(o.coherence, 0.45);
  for (const Box& island : {Box{44, 84, 34, 94}, Box{108, 148, 150, 210}, Box{172, 212, 50, 110}}) {
    const Box within{island.west + 5, island.east - 10, island.south + 5, island.north - 5};
    const Box lee{island.east - 2, island.east + 8, island.south + 5, island.north - 5};
    const Box beside{island.west + 5, island.east - 10, island.north + 5, island.north + 45};
    DESERT_REPORT(
        "shrubs %.2f within, %.2f beside; sand %.2f m at the lee edge, %.2f m beside; crests %.2f, %.2f",
        mean_in(shrub, within), mean_in(shrub, beside), mean_in(sand, lee), mean_in(sand, beside),
        along_crests(sand, within), along_crests(sand, beside));
    EXPECT_NEAR(mean_in(shrub, within), 0.35, 0.03);
    EXPECT_EQ(mean_in(shrub, beside), 0);
    EXPECT_LT(mean_in(sand, lee), 0.75 * mean_in(sand, beside));
    EXPECT_LT(along_crests(sand, within), 0.8 * along_crests(sand, beside)) << "bumps in place of crests";
  }
  scene.expect_balanced();
}

/// Three seeds: 53 % of the cells change on the first day, 17 % on day 50, 0.15 % on day 98, none later;
/// stacks of up to 7 slabs, and crests of a coherence of 0.01 to 0.04.
TEST(ThesisScenes, SnowPacking) {
  Running scene(shipped("snow_packing"));
  const auto changed = [&](int days) {
    const Field before = scene.field(Layer::sand), after = scene.run(days).field(Layer::sand);
    double cells = 0;
    for (std::size_t i = 0; i < before.values.size(); ++i) cells += before.values[i] != after.values[i];
    return cells / static_cast<double>(before.values.size());
  };
  const double first = changed(1);
  scene.run(48);
  const double middle = changed(1);
  scene.run(48);
  const double late = changed(2);
  const Field snow = scene.field(Layer::sand);
  const double coherence = crest_orientation(snow, 2).coherence;
  DESERT_REPORT("change in a day: %.2f, %.2f on day 50, %.4f after 98; %.0f slabs high; coherence %.2f",
                first, middle, late, 3 * highest_of(snow), coherence);
  EXPECT_NEAR(first, 0.53, 0.08);
  EXPECT_NEAR(middle, 0.17, 0.05);
  EXPECT_EQ(late, 0);
  EXPECT_NEAR(3 * highest_of(snow), 7, 1.5);
  EXPECT_LT(coherence, 0.15);
  scene.expect_balanced();
}

}  // namespace
}  // namespace desert_sim
