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

  DESERT_HD bool is_suitable(int kind, int i, float slope) const {
    const SpeciesTraits& s = species[kind];
    const float radius = seedling_radius(s, site.loose_depth(i), seedling_share), depth = site.water_depth(i);
    if (!(radius > 0.0f) || value_or_zero(site.obstacle, i) > 0.0f || slope > s.slope) return false;
    if (density[kind * static_cast<long long>(site.grid.cells()) + i] > s.separation) return false;
    const float stem = radius * s.stem;
    if (lives_under_water(s) ? depth < stem || depth <= wet_depth
                             : depth > maximum(s.water_resistance * stem, wet_depth))
      return false;
    const float moisture = site.relative_moisture(i);
    if (moisture < s.moisture_lowest || moisture > s.moisture_highest) return false;
    const float in_quanta = radius * site.quanta_per_metre;
    return ground_quality(s, site.ground(i, site.surface(i), in_quanta * s.stem, in_quanta * s.root)) > 0.0f;
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
    const float slope = site.slope(i);
    for (int k = 0; k < species_count; ++k)
      found.all += found.weights[k] = is_suitable(k, i, slope) ? weight(k, i) : 0.0f;
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

/// Index of the j-th of `all` seeds among the new plants, of which there are at most `room`; −1 if it is
/// dropped.
DESERT_HD int index_of_new_plant(long long j, long long all, long long room) {
  if (all <= room) return static_cast<int>(j);
  const long long place = j * room / all;
  return (j + 1) * room / all > place ? static_cast<int>(place) : -1;
}

/// Creates the new plants.
struct CreatePlants {
  SpawningLaw spawning;
  const int *seeds, *seed_offsets;
  View next_state;
  int count, capacity;

  DESERT_HD void operator()(int x, int y) const {
    const Site& site = spawning.site;
    const int i = site.grid.index(x, y);
    if (seeds[i] == 0) return;
    const SpawningLaw::Seeds among = spawning.seeds(i);
    for (int k = 0; k < seeds[i]; ++k) {
      const int place =
          index_of_new_plant(seed_offsets[i] + k, seed_offsets[site.grid.cells()], capacity - count);
      if (place >= 0) create(x, y, i, k, spawning.species_of(i, among, k), count + place);
    }
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
