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
/// Pipes know no momentum advection: a dam that breaks sends a front at a quarter of its speed over dry
/// ground, and streams faster than two thirds of their waves would break into pulses, because their floods
/// (at 3/2 u) outrun waves. So what flows out of a cell has at most froude_limit, as in other codes with
/// local inertia (Bates et al. 2010; Adams et al. 2017): streams that should be faster are steady, but
/// deeper and slower than real ones. Pipes are for slow water; shallow_water.hpp is right for fast water.
///
/// A step is divided into sub-steps with Δt < l/√(2 g w) for the deepest water, with a margin for it to
/// become deeper, and a wider one for streams at froude_limit. Where that takes more than `most_substeps`,
/// h_face is limited to a share of what is stable, and waves on deeper water are slower than they should be.
///
/// A pass cannot change the fluxes of a neighbour, so the limits by a cell's supply and Froude number
/// (`supply_share`) are applied to its fluxes when they are next used.
///
/// Sediment moves with its water (sediment_transport.hpp). Reads bedrock, soil, sand, water, water_flux_x,
/// water_flux_y, suspended_sediment, wind_x, wind_y; writes water, water_flux_x, water_flux_y,
/// water_velocity_x, water_velocity_y, suspended_sediment.

#include "kernels/backend/buffer.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/water/water_movement.hpp"

namespace desert_sim::virtual_pipes {

struct Substeps {
  double depth = 0;     ///< that they are for: the greatest, or stream_depth times that of a fast stream [m]
  double needed = 1;    ///< more than were taken if the step had too few
  float time_step = 0;  ///< that they divide [s]
};
/// Streams near froude_limit need sub-steps as if they were so much deeper. No parameter: it belongs to
/// froude_limit and to the scheme's stability.
constexpr float stream_depth = 1.69f;

/// |u|/√(g w) of what flows out of a cell to its neighbours, at most. No parameter: it is where pipes, which
/// carry no momentum, break into pulses; shallow_water has no such limit.
constexpr float froude_limit = 2.0f / 3;

struct Workspace {
  Buffer<float> supply_share;  ///< share of its outflow that a cell has water for, at froude_limit
  Substeps substeps = {};      ///< of the last step
  std::size_t bytes() const { return supply_share.bytes(); }
};

/// Copies the greatest depth to the host.
template <class E>
void step(E& exec, const TerrainView& t, const WaterParameters& p, const face_flow::StepInputs& in,
          LedgerView ledger, Workspace& work);

}  // namespace desert_sim::virtual_pipes
