#pragma once
/// Soil dries to sand; humus makes sand soil again. Nilles 2025 eq. 28–29; physics.md C5.
///
///   drying   φ_d Δt (1 − v) max(1 − m/m_dry, 0) e^(−10 s/1 m)   of soil becomes sand, as much humus goes
///   forming  min(φ_h Δt v m, s, humus)                            of sand becomes soil, as much humus goes
///
/// m is the ground's relative moisture (repose.hpp). Reads soil, sand, humus, moisture, vegetation; writes
/// soil, sand, humus.

#include "kernels/backend/for_each.hpp"
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

struct Change {
  Grid grid;
  SoilParameters p;
  float time_step, quantum, quanta_per_metre;
  repose::RelativeMoisture relative_moisture;
  const float* vegetation;
  Quanta *soil, *sand, *humus;
  LedgerView ledger;

  DESERT_HD void lose_humus(int i, Quanta amount) const {
    if (humus) humus[i] -= amount < humus[i] ? amount : humus[i];
  }
  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    const float m = relative_moisture(i), v = value_or_zero(vegetation, i), s = sand[i] * quantum;
    const float thirst = maximum(1.0f - m / p.dry, 0.0f) * exp_negative(10.0f * maximum(s, 0.0f));
    const Quanta dried = take(p.drying * time_step * (1.0f - v) * thirst, quanta_per_metre, soil[i]);
    const Quanta fertile = humus ? (humus[i] < sand[i] ? humus[i] : sand[i]) : 0;
    const Quanta formed = take(p.forming * time_step * v * m, quanta_per_metre, fertile);
    soil[i] += formed - dried;
    sand[i] += dried - formed;
    lose_humus(i, dried + formed);
    ledger.convert(Material::soil, Material::sand, i, dried);
    ledger.convert(Material::sand, Material::soil, i, formed);
  }
};

template <class E>
void step(E& exec, const TerrainView& t, const SoilParameters& p, const ReposeParameters& repose,
          float time_step, LedgerView ledger) {
  for_each_cell(exec, t.grid,
                Change{t.grid, p, time_step, t.quantum, t.quanta_per_metre,
                       repose::RelativeMoisture(t, repose), t.real(Layer::vegetation), t.quanta(Layer::soil),
                       t.quanta(Layer::sand), t.quanta(Layer::humus), ledger});
}

}  // namespace soil
}  // namespace desert_sim
