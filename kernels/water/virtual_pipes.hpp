#pragma once
/// Water flows through virtual pipes between cells. Mei 2007, Nilles 2025 §3.4; physics.md C2.
///
///   q ← (1 − c Δt) q + Δt A (g (W_i − W_j)/l + a_wave),   A = l · h_face
///           then q + (c_f Δt/(l h_face²)) |q| q = that: drag of the bed, − c_f |u| u/h (Chézy)
///   h_face  water above the higher bed of the two: max(W_i, W_j) − max(H_i, H_j), not below 0
///   a_wave = s (1 − e^(−½ 0.01 (w_i + w_j)²)) max(sin 2π t/T, 0) (mean wind · pipe's direction)
///   w += Δt (Σ in − Σ out)/l²,   what a cell gives in all held to what it has
///
/// One signed flux a face: that of a cell's east face and of its north face are its own. Amounts are rounded
/// to quanta once a face, the same from both sides, so that none is lost. (Published: two outflows a pair,
/// which make waves √2 too fast when the flow turns, and a constant section, with which waves do not know the
/// depth.)
///
/// A step is divided so that Δt < l/√(2 g h) with the deepest water, with room for it to become deeper; if
/// that would be more parts than `most_substeps`, faces are no higher than is stable, and waves on deeper
/// water slower than they should be. Over open edges water leaves as over a sill, at the speed √(g h), or as
/// fast as it comes through the cell; down to the sea's level, where there is one.
///
/// A pass cannot change the fluxes of a neighbour, so what a cell's supply holds back (`held`) is taken off
/// its fluxes when they are next used.
///
/// Sediment goes with the water that it is in (sediment_transport.hpp).
/// Reads bedrock, soil, sand, water, water_flux_*, wind; writes water, water_flux_*, water_velocity_*,
/// suspended_sediment.

#include "kernels/backend/buffer.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/water/water_sources.hpp"

namespace desert_sim::virtual_pipes {

struct Workspace {
  Buffer<float> held;  ///< share of its outflow that a cell has water for
};

/// `time` [s] that waves are at; `carried`: scratch of one value a cell. Reads the greatest depth back.
template <class E>
void step(E& exec, const TerrainView& t, const WaterParameters& p, float time_step, double time,
          Quanta sea_level, LedgerView ledger, Quanta* carried, Workspace& work);

}  // namespace desert_sim::virtual_pipes
