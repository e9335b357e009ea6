#pragma once
/// Which species grows where, and plants as others see them. Not part of a step: computed for who asks
/// (Lifetime::on_request).
///
///   plants   1 + the species of the plant that is densest on the ground of a cell's centre, of equal ones
///   the
///            first in order; 0 where none is denser than `bare`
///
/// Reads bedrock, soil, sand and the plants; writes plants.

#include "kernels/field/layers.hpp"
#include "kernels/plants/lookup.hpp"
#include "kernels/view/layer_values.hpp"

namespace desert_sim::plants {

/// Density below which a place counts as bare.
constexpr float bare = 0.02f;

/// For rows first … first + rows − 1, over the north edge.
template <class E>
void mark_species(E& exec, const TerrainView& t, int first, int rows, const Neighbourhood& near,
                  const View& plants, const SpeciesTraits* species);

/// A plant as it goes to the host.
struct Listed {
  float x, y;                     ///< [m] from the grid's south-west corner
  float z;                        ///< [m] where stem and root meet
  float radius;                   ///< [m]
  std::uint16_t species, health;  ///< health: 255 is full; no bytes lie between or behind that nobody writes
};

/// Plants first … first + count − 1, in their order, to `to` on the device.
template <class E>
void list(E& exec, const View& plants, const Metres& metres, int first, int count, Listed* to);

}  // namespace desert_sim::plants
