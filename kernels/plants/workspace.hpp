#pragma once
/// The population of plants and the buffers of its steps.

#include <string>
#include <vector>

#include "kernels/backend/radix_sort.hpp"
#include "kernels/field/surface.hpp"
#include "kernels/plants/lookup.hpp"
#include "kernels/plants/species.hpp"

namespace desert_sim::plants {

/// A population of `count` plants; all memory is allocated at the start.
struct Workspace {
  int count = 0, capacity = 0, species_count = 0;
  Lookup lookup;
  Buffer<std::uint32_t> now, next;  ///< columns of View; `now` is sorted by key
  Buffer<Neighbour> neighbours;     ///< the plants of `now`
  Buffer<std::int32_t> begins;      ///< of the look-up's cells, and one more
  SortWorkspace sort_workspace;
  Buffer<SpeciesTraits> species;
  Buffer<float> competition;         ///< matrix D_kj: [affected species k][other species j]
  Buffer<Quanta> granted_water;      ///< granted water of each plant
  Buffer<long long> water_requests;  ///< water requested in each terrain cell [quanta]
  Buffer<float> density, downwind;   ///< of mature plants: [species][cell]
  Buffer<int> seeds, seed_offsets;   ///< one for each cell, and one more
  Buffer<int> event_counts;          ///< number of deaths, number of seeds
  surface::Heights tops;             ///< surface of the canopy, or of the ground where there is none

  explicit operator bool() const { return static_cast<bool>(now); }
  View plants() const { return {now.data(), capacity}; }
  View next_state() const { return {next.data(), capacity}; }
  Neighbourhood neighbourhood() const { return {lookup, begins.data(), neighbours.data()}; }
  std::size_t bytes() const;
};

/// `largest_plant`: radius that none exceeds [m]; `competition`: as many rows and columns as there are
/// species.
Workspace make_workspace(Exec& exec, const Grid& grid, int capacity, float largest_plant,
                         const std::vector<SpeciesTraits>& species, const std::vector<float>& competition);

/// Lets the plants live by other traits from now on. Species keep their numbers; there may be more of them
/// than before.
void set_species(Exec& exec, Workspace& work, const std::vector<SpeciesTraits>& species,
                 const std::vector<float>& competition);

/// The columns of all plants, for checkpoints and the state hash: all of Column::x, all of Column::y and so
/// on.
std::vector<std::uint32_t> words(const Workspace& work);

}  // namespace desert_sim::plants
