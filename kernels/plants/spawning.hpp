#pragma once
/// Spawning of plants. Nilles 2025 §3.2.2, eq. 13–15.
///
///   weight   p_j = p_b (1 + k_density min(ρ_j, 1) + k_wind min(ρ_wj, 1)),   0 where the place does not suit
///   events   n   = ⌊min(Σ_j p_j/N_cells, 1) Δt + u⌋,   u uniform in [0, 1)
///   radius   `seedling_share` · min((soil + sand)/h_r, r_max)
///
/// The published P = 1 − (1 − min(Σ_j p_j/N_cells, 1))^Δt is the same for Δt = 1 s, but in shorter steps more
/// plants come up, one a step where the sum is 1, and fewer in longer ones.
///
/// ρ_j and ρ_wj are the densities of species j that cover.hpp finds. An event creates one plant in a cell,
/// its species drawn by weight, with health 1, age 0 and no stored water. A place suits a species if there is
/// no obstacle, moisture, slope, ground and depth of water are in the species' range, and ρ_j ≤ `separation`.
///
/// Random numbers are counter-based (Philox), by seed, step and cell. New plants are appended in the order of
/// their cells; where there is memory for only some of them, these are spread evenly over the cells.
///
/// Reads bedrock, soil, sand, water, moisture, obstacle and the densities; writes the plants.

#include "kernels/base/partition_point.hpp"
#include "kernels/field/random.hpp"
#include "kernels/plants/site.hpp"
#include "kernels/plants/workspace.hpp"

namespace desert_sim::plants {

DESERT_HD float weight_of(const SpeciesTraits& s, float density, float downwind) {
  return s.spawn * (1.0f + s.spawn_density * minimum(density, 1.0f) + s.spawn_wind * minimum(downwind, 1.0f));
}

/// Number of events in a step of dt [s] at a rate of q a second; `u` is uniform in 0 … 1.
DESERT_HD int number_of_events(double q, double dt, double u) {
  return q > 0.0 ? static_cast<int>(q * dt + u) : 0;
}

/// Radius of a new plant [m]; `loose_depth`: soil + sand [m].
DESERT_HD float seedling_radius(const SpeciesTraits& s, float loose_depth, float seedling_share) {
  return seedling_share * minimum(loose_depth / s.root, s.max_radius);
}

struct SpawningLaw {
  Site site;
  const SpeciesTraits* species;
  int species_count;
  const float *density, *downwind;
  float time_step, seedling_share;
  std::uint64_t seed, step;

  DESERT_HD float weight(int kind, int i) const {
    const long long at = kind * static_cast<long long>(site.grid.cells()) + i;
    return weight_of(species[kind], density[at], downwind[at]);
  }

  /// What decides about all species alike whether they come up in a cell.
  struct Place {
    float slope, loose_depth, water_depth, moisture;
    bool has_obstacle;
    Quanta surface;
  };
  DESERT_HD Place place(int i) const {
    return {site.slope(i),
            site.loose_depth(i),
            site.water_depth(i),
            site.relative_moisture(i),
            value_or_zero(site.obstacle, i) > 0.0f,
            site.surface(i)};
  }
  DESERT_HD bool is_suitable(int kind, int i, const Place& here) const {
    const SpeciesTraits& s = species[kind];
    const float radius = seedling_radius(s, here.loose_depth, seedling_share), depth = here.water_depth;
    if (!(radius > 0.0f) || here.has_obstacle || here.slope > s.slope) return false;
    if (density[kind * static_cast<long long>(site.grid.cells()) + i] > s.separation) return false;
    const float stem = radius * s.stem;
    if (lives_under_water(s) ? depth < stem || depth <= wet_depth
                             : depth > maximum(s.water_resistance * stem, wet_depth))
      return false;
    if (here.moisture < s.moisture_lowest || here.moisture > s.moisture_highest) return false;
    const float in_quanta = radius * site.quanta_per_metre;
    return ground_quality(s, site.ground(i, here.surface, in_quanta * s.stem, in_quanta * s.root)) > 0.0f;
  }

