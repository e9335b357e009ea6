#pragma once
/// What plants are to the terrain. Nilles 2025 §3.2.1, eq. 8–12; physics.md D.
///
///   vegetation     v = min(Σ D, 1)
///   canopy_height  max(r · stem · D)
///   humus          += Δt Σ φ_h D, at most `humus_limit`
///   of each species, its mature plants alone:
///     density      Σ D
///     downwind     Σ max(ŵ · d̂, 0) (1 − d / r_max), d the way from the plant, inside its radius
///
/// Each cell gathers, in the order of the sorted plants. Reads the heights of the surface, wind_x, wind_y;
/// writes vegetation, canopy_height, humus. `tops` get the canopy's surface, for the wind's shadow and for
/// light: the ground's heights where nothing grows.

#include "kernels/field/layers.hpp"
#include "kernels/plants/workspace.hpp"

namespace desert_sim::plants {

/// `makes_state`: also vegetation and humus, which a look at the terrain must leave alone.
template <class E>
void cover(E& exec, const TerrainView& t, const VegetationParameters& p, float time_step,
           const surface::Heights& heights, bool makes_state, Workspace& work);

}  // namespace desert_sim::plants
