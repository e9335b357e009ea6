#pragma once
/// Formation and drying of soil: dry soil turns to sand, and humus turns sand to soil. Nilles 2025 §3.3.2,
/// eq. 28–29.
///
///   drying    min(φ_d Δt (1 − v) max(1 − m/m_dry, 0) e^(−s/s_c), e)   of soil becomes sand
///   forming   min(φ_h Δt v m, s, humus)                                  of sand becomes soil
///
/// e is the depth of soil, s of sand [m], s_c `cover`, v vegetation, m relative moisture (repose.hpp).
/// Each reduces humus by the same depth, as far as there is any. Without the layer humus no soil forms.
///
/// Reads soil, sand, humus, moisture, vegetation; writes soil, sand, humus.

#include "kernels/field/dice.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/sand/repose.hpp"
#include "src/core/parameter_table.hpp"

namespace desert_sim {

struct SoilParameters {
  bool enabled = false;
  float drying = 0.01f;
  float dry = 0.02f;
  float forming = 0.01f;
  float cover = 0.1f;
};

constexpr auto parameter_table(const SoilParameters*) {
  using P = SoilParameters;
  return std::make_tuple(
      parameter("enabled", &P::enabled, "Whether soil dries to sand, and humus makes sand soil."),
      parameter("drying", &P::drying, 0, 10, "m/s",
                "Depth of bare, wholly dry soil that becomes sand a second."),
      parameter("dry", &P::dry, 1e-4, 1, "1", "Relative moisture below which soil dries (m_dry)."),
      parameter("forming", &P::forming, 0, 10, "m/s",
                "Depth of sand that becomes soil a second under full vegetation on wet ground with humus."),
      parameter("cover", &P::cover, 0.001, 1000, "m",
                "Depth of sand under which soil dries 1/e as fast (Nilles 2025, eq. 28)."));
}
static_assert(table_is_complete<SoilParameters>());

namespace soil {

template <class E>
void step(E& exec, const TerrainView& t, const SoilParameters& p, const ReposeParameters& repose,
          float time_step, const Dice& dice, LedgerView ledger);

}  // namespace soil
}  // namespace desert_sim
