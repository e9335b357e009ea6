#pragma once
/// Light over the day at the ground and at the canopy's top. Nilles 2025 §3.2.3, eq. 16–18; physics.md D.
///
///   σ = 2 · mean over the 7 × 7 offsets o of exp(−2 max(l (o·light), 0) / |l o|² · rise / |l o|)  −  1
///   rise = max(top of the canopy at −o − the level here, 0), for the ground's level and the canopy's
///
/// so 1 in the open, and dimmer the steeper the view to where light comes from. Under water, times
/// exp(−decay · depth of the level). Reads the heights, the canopy's tops and water; writes illumination and
/// illumination_canopy.

#include "kernels/field/layers.hpp"
#include "kernels/plants/workspace.hpp"

namespace desert_sim::plants {

template <class E>
void illuminate(E& exec, const TerrainView& t, const VegetationParameters& p, const surface::Heights& heights,
                const Workspace& work);

}  // namespace desert_sim::plants
