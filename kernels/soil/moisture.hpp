#pragma once
/// Water in the ground, of its upper metre. Nilles 2025 §3.4.4–3.4.5; physics.md C4.
///
///   capacity   C = c_M min(e + s, 1 m)
///   rate       r = lerp(r_soil, r_sand, min(s, 1 m))
///   seepage    M += min(r Δt (C − M), w), where M > C/2 · `when_wet`; what is over C comes out again
///   diffusion  M_i −= D Δt/l² min(C_i, C_j)(m_i − m_j), m = M/C: what is equally wet is at rest
///   drying     M ← M e^(−φ r (1 − ¾ v) Δt), at least one quantum, where no water stands
///
/// Published: diffusion of M itself, which would lift water into ground that has no room. On ground of one
/// depth they are the same. Diffusion is divided so that D Δt/l² ≤ ¼. Reads soil, sand, water, moisture,
/// vegetation; writes water, moisture.

#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "src/core/parameters.hpp"

namespace desert_sim {

struct MoistureParameters {
  bool enabled = false;
  float seepage_soil = 0.02f;
  float seepage_sand = 0.1f;
  float when_wet = 0.02f;
  float diffusion = 0.05f;
  float evaporation = 0.05f;
};

constexpr auto parameter_table(const MoistureParameters*) {
  using P = MoistureParameters;
  return std::make_tuple(
      parameter("enabled", &P::enabled, "Whether water seeps into the ground, and dries out of it."),
      parameter("seepage_soil", &P::seepage_soil, 0, 10, "1/s",
                "How fast soil fills up, as a share of the room that is left (r_soil)."),
      parameter("seepage_sand", &P::seepage_sand, 0, 10, "1/s", "How fast sand does (r_sand)."),
      parameter("when_wet", &P::when_wet, 0, 1, "1",
                "What is left of that speed in ground that is more than half full."),
      parameter("diffusion", &P::diffusion, 0, 1e4, "m^2/s",
                "How fast moisture spreads through the ground (D)."),
      parameter("evaporation", &P::evaporation, 0, 100, "1",
                "How fast bare ground dries, in parts of the speed at which it fills up (phi)."));
}
static_assert(table_is_complete<MoistureParameters>());

namespace moisture {

/// `capacity`: c_M; `gain`: scratch of one value a cell.
template <class E>
void step(E& exec, const TerrainView& t, const MoistureParameters& p, float capacity, float time_step,
          LedgerView ledger, Quanta* gain);

}  // namespace moisture
}  // namespace desert_sim
