#pragma once
/// Shallow water flow through virtual pipes between cells. Mei 2007; Nilles 2025 §3.4.1–3.4.2, eq. 30.
///
///   flux       q* = (1 − c Δt) q + Δt A (g (W_i − W_j)/l + a_wave),   A = l h_face
///   drag       q + c_d Δt/(l h_face²) |q| q = q*   (− c_d |u| u/h, implicit;  c_d = c_f + g n²/h^⅓)
///   face       h_face = max(max(W_i, W_j) − max(H_i, H_j), 0)
///
/// H is the solid surface, w the depth of water, W = H + w; depths, velocities, waves and open edges are in
/// water_movement.hpp. Surfaces that differ by one quantum are level: they do not pull, and less than half a
/// quantum a sub-step stops between them, because what rounding leaves would keep a lake moving. The
/// published method has two outflow fluxes per pair of cells, which makes waves √2 too fast once the flow
/// reverses, and a constant pipe section, with which the speed of waves does not depend on depth.
///
/// Pipes know no momentum advection: a dam that breaks sends a front at less than half of its speed over dry
/// ground, and streams faster than two thirds of their waves break into pulses (shallow_water.hpp has both
/// right). They are for slow water.
///
/// A step is divided into sub-steps with Δt < l/√(2 g w) for the deepest water, with a margin for it to
/// become deeper. Where that takes more than `most_substeps`, h_face is limited to a share of what is stable,
/// and waves on deeper water are slower than they should be.
///
/// A pass cannot change the fluxes of a neighbour, so the limit by a cell's supply (`supply_share`) is
/// applied to its fluxes when they are next used.
///
/// Sediment moves with its water (sediment_transport.hpp). Reads bedrock, soil, sand, water, water_flux_x,
/// water_flux_y, suspended_sediment, wind_x, wind_y; writes water, water_flux_x, water_flux_y,
/// water_velocity_x, water_velocity_y, suspended_sediment.

#include "kernels/backend/buffer.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/water/water_movement.hpp"

namespace desert_sim::virtual_pipes {

struct Workspace {
  Buffer<float> supply_share;  ///< share of its outflow that a cell has water for
  std::size_t bytes() const { return supply_share.bytes(); }
};

/// Copies the greatest depth to the host.
template <class E>
void step(E& exec, const TerrainView& t, const WaterParameters& p, const face_flow::StepInputs& in,
          LedgerView ledger, Workspace& work);

}  // namespace desert_sim::virtual_pipes
