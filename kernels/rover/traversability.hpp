#pragma once
/// Traversability: slope, normal, roughness and step height of the surface h, and from these and what lies on
/// it whether a rover gets through. It is no part of a simulation step, but computed on request
/// (Lifetime::on_request).
///
///   slope            θ = arctan |∇h|, by central differences, one-sided at open edges
///   normal           (−∂h/∂x, −∂h/∂y, 1)/√(1 + |∇h|²)
///   roughness        √(mean of (h_j − p_j)²) over the window, p the plane that fits it best (least squares)
///   step height      max |h_j − h − g·d_j|   where |h_j − h| > |d_j| l tan `slope_deg`
///   traversability   max(1 − c, 0), and 0 on obstacles
///                    c = max(θ/θ_max, step_height/limit, roughness/limit, water/limit, vegetation/limit,
///                            mud, `sand_cost` σ)
///                    σ = min(sand/`sand_depth`, 1)
///                    θ_max = lerp(`slope_deg`, `sand_slope_deg`, σ)
///                    mud = max(m − ½, 0)/(`mud` − ½) · min((sand + soil)/`sand_depth`, 1)
///
/// j runs over the cells of the window, at offsets d_j [cells]. g is, for each axis, the flatter (minmod) of
/// the two one-sided differences, and 0 if these have opposite signs (minmod), so that an edge beside flat
/// ground counts with its full height. The slope limit θ_max is lower on loose sand, because wheels slip
/// there. m is relative moisture (repose.hpp). The window is the square of cells up to `window` away along x
/// and y, 1 to 16 cells; at open edges the part of it that is on the grid. `limit` is the parameter that
/// belongs to each quantity.
///
/// Reads elevation, sand, soil, moisture, water, vegetation, obstacle; writes those of slope, normal_x,
/// normal_y, normal_z, roughness, step_height and traversability that are present in the view.

#include "kernels/field/layers.hpp"
#include "kernels/field/math.hpp"
#include "kernels/rover/rover_parameters.hpp"
#include "kernels/sand/repose.hpp"

namespace desert_sim {

namespace traversability {

constexpr int max_window = 16;  ///< [cells]

inline int window_cells(const TraversabilityParameters& p, float cell_size) {
  return static_cast<int>(clamp(p.window / cell_size, 1.0f, static_cast<float>(max_window)));
}

/// Computes `rows` rows from row `first` on, which continue over the north edge. `elevation` must be up to
/// date everywhere.
template <class E>
void step(E& exec, const TerrainView& t, const TraversabilityParameters& p, const ReposeParameters& repose,
          int first, int rows);

}  // namespace traversability
}  // namespace desert_sim
