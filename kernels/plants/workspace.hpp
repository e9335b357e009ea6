#pragma once
/// What plants live in: the population and the memory that its steps work with.

#include <string>
#include <vector>

#include "kernels/backend/radix_sort.hpp"
#include "kernels/field/surface.hpp"
#include "kernels/plants/lookup.hpp"
#include "kernels/plants/species.hpp"

namespace desert_sim::plants {

/// A population of `count` plants; all memory is there from the start.
struct Workspace {
  int count = 0, capacity = 0, species_count = 0;
  Lookup lookup;
  Buffer<std::uint32_t> now, next;  ///< columns; `now` is sorted by key
  Buffer<Span> spans;               ///< of the look-up's cells and levels
  Ordering ordering;
  Buffer<SpeciesTraits> species;
  Buffer<float> competition;        ///< [row of the hindered species][column of the other]
  Buffer<Quanta> drunk;             ///< of each plant
  Buffer<long long> wishes;         ///< what the plants of each terrain cell would drink [quanta]
  Buffer<float> density, downwind;  ///< of mature plants: [species][cell]
  Buffer<int> seeds, places;        ///< of each cell and one more
  Buffer<int> tally;                ///< deaths, seeds
  surface::Heights tops;            ///< of the canopy, or of the ground where there is none

  explicit operator bool() const { return static_cast<bool>(now); }
  View plants() const { return {now.data(), capacity}; }
  View later() const { return {next.data(), capacity}; }
  Neighbourhood neighbourhood() const { return {lookup, spans.data()}; }
  std::size_t bytes() const;
};

/// `competition`: as many rows and columns as there are species.
Workspace make_workspace(Exec& exec, const Grid& grid, int capacity,
                         const std::vector<SpeciesTraits>& species, const std::vector<float>& competition);

/// The columns of all plants, for checkpoint and hash: Column::x of each, Column::y of each …
std::vector<std::uint32_t> words(const Workspace& work);

}  // namespace desert_sim::plants