  /// Random words of a cell in this step; `which` is 2n for the species of its nth plant and, of the first,
  /// for the number of events, and 2n + 1 for its position.
  DESERT_HD RandomWords draw(int i, int which) const {
    constexpr int bits = 16;  // more plants than a step has seconds do not come up
    return random_words(seed, Purpose::plants, static_cast<std::uint32_t>(i),
                        static_cast<std::uint32_t>(step),
                        static_cast<std::uint32_t>(step >> 32) << bits | static_cast<std::uint32_t>(which));
  }

  /// The plants that spawn in a cell: how many, and the weight of each species among them.
  struct Seeds {
    int count = 0;
    float weights[max_species], all = 0.0f;
  };
  DESERT_HD Seeds seeds(int i) const {
    Seeds found;
    const auto share = [&](float weights) {
      const double q = static_cast<double>(weights) / site.grid.cells();
      return q < 1.0 ? q : 1.0;
    };
    float likely = 0.0f;
    for (int k = 0; k < species_count; ++k) likely += weight(k, i);
    const RandomWords words = draw(i, 0);
    const double u = (words.word[0] + words.word[1] * 0x1p-32) * 0x1p-32;
    // Most cells return here: none comes up even if the place suits all species.
    if (number_of_events(share(likely), time_step, 1.0 - u) == 0) return found;
    const Place here = place(i);
    for (int k = 0; k < species_count; ++k)
      found.all += found.weights[k] = is_suitable(k, i, here) ? weight(k, i) : 0.0f;
    found.count = number_of_events(share(found.all), time_step, 1.0 - u);
    return found;
  }
  /// The species of the nth plant that spawns in a cell.
  DESERT_HD int species_of(int i, const Seeds& among, int n) const {
    float left = unit_from(draw(i, 2 * n).word[2]) * among.all;
    int last = 0;
    for (int k = 0; k < species_count; ++k) {
      if (!(among.weights[k] > 0.0f)) continue;
      last = k;
      if (left < among.weights[k]) return k;
      left -= among.weights[k];
    }
    return last;
  }
};

/// Writes how many plants spawn.
struct MarkSpawningCells {
  SpawningLaw spawning;
  int* seeds;
  DESERT_HD void operator()(int x, int y) const {
    const int i = spawning.site.grid.index(x, y);
    seeds[i] = spawning.seeds(i).count;
  }
};

/// Which of `all` seeds the nth new plant comes from, if there is room for `room` of them;
/// n < min(all, room).
DESERT_HD int seed_of(long long n, long long all, long long room) {
  return static_cast<int>(all <= room ? n : ((n + 1) * all + room - 1) / room - 1);
}

/// Creates the nth new plant, if there are so many.
struct CreatePlants {
  SpawningLaw spawning;
  const int* seed_offsets;  ///< number of seeds in the cells before each, and in all
  View next_state;
  int count, room;

  DESERT_HD void operator()(int n) const {
    const Grid& grid = spawning.site.grid;
    const int all = seed_offsets[grid.cells()];
    if (n >= all) return;
    const int seed = seed_of(n, all, room);
    const int i = partition_point(grid.cells(), [&](int cell) { return seed_offsets[cell] <= seed; }) - 1;
    const int k = seed - seed_offsets[i];
    create(i % grid.width, i / grid.width, i, k, spawning.species_of(i, spawning.seeds(i), k), count + n);
  }
  /// The kth plant of cell i, as the nth of all.
  DESERT_HD void create(int x, int y, int i, int k, int kind, int n) const {
    const Site& site = spawning.site;
    const RandomWords words = spawning.draw(i, 2 * k + 1);
    const auto within = [&](int cell, std::uint32_t word) {
      return (static_cast<float>(cell) + unit_from(word)) * site.grid.cell_size;
    };
    next_state.x[n] = within(x, words.word[0]);
    next_state.y[n] = within(y, words.word[1]);
    next_state.z[n] = site.surface(i);
    next_state.radius[n] =
        seedling_radius(spawning.species[kind], site.loose_depth(i), spawning.seedling_share);
    next_state.health[n] = 1.0f;
    next_state.water[n] = 0.0f;
    next_state.age[n] = 0.0f;
    next_state.species[n] = kind;
  }
};

}  // namespace desert_sim::plants
