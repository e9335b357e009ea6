#pragma once
/// Plant cover: rasterises the plants onto the grid. Nilles 2025 §3.2.1, eq. 8–12.
///
///   vegetation      v = min(Σ_k D_k, 1)
///   canopy_height   max_k (r_k h_s D_k)
///   humus           += Δt Σ_k φ_h D_k, up to `humus_limit`
///
///   density         ρ_j  = Σ_k D_k                                    over the mature plants k of species j
///   downwind        ρ_wj = Σ_k max(ŵ·d̂_k, 0) max(1 − |d_k|/r_max, 0)   over the same plants
///
/// D is the density of a plant (density.hpp), r its radius, h_s its `stem`, φ_h its `humus`; d_k points from
/// plant k to the cell, and ŵ, d̂ are unit vectors. A plant counts inside its radius. Each cell gathers over
/// the plants in their sorted order.
///
/// Reads bedrock, soil and sand through `heights`, wind_x, wind_y, humus and the plants. Writes vegetation,
/// canopy_height and humus, and in the workspace the densities of the species and `tops`: the surface of the
/// canopy (of the ground where nothing grows), for wind shadow and illumination.

#include "kernels/field/dice.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/plants/workspace.hpp"

namespace desert_sim::plants {

struct CoverInputs {
  float time_step;  ///< [s]
  const surface::Heights& heights;
  /// Whether to write vegetation and humus as well, which are state; recomputing the derived layers for a
  /// snapshot must not change them.
  bool makes_state;
};

template <class E>
void cover(E& exec, const TerrainView& t, const VegetationParameters& p, const CoverInputs& in,
           const Dice& dice, Workspace& work);

}  // namespace desert_sim::plants
