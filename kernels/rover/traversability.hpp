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
///                    c = max(going, step_height/limit, roughness/limit, water, vegetation/limit, mud)
///
///                    water = max(d/`water_depth`, d |u|/`water_flow`)
///
///                    where the layer looseness is in use
///                    going = max(θ/`slope_deg`, s/`slip`, z/(`sinkage` r))
///                    with the uphill slip s and the sinkage z of wheel_layers.hpp, r the radius of a wheel
///
///                    elsewhere
///                    going = max(θ/θ_max, `sand_cost` σ)
///                    θ_max = lerp(`slope_deg`, `sand_slope_deg`, σ)
///                    σ = min(sand/`sand_depth`, 1)
///
///                    mud = max(m − ½, 0)/(`mud` − ½) · min((sand + soil)/`sand_depth`, 1)
///
/// j runs over the cells of the window, at offsets d_j [cells]. g is, for each axis, the flatter (minmod)
/// of the two one-sided differences, and 0 if these have opposite signs (minmod), so that an edge beside
/// flat ground counts with its full height. Where nobody follows how loose sand is, the slope limit θ_max
/// is lower on deep sand, because wheels slip there; where it is known, slip and sinkage say so themselves,
/// and `slope_deg` is the limit of tipping over. m is relative moisture (repose.hpp). The window is the
/// square of cells up to `window` away along x and y, 1 to 16 cells; at open edges the part of it that is
/// on the grid. `limit` is the parameter that belongs to each quantity.
///
/// d is the depth of water, u its velocity. Vehicles in floods lose their hold by the product of both:
/// Shand et al. 2011, Appropriate safety criteria for vehicles (Australian Rainfall and Runoff, project 10),
/// with d |u| ≤ 0.3 m²/s for small cars, in still water d ≤ 0.3 m.
///
/// Reads elevation, sand, soil, moisture, water, water_velocity_x, water_velocity_y, vegetation, obstacle,
/// looseness; writes those of slope, normal_x, normal_y, normal_z, roughness, step_height, slip,
/// slip_downhill, slip_across, sinkage and traversability that are present in the view.

#include "kernels/base/math.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/rover/traversability_parameters.hpp"
#include "kernels/sand/repose.hpp"

namespace desert_sim {

namespace traversability {

constexpr int max_window = 16;  ///< [cells]

inline int window_cells(const TraversabilityParameters& p, float cell_size) {
  return static_cast<int>(clamp(p.window / cell_size, 1.0f, static_cast<float>(max_window)));
}

/// What the laws are made from.
struct Rover {
  TraversabilityParameters limits;
  WheelGroundParameters ground;
  ReposeParameters repose;
};

/// Computes `rows` rows from row `first` on, which continue over the north edge. `elevation` must be up to
/// date everywhere.
template <class E>
void step(E& exec, const TerrainView& t, const Rover& rover, int first, int rows);

}  // namespace traversability
}  // namespace desert_sim
