#pragma once
/// Mean illumination over the day, at the ground and at the top of the canopy. Nilles 2025 §3.2.3, eq. 16–18.
///
///   σ = 2 · mean over the 7 × 7 offsets o of exp(d α) − 1
///   d = −2 max(l (o·light), 0)/|l o|²
///   α = max(top of the canopy at −o − level here, 0)/|l o|
///
/// `light` is the unit vector in which light travels; the level is the ground's for illumination and the
/// canopy's for illumination_canopy. σ is 1 in the open, and lower the steeper the view to where light comes
/// from. Under water it is multiplied by exp(−`light_decay` · depth of the level).
///
/// Reads water, bedrock, soil and sand through `heights`, and canopy_height through the tops of the canopy;
/// writes illumination, illumination_canopy.

#include "kernels/field/layers.hpp"
#include "kernels/plants/workspace.hpp"

namespace desert_sim::plants {

template <class E>
void illuminate(E& exec, const TerrainView& t, const VegetationParameters& p, const surface::Heights& heights,
                const Workspace& work);

}  // namespace desert_sim::plants
