#pragma once
/// Shallow water with momentum, on a staggered grid: depths in cells, velocities on faces. Stelling &
/// Duinmeijer 2003; Stelling & Zijlema 2003.
///
///   momentum   u_t + u u_x + v u_y + g W_x + (c + c_d |u|/h) u = a_wave,   c_d = c_f + g n²/h^⅓
///   depth      h_t + (h u)_x + (h v)_y = sources
///
/// and likewise for v. H is the solid surface, w the depth of water, W = H + w. On the face between cells i
/// and j, with its bed H_f = max(H_i, H_j):
///
///   depth      h_f = min(w, 2 max(W − H_f, 0)) of the upstream cell: its own depth, whatever the slope of
///              the bed, but no more than flows over a step
///   flux       q = u h_m: by h_f alone waves would lose their height, and fast streams at an angle to the
///              grid spread. In slow water h_m is the mean of h_f and of that of the downstream cell (at most
///              h_f/4 from h_f), in fast water (Fr ≥ 1) h_f + ½ minmod(its rises from the cell behind and to
///              the cell ahead), and between them between
///   slope      W_x = (max(W_j, H_f − l) − max(W_i, H_f − l))/l: a bed that falls by more than 45° is a step,
///              over which water is not pushed by all of the height that it falls
///   advection  Σ max(q̄_in, 0) (u − u_in)/(l h̄)  over the four sides of the face's own volume, which lies
///              between the middles of i and j; q̄ is the mean of the fluxes of two faces per metre, u_in the
///              velocity beyond the side, and h̄ the mean of w_i and w_j, or h_f where that is more and the
///              flow becomes faster. So momentum is conserved where the flow becomes slower, and a bore has
///              its speed and height; where it becomes faster, energy is, and the front on dry ground is not
///              held back.
///   friction   implicit, by the whole velocity, with the mean of v on the four faces around, and by h_m: by
///              the upstream depth streams at an angle to the grid spread
///
/// A lake stays at rest, to the bit, wet and dry: where surfaces are level nothing pulls. Films
/// (face_flow.hpp) have no velocity, but their water is kept. Depths never become negative: a cell's outflow
/// is limited to its water. Amounts of water are whole quanta, while velocities are floats
/// (water_movement.hpp).
///
/// A step is divided into as many sub-steps as stability needs, Δt ≤ C l/(√(2 g w) + |u| + |v|), found anew
/// for each of them; `most_substeps` does not apply.
///
/// Reads and writes what virtual pipes do. The layers of fluxes have u h_f l at the end of a step.

#include "kernels/backend/buffer.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/water/water_movement.hpp"

namespace desert_sim::shallow_water {

/// Velocities on the east and north faces of cells [m/s], and fluxes through them [m³/s], before and after a
/// sub-step: a law reads those of its neighbours.
struct Workspace {
  Buffer<float> supply_share;  ///< share of its outflow that a cell has water for
  Buffer<float> velocity_x[2], velocity_y[2], flux_x, flux_y;

  Workspace(Exec& exec, const Grid& grid);
  std::size_t bytes() const;
};

/// Copies the greatest speed to the host before each sub-step.
template <class E>
void step(E& exec, const TerrainView& t, const WaterParameters& p, const face_flow::StepInputs& in,
          LedgerView ledger, Workspace& work);

}  // namespace desert_sim::shallow_water
