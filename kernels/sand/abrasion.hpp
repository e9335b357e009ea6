#pragma once
/// Abrasion: bouncing sand wears rock and soil to sand. Paris 2019 §5.2, Nilles 2024 §3.6; physics.md B4.
///
///   where s (before the deposit) < `cover` and sand bounces:  wear = k_a Δt |w| (1 − v)(1 − ρ)(1 − p) min(bouncing, 1 m)
///
/// Soil, where there is some, wears in the rock's place, less so with moisture: · max(1 − m/0.5, 0).
/// Part of the deposit pass of saltation. Reads what deposit reads, and erosion_resistance; writes bedrock,
/// soil, sand.

#include "kernels/field/ledger.hpp"
#include "kernels/sand/repose.hpp"

namespace desert_sim {

struct AbrasionParameters {
  float rate = 0.0f;
  float cover = 0.025f;
};

constexpr auto parameter_table(const AbrasionParameters*) {
  using P = AbrasionParameters;
  return std::make_tuple(
      parameter("rate", &P::rate, 0, 1, "1/m",
                "Wear a step per metre of bouncing sand and m/s of wind (k_a); 0 is off."),
      parameter("cover", &P::cover, 0, 10, "m", "Depth of sand that protects the ground."));
}
static_assert(table_is_complete<AbrasionParameters>());

namespace abrasion {

struct Wear {
  float rate;  ///< k_a Δt
  Quanta cover;
  float quantum, quanta_per_metre;
  Quanta *bedrock, *soil, *sand;
  const float* resistance;
  LedgerView ledger;

  /// `sand_hit`: the cell's sand before any was deposited; `bouncing`: sand that stays in the air over cell i; `speed` of the wind; v vegetation; m relative
  /// moisture; p the share of sand that was deposited.
  DESERT_HD void operator()(int i, Quanta sand_hit, Quanta bouncing, float speed, float v, float m,
                            float p) const {
    if (rate <= 0.0f || bouncing <= 0 || sand_hit >= cover) return;
    const float strength = rate * speed * (1.0f - v) * (1.0f - p) * minimum(bouncing * quantum, 1.0f);
    if (soil && soil[i] > 0) {
      const Quanta worn = take(strength * maximum(1.0f - 2.0f * m, 0.0f), quanta_per_metre, soil[i]);
      soil[i] -= worn;
      sand[i] += worn;
      ledger.convert(Material::soil, Material::sand, i, worn);
      return;
    }
    const Quanta room = bedrock[i] > -wall_height ? bedrock[i] + wall_height : 0;
    const Quanta worn = take(strength * (1.0f - value_or_zero(resistance, i)), quanta_per_metre, room);
    bedrock[i] -= worn;
    sand[i] += worn;
    ledger.convert(Material::bedrock, Material::sand, i, worn);
  }
};

}  // namespace abrasion
}  // namespace desert_sim
