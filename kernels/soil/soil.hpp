#pragma once
/// Soil dries to sand; humus makes sand soil again. Nilles 2025 eq. 28–29; physics.md C5.
///
///   drying   φ_d Δt (1 − v) max(1 − m/m_dry, 0) e^(−10 s/1 m)   of soil becomes sand, as much humus goes
///   forming  min(φ_h Δt v m, s, humus)                            of sand becomes soil, as much humus goes
///
/// m is the ground's relative moisture (repose.hpp). Reads soil, sand, humus, moisture, vegetation; writes
/// soil, sand, humus.

#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/sand/repose.hpp"
#include "src/core/parameters.hpp"

namespace desert_sim {

struct SoilParameters {
  bool enabled = false;
  float drying = 0.01f;
  float dry = 0.02f;
  float forming = 0.01f;
};

constexpr auto parameter_table(const SoilParameters*) {
  using P = SoilParameters;
  return std::make_tuple(
      parameter("enabled", &P::enabled, "Whether soil dries to sand, and humus makes sand soil."),
      parameter("drying", &P::drying, 0, 10, "m/s",
                "Depth of bare, wholly dry soil that becomes sand a second."),
      parameter("dry", &P::dry, 1e-4, 1, "1", "Relative moisture below which soil dries (m_dry)."),
      parameter("forming", &P::forming, 0, 10, "m/s",
                "Depth of sand that becomes soil a second under full vegetation on wet ground with humus."));
}
static_assert(table_is_complete<SoilParameters>());

namespace soil {

template <class E>
void step(E& exec, const TerrainView& t, const SoilParameters& p, const ReposeParameters& repose,
          float time_step, LedgerView ledger);

}  // namespace soil
}  // namespace desert_sim
