#pragma once
/// The dominant species of each cell, and the plants in the form in which they are sent to the host. Both are
/// no part of a simulation step, but computed on request (Lifetime::on_request).
///
///   plants = 1 + species of the plant k with the largest density D_k
///   plants = 0 where no D_k exceeds `bare_density`
///
/// D is the density (density.hpp) on the ground at the cell's centre; of equally dense plants the first in
/// order counts. Reads bedrock, soil, sand and the plants; writes the layer plants.

#include "kernels/field/layers.hpp"
#include "kernels/plants/lookup.hpp"
#include "kernels/view/layer_values.hpp"

namespace desert_sim::plants {

/// Density below which a place counts as bare. No parameter: it is for who looks at plants, and changes none.
constexpr float bare_density = 0.02f;

/// Computes rows first … first + rows − 1, which continue over the north edge.
template <class E>
void find_dominant_species(E& exec, const TerrainView& t, int first, int rows, const Neighbourhood& near,
                           const View& plants, const SpeciesTraits* species);

/// A plant as it is sent to the host.
struct PlantRecord {
  float x, y;                     ///< [m] from the grid's south-west corner
  float z;                        ///< [m] where stem and root meet
  float radius;                   ///< [m]
  std::uint16_t species, health;  ///< health: 255 is full. The structure has no padding bytes
};

/// Writes plants first … first + count − 1, in their order, to `to` on the device.
template <class E>
void export_plants(E& exec, const View& plants, const QuantaToMetres& metres, int first, int count,
                   PlantRecord* to);

}  // namespace desert_sim::plants
