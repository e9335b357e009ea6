// The shipped scenarios of shores and plants show what their headers say, in numbers.

#include <algorithm>
#include <cmath>

#include "test/support/running.hpp"

namespace desert_sim {
namespace {

/// Sand above the sea's level [m³], and where its centre is [m].
struct Ashore {
  double volume = 0, centre = 0;
};
Ashore ashore(Running& scene) {
  const Field sand = scene.field(Layer::sand), top = scene.field(Layer::elevation);
  Ashore a;
  for (int y = 0; y < sand.height; ++y)
    for (int x = 0; x < sand.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * sand.width + x;
      const double above = std::clamp<double>(top.values[i], 0, sand.values[i]);
      a.volume += above;
      a.centre += above * (x + 0.5);
    }
  if (a.volume > 0) a.centre /= a.volume;
  return a;
}

TEST(Beach, WavesBringSandAshoreAndTheWindTakesItInland) {
  const Settings strip{"grid.height=32"};
  Settings calm = strip;
  calm.push_back("water.wave_strength=0");
  Running scene(shipped("beach", strip)), still(shipped("beach", calm));
  double before = ashore(scene.run(2)).volume;
  for (int look = 0; look < 4; ++look) {
    const double now = ashore(scene.run(100)).volume;
    EXPECT_GT(now, before + 1.5) << "after " << look + 1 << " times 100 s";
    before = now;
  }
  const double without = ashore(still.run(202)).volume;
  EXPECT_LT(without, 1) << "no waves, no sand";
  const Ashore beach = ashore(scene.run(298));  // the waves stop at 600 s
  EXPECT_GE(beach.volume, before);
  const Ashore blown = ashore(scene.run(150));  // the wind rises at 700 s
  DESERT_REPORT("ashore %.0f m3 (calm %.1f), at x = %.0f m, then %.0f m", beach.volume, without, beach.centre,
                blown.centre);
  EXPECT_GT(blown.centre, beach.centre + 15);
  scene.expect_balanced();
}

TEST(ShadedHill, EachSpeciesLivesInItsLight) {
  Running scene(shipped("shaded_hill"));
  scene.run(100);
  const Field top = scene.field(Layer::elevation), species = scene.field(Layer::plants);
  double flank = 0, rest = 0, shade_on_flank = 0, shade = 0, sun_on_rest = 0, sun = 0;
  for (int y = 1; y + 1 < top.height; ++y)
    for (int x = 0; x < top.width; ++x) {
      const auto at = [&](const Field& f, int row) {
        return f.values[static_cast<std::size_t>(row) * f.width + x];
      };
      const bool north = 0.5 * (at(top, y + 1) - at(top, y - 1)) < -0.3;  // falls to the north
      const float kind = at(species, y);
      (north ? flank : rest) += 1;
      if (kind == 1) ++shade, shade_on_flank += north;
      if (kind == 2) ++sun, sun_on_rest += !north;
    }
  DESERT_REPORT("shade bushes: %.0f cells, %.2f of the flank; sun bushes: %.0f cells, %.2f of the rest",
                shade, shade_on_flank / flank, sun, sun_on_rest / rest);
  EXPECT_GT(shade_on_flank / shade, 0.9);
  EXPECT_GT(shade_on_flank / flank, 0.4);
  EXPECT_GT(sun_on_rest / sun, 0.95);
  EXPECT_GT(sun_on_rest / rest, 0.6);
  for (const PlantCount& c : scene.simulation().state().plant_counts())
    EXPECT_GT(c.mature, c.plants / 4) << c.species;
}

/// Many plants of every species of a climate are mature on ground of a metre or two.
TEST(Climates, KeepTheirPlants) {
  const auto mature = [](const std::string& climate) {
    Running scene(parse_scenario_text(
        "climate: " + climate +
            "\ngrid: {width: 64, height: 64, cell_size: 1, boundary: periodic}\n"
            "terrain:\n  - noise: {layer: bedrock, low: 0, high: 6, scale: 60}\n"
            "  - uniform: {layer: soil, value: 1.5}\n  - noise: {layer: sand, low: 0.2, high: 0.6, seed: 2}\n"
            "wind: {speed: 3, direction_deg: 20}\n",
        climate));
    scene.run(250);
    return scene.simulation().state().plant_counts();
  };
  for (const std::string climate : {"arid", "savanna", "wetland", "forest"})
    for (const PlantCount& c : mature(climate)) {
      DESERT_REPORT("%s: %s %d, mature %d", climate.c_str(), c.species.c_str(), c.plants, c.mature);
      EXPECT_GE(c.mature, 5) << c.species << " in " << climate;
    }
}

/// After 80 days of an eastward wind the middle of the ridge has run on down the lane without plants, and
/// both arms lie upwind of it, where plants are.
TEST(Dunes, LivingParabolic) {
  Running scene(shipped("parabolic", {"grid.width=200"}));
  while (scene.simulation().time() < 60 * 86400.0) scene.run(1);
  const Field sand = scene.field(Layer::sand);
  struct Extent {
    int west, east;  ///< of sand deeper than 0.3 m in these rows
  };
  const auto extent = [&](int first, int end) {
    Extent e{sand.width, -1};
    for (int y = first; y < end; ++y)
      for (int x = 0; x < sand.width; ++x)
        if (sand.at(x, y) > 0.3) e = {std::min(e.west, x), std::max(e.east, x)};
    return e;
  };
  const Extent middle = extent(60, 101), south = extent(24, 48), north = extent(113, 137);
  DESERT_REPORT("from west to east: middle %d to %d m, arms %d to %d and %d to %d m", middle.west,
                middle.east, south.west, south.east, north.west, north.east);
  for (const Extent& arm : {south, north}) {
    EXPECT_LT(arm.west, middle.west - 20) << "arms trail upwind";
    EXPECT_LT(arm.east, middle.east - 5) << "the nose leads";
  }
}

}  // namespace
}  // namespace desert_sim
