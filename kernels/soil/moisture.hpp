#pragma once
/// Moisture of the upper ground. Nilles 2025 §3.4.4–3.4.5, eq. 32, 33, 35.
///
///   capacity      C = c_M min(e + s, d_M)       (repose.hpp)
///   rate          r = lerp(r_soil, r_sand, min(s/d_M, 1))
///   seepage       M += min(r Δt (C − M), w)     where M < C; r is multiplied by `when_wet` where
///                                               M > `wet_from` C
///   excess        w += M − C,  M ← C            where M > C
///   evaporation   M ← M e^(−φ r (1 − h v) Δt)   where there is no surface water; h = `plant_hold`
///   diffusion     M_i −= Σ_j D Δt/l² min(C_i, C_j)(m_i − m_j),   m = M/C
///
/// M is moisture, w water, e soil, s sand [m], v vegetation. The published method diffuses M itself, which
/// would move water into ground without capacity for it; on ground of equal depth the two are the same.
/// Diffusion has as many sub-steps as keep D Δt/l² ≤ ¼. The ledger records evaporation as outflow.
///
/// Reads soil, sand, water, moisture, vegetation; writes water, moisture.

#include "kernels/field/dice.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/sand/repose.hpp"
#include "src/core/parameter_table.hpp"

namespace desert_sim {

struct MoistureParameters {
  bool enabled = false;
  float seepage_soil = 0.02f;
  float seepage_sand = 0.1f;
  float when_wet = 0.02f;
  float diffusion = 0.05f;
  float evaporation = 0.05f;
  float wet_from = 0.5f;
  float plant_hold = 0.75f;
};

constexpr auto parameter_table(const MoistureParameters*) {
  using P = MoistureParameters;
  return std::make_tuple(
      parameter("enabled", &P::enabled, "Whether water seeps into the ground, and dries out of it."),
      parameter("seepage_soil", &P::seepage_soil, 0, 10, "1/s",
                "How fast soil fills up, as a share of the room that is left (r_soil)."),
      parameter("seepage_sand", &P::seepage_sand, 0, 10, "1/s", "How fast sand does (r_sand)."),
      parameter("when_wet", &P::when_wet, 0, 1, "1",
                "What is left of that speed in ground that is wetter than wet_from (Nilles 2025)."),
      parameter("diffusion", &P::diffusion, 0, 1e4, "m^2/s",
                "How fast moisture spreads through the ground (D)."),
      parameter("evaporation", &P::evaporation, 0, 100, "1",
                "How fast bare ground dries, in parts of the speed at which it fills up (phi)."),
      parameter("wet_from", &P::wet_from, 0, 1, "1",
                "Relative moisture above which when_wet holds (Nilles 2025: 50 %)."),
      parameter("plant_hold", &P::plant_hold, 0, 1, "1",
                "Share by which full vegetation slows the drying of the ground (Nilles 2025, eq. 35: 3/4)."));
}
static_assert(table_is_complete<MoistureParameters>());

namespace moisture {

struct StepInputs {
  float time_step;          ///< [s]
  ReposeParameters repose;  ///< for the ground's capacity
  Quanta* gain;             ///< scratch, one value a cell
};

template <class E>
void step(E& exec, const TerrainView& t, const MoistureParameters& p, const StepInputs& in, const Dice& dice,
          LedgerView ledger);

}  // namespace moisture
}  // namespace desert_sim
