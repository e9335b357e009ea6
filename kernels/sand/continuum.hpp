#pragma once
/// Continuum transport of sand in real units. Kroy, Sauermann & Herrmann 2002; Durán & Moore 2013; Andreotti
/// et al. 2010 for the saturation length. It takes the place of the hops of saltation.hpp.
///
///   ∇·(q e) = (q_s − q)/L_sat          flux q along e [m²/s], of q_s in saturated_flux.hpp
///   ∂h/∂t   = −∇·(q e)                 Exner
///   e       ∝ τ/|τ| − √(Θ_t/Θ) ∇_⊥h/μ  sand is turned downhill; ∇_⊥ is the slope across τ
///
/// The air takes up no more than the sand that lies in a cell: over rock the flux can only fall. Over a step
/// the flux is in balance with the wind, because sand crosses a dune in a fraction of the time in which the
/// dune changes. A sweep downwind (downwind.hpp) finds it: of what comes into a cell from the line before,
/// F_in [m of depth a step], a cell hands on
///
///   F_out = F_in e^(−λ) + q_s cos γ Δt/l (1 − e^(−λ)),   λ = l/(L_sat cos γ),   at most F_in + s
///
/// with γ the angle between e and the axis of the sweep, which solves the equation for a q_s that is linear
/// in the cell, if it is that of the place at which e^(−(x_out − x)/L_sat) has its mean:
///
///   x − x_middle = l (½ coth ½λ − 1/λ)
///
/// The amounts are whole quanta, and what a cell hands on is exactly what the next line gets: no sand is
/// lost. The undisturbed wind carries it from line to line, between two places by to_second(); where e points
/// to the side of that, by at most a cell a line, shares of what comes go to the neighbours in the line, and
/// a ridge one cell wide loses sand to both. Sand that leaves over a periodic edge lies in the layer
/// airborne_sand until the next step takes it in on the other side; over an open edge it is booked as
/// outflow.
///
/// Plants take the share of the stress 1 − 1/(1 + Γ v), Γ = `plant_drag`. Moisture divides the threshold
/// by the dryness of saltation_inputs.hpp; nothing is taken up under water. An obstacle hands on what
/// comes. In the eddies before cliffs (echo_dunes.hpp), sand is lifted at −r_e m/s and none settles where
/// r_e < 0; where r_e > 0 the share r_e more settles and the share `sticky_lift` is taken up. Abrasion
/// acts on ground that is covered by less than its `cover`, with q for the product of wind and bouncing
/// sand of abrasion.hpp. The strength of impacts is q/|w|, the sand over a metre.
///
/// Where the layers flux_x and flux_y are in use, they get q e, from the counted quanta: the mean of what
/// enters and leaves a cell.
///
/// Reads wind_x, wind_y, sand, airborne_sand, soil, water, moisture, vegetation, obstacle, echo, and for
/// abrasion bedrock and erosion_resistance. Writes sand, airborne_sand and the impact strength, with abrasion
/// also bedrock and soil. Adds to flux_x and flux_y where they are in use.

#include <cstdint>

#include "kernels/backend/buffer.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/sand/abrasion.hpp"
#include "kernels/sand/saltation.hpp"
#include "kernels/sand/saturated_flux.hpp"
#include "kernels/wind/shear_stress.hpp"

namespace desert_sim::continuum {

/// Longest step that is stable and accurate [s]: the bed's fastest change, which is that of its shortest
/// waves,
///
///   |λ| = Q k² √(A² + B² + 1/(μ r²)²) / √(1 + k² L_sat²),   k = π / `stress_cell`
///
/// in which Q is the flux of twice the undisturbed stress (that of crests), and the width of a cell stands
/// for a `stress_cell` of 0, goes on for at most 1.5/|λ|; an explicit step is unstable from 2/|λ| on.
/// Infinity where the wind carries nothing.
float longest_step(const ContinuumParameters& p, const ShearStressParameters& stress, const Grid& grid,
                   float wind_speed);

/// Words that a place of the sweep hands on, and how many places to the side these are found.
constexpr int words_handed_on = 2, reach_of_words = 4;

/// Fields of a sweep, in its order of cells.
struct Workspace {
  Buffer<float> lead;          ///< of τ, from a line to the next [cells]; in the order of the terrain
  Buffer<float> decay, gain;   ///< e^(−λ) [1], and what the second term hands on [quanta]
  Buffer<float> level_gain;    ///< the latter with the q_s of the middle of the cell
  Buffer<std::uint32_t> turn;  ///< off the way of the undisturbed wind, as Turn
  Buffer<Quanta> lying;        ///< sand that can be taken up
  Buffer<Quanta> entering;     ///< sand that comes over the edge of the grid
  Buffer<Quanta> change, out;  ///< F_in − F_out and F_out
  Buffer<Quanta> over_ends;    ///< what is turned to beyond the ends of lines
  Buffer<Quanta> lines;        ///< what lines hand on

  std::size_t bytes() const;
};

Workspace make_workspace(Exec& exec, const Grid& grid);

struct StepInputs {
  ContinuumParameters continuum;
  ShearStressParameters stress;
  AbrasionParameters abrasion;
  ReposeParameters repose;
  SaltationParameters saltation;  ///< for the influx and the cut-off by moisture
  EchoDuneParameters echo;        ///< for what is taken up where sand is held
  float time_step;                ///< [s]
  float flux_time;                ///< over which flux_x and flux_y are a mean [s]
  wind::Vector above;             ///< undisturbed wind: its direction orders the sweep
  const float* heights;           ///< of the ground [quanta]
  float* impact_strength;         ///< [m], or null
};

template <class E>
void step(E& exec, const TerrainView& t, const StepInputs& in, const Dice& dice, LedgerView ledger,
          Workspace& work);

}  // namespace desert_sim::continuum
