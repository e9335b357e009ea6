#pragma once
/// Parameters of the vegetation model: of a species (Nilles 2025 §3.2, table 1), and of all plants.

#include "src/core/parameter_table.hpp"

namespace desert_sim {

/// The most that `vegetation.largest_plant` can be [m].
constexpr float widest_plant = 200.0f;
/// No parameter: a cell of plants::Cover has so many sums.
constexpr int max_species = 16;

/// The 26 parameters of a species; the defaults are those of a tree. Lengths that grow with a plant are
/// relative to its radius. Rates are per second.
struct SpeciesTraits {
  float max_radius = 20.0f;
  float growth = 0.1f;
  float position_adjust = 1e-4f;
  float damage = 0.02f;
  float shrink = 0.0f;
  float maturity_time = 100.0f;
  float maturity_share = 0.2f;
  float stem = 1.0f;
  float root = 1.0f;
  float water_use = 0.1f;
  float water_capacity = 1.0f;
  float water_resistance = 0.1f;
  float moisture_lowest = 0.2f;
  float moisture_highest = 0.8f;
  float soil = 1.0f;
  float sand = 0.2f;
  float root_cover = 0.75f;
  float stem_cover = 0.25f;
  float slope = 0.5f;
  float spawn = 0.1f;
  float spawn_density = 10.0f;
  float spawn_wind = 100.0f;
  float humus = 0.01f;
  float light_lowest = 0.3f;
  float light_highest = 1.7f;
  float separation = 0.25f;
};

constexpr auto parameter_table(const SpeciesTraits*) {
  using P = SpeciesTraits;
  return std::make_tuple(
      parameter("max_radius", &P::max_radius, 0.01, widest_plant, "m",
                "Radius that a plant can reach; vegetation.largest_plant at most."),
      parameter("growth", &P::growth, 0, 100, "m/s", "Growth of the radius where nothing hinders it."),
      parameter("position_adjust", &P::position_adjust, 0, 100, "m/s",
                "How fast a plant follows ground that rises or sinks."),
      parameter("damage", &P::damage, 0, 100, "1/s", "Health lost by a damage of 1."),
      parameter("shrink", &P::shrink, 0, 100, "m/s", "How fast a plant that is too wide gets narrower."),
      parameter("maturity_time", &P::maturity_time, 0, 1e9, "s",
                "Age by which a plant must be mature, or dies."),
      parameter("maturity_share", &P::maturity_share, 0, 1, "1",
                "Share of max_radius from which a plant is mature, and spreads."),
      parameter("stem", &P::stem, 0.01, 10, "1", "Height of the stem over the radius."),
      parameter("root", &P::root, 0.01, 10, "1", "Depth of the roots over the radius."),
      parameter("water_use", &P::water_use, 0, 100, "1/s",
                "Water needed, as soaked ground of the stem's volume."),
      parameter("water_capacity", &P::water_capacity, 0, 1000, "1",
                "Water that a plant can store, likewise of the whole plant's volume."),
      parameter("water_resistance", &P::water_resistance, 0, 1, "1",
                "Share of the stem that may stand in water; at 1 a species lives only under water."),
      parameter("moisture_lowest", &P::moisture_lowest, 0, 1, "1", "Relative moisture that seeds need."),
      parameter("moisture_highest", &P::moisture_highest, 0, 1, "1", "Relative moisture that is too much."),
      parameter("soil", &P::soil, 0, 1, "1", "How well it grows in soil."),
      parameter("sand", &P::sand, 0, 1, "1", "How well it grows in sand."),
      parameter("root_cover", &P::root_cover, 0, 1, "1", "Share of the roots that must be in the ground."),
      parameter("stem_cover", &P::stem_cover, 0, 1, "1", "Share of the stem that may be buried."),
      parameter("slope", &P::slope, 0.01, 100, "1", "Slope, rise over run, that is too steep."),
      parameter("spawn", &P::spawn, 0, 1e9, "1/s", "Plants that come up all over the grid."),
      parameter("spawn_density", &P::spawn_density, 0, 1e9, "1", "How many times more among its like."),
      parameter("spawn_wind", &P::spawn_wind, 0, 1e9, "1", "How many times more downwind of its like."),
      parameter("humus", &P::humus, 0, 10, "m/s", "Humus made under full density."),
      parameter("light_lowest", &P::light_lowest, -10, 10, "1", "Illumination that is too little."),
      parameter("light_highest", &P::light_highest, -10, 10, "1",
                "Illumination that is too much; half way is best."),
      parameter("separation", &P::separation, 0, 10, "1",
                "Density of its like above which no more come up."));
}
static_assert(table_is_complete<SpeciesTraits>());

struct VegetationParameters {
  bool enabled = false;
  int max_plants = 0;
  float light_deg = 90.0f;
  float light_decay = 0.3f;
  float draw = 0.01f;
  float litter = 10.0f;
  float humus_limit = 1.0f;
  bool canopy_shadow = true;
  float largest_plant = 20.0f;
  float seedling_share = 0.05f;
  float overgrown = 1.1f;
};

constexpr auto parameter_table(const VegetationParameters*) {
  using P = VegetationParameters;
  return std::make_tuple(
      parameter(
          "enabled", &P::enabled,
          "Whether plants of the list species live; they make the layer vegetation, which then cannot be "
          "painted."),
      parameter("max_plants", &P::max_plants, 0, 1 << 28, "1",
                "Plants that there is memory for; 0: one a cell. Of seeds that find no room a part, spread "
                "evenly over the grid, comes up."),
      parameter("light_deg", &P::light_deg, -360, 360, "deg",
                "Where light goes to over the day, counter-clockwise from +x: 90 is light from the south."),
      parameter("light_decay", &P::light_decay, 0, 100, "1/m", "How fast light fades under water."),
      parameter(
          "draw", &P::draw, 0, 1, "1",
          "Share of the water that a plant takes from its roots that leaves the ground of its own cell; the "
          "rest counts as coming from around and below."),
      parameter("litter", &P::litter, 0, 1e6, "s",
                "A dead plant leaves as much humus as it made in so many seconds at full density."),
      parameter("humus_limit", &P::humus_limit, 0, 100, "m", "Most humus of a cell; what is more decays."),
      parameter("canopy_shadow", &P::canopy_shadow,
                "Whether the wind sees the canopy's top, and is blocked by it."),
      parameter(
          "largest_plant", &P::largest_plant, 0.01, widest_plant, "m",
          "Radius that no plant exceeds, for which the look-up of neighbours is made (Nilles 2025: 20 m)."),
      parameter("seedling_share", &P::seedling_share, 0.001, 1, "1",
                "Radius of a new plant over the largest that there is room for (Nilles 2025: 5 %)."),
      parameter(
          "overgrown", &P::overgrown, 1, 100, "1",
          "Radius, over the largest that light, room and neighbours allow, beyond which a plant is damaged "
          "and shrinks (Nilles 2025: 110 %)."));
}
static_assert(table_is_complete<VegetationParameters>());

}  // namespace desert_sim
