#pragma once
/// Shallow water flow through virtual pipes between cells. Mei 2007; Nilles 2025 §3.4.1–3.4.2, eq. 30.
///
///   flux       q* = (1 − c Δt) q + Δt A (g (W_i − W_j)/l + a_wave),   A = l h_face
///   drag       q + c_f Δt/(l h_face²) |q| q = q*   (Chézy: − c_f |u| u/h, implicit)
///   face       h_face = max(max(W_i, W_j) − max(H_i, H_j), 0)
///   waves      a_wave = s (1 − e^(−½ · 0.01 (w_i + w_j)²)) max(sin 2π t/T, 0) · ½(u_i + u_j)
///   depth      w += Δt (Σ q_in − Σ q_out)/l²,   where a cell's outflow is limited to its water
///   velocity   U_x = ½(q_west + q_east)/(l w),   U_y = ½(q_south + q_north)/(l w)
///
/// H is the solid surface, w the depth of water, W = H + w, u the wind's component along the pipe; in the
/// velocity w is the mean depth of the sub-step, and films have none. Each face has one signed flux; a cell
/// stores those of its east and its north face. Amounts are rounded to quanta by dice that turn regularly
/// (dice.hpp), alike from both sides of a face, so that none is lost and no flow is too small for a short
/// step; up to three quanta of a cell wait for more, because four faces may round as much up. Surfaces that
/// differ by one quantum are level: they do not pull, and less than half a quantum a sub-step stops between
/// them, because what rounding leaves would keep a lake moving. The published method has two outflow fluxes
/// per pair of cells, which makes waves √2 too fast once the flow reverses, and a constant pipe section, with
/// which the speed of waves does not depend on depth.
///
/// A step is divided into sub-steps with Δt < l/√(2 g w) for the deepest water, with a margin for it to
/// become deeper. Where that takes more than `most_substeps`, h_face is limited to what is stable, and waves
/// on deeper water are slower than they should be. Over open edges water leaves as over a sill, at the speed
/// √(g w) or as fast as it flows through the cell, down to the level of the sea where there is one.
///
/// Each sub-step begins and ends with the sea at its level (water_sources.hpp): filled once a step, it would
/// give less the longer the step is.
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
#include "kernels/water/water_parameters.hpp"

namespace desert_sim::virtual_pipes {

struct Workspace {
  Buffer<float> supply_share;  ///< share of its outflow that a cell has water for
  std::size_t bytes() const { return supply_share.bytes(); }
};

struct StepInputs {
  float time_step;           ///< [s]
  double time;               ///< of the waves [s]
  std::uint64_t seed, tick;  ///< key and counter (steps done) of the dice
  Quanta sea_level;
  Quanta* carried;  ///< scratch, one value a cell
};

/// Copies the greatest depth to the host.
template <class E>
void step(E& exec, const TerrainView& t, const WaterParameters& p, const StepInputs& in, LedgerView ledger,
          Workspace& work);

}  // namespace desert_sim::virtual_pipes
