// Scenes of the papers' figures show what their headers say.

#include <algorithm>
#include <cmath>
#include <vector>

#include "test/support/field_means.hpp"
#include "test/support/running.hpp"

namespace desert_sim {
namespace {

/// Mean depth of sand among plants, and on bare ground 2 to 8 m from the nearest plant.
struct Beds {
  double planted = 0, around = 0;
};
Beds beds(const Field& sand, const Field& plants) {
  Beds sum, cells;
  for (int y = 0; y < sand.height; ++y)
    for (int x = 30; x < sand.width - 12; ++x) {  // away from the springs' scour and the open edge
      double nearest = 100;
      for (int dy = -8; dy <= 8; ++dy)
        for (int dx = -8; dx <= 8; ++dx)
          if (y + dy >= 0 && y + dy < sand.height && plants.at(x + dx, y + dy) > 0)
            nearest = std::min(nearest, std::hypot(dx, dy));
      if (nearest == 0) sum.planted += sand.at(x, y), cells.planted += 1;
      if (nearest > 2 && nearest < 8) sum.around += sand.at(x, y), cells.around += 1;
    }
  return {sum.planted / cells.planted, sum.around / cells.around};
}

/// 200 s: three seeds had 3.7 to 3.9 m of sand among plants and 3.2 to 3.3 m around them, where 3 m lay to
/// begin with; without the plants 3.2 to 3.5 m in both places.
TEST(PaperScenes, UnderwaterPlants) {
  Running scene(shipped("underwater_plants"));
  Running bare(shipped("underwater_plants", {"terrain.2.discs.height=0"}));
  const Field plants = scene.field(Layer::vegetation);
  const Beds with = beds(scene.run(200).field(Layer::sand), plants);
  const Beds without = beds(bare.run(200).field(Layer::sand), plants);
  const Field water = scene.field(Layer::water);
  DESERT_REPORT("sand among plants %.2f m, around them %.2f m; without plants %.2f and %.2f m", with.planted,
                with.around, without.planted, without.around);
  EXPECT_GT(with.planted, 3.4);
  EXPECT_GT(with.planted, with.around + 0.35);
  EXPECT_LT(std::abs(without.planted - without.around), 0.15);
  EXPECT_GT(*std::min_element(water.values.begin(), water.values.end()), 0.5) << "all of it lies under water";
  scene.expect_balanced();
}

/// Sand after 400 s: between the swirls, and where they are.
struct SweptSand {
  double between = 0, under = 0, highest = 0;
};
SweptSand swept_sand(const Settings& settings) {
  Running scene(shipped("desertscape_swirls", settings));
  const Field sand = scene.run(400).field(Layer::sand);
  scene.expect_balanced();
  return {mean_in(sand, {105, 150, 56, 72}),
          (mean_in(sand, {112, 148, 82, 118}) + mean_in(sand, {112, 148, 10, 46})) / 2,
          *std::max_element(sand.values.begin(), sand.values.end())};
}

/// Six seeds, of noise and rose, had 0.99 to 1.73 m of sand between the swirls, 0.22 to 0.29 m under them,
/// and a crescent of 15.9 to 16.6 m; without the swirls there are 0.06 m and 0.19 m in these places.
TEST(PaperScenes, DesertscapeSwirls) {
  const SweptSand with = swept_sand({}), without = swept_sand({"wind.features=[]"});
  DESERT_REPORT(
      "sand between the swirls %.2f m, under them %.2f m; without swirls %.2f and %.2f m; %.1f m high",
      with.between, with.under, without.between, without.under, with.highest);
  EXPECT_GT(with.between, 0.3);
  EXPECT_GT(with.between, 2.5 * without.between);
  EXPECT_LT(with.under, with.between / 3);
  EXPECT_NEAR(with.highest, 16.2, 2.5);
}

}  // namespace
}  // namespace desert_sim
