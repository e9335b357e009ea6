#pragma once
/// Abrasion: bouncing sand wears bedrock, or soil where there is some, and turns it into sand. Paris 2019
/// §5.2; Nilles 2024 §3.6; Nilles 2025 §3.3.2 for soil.
///
///   bedrock   ε = k_a Δt |w| (1 − v)(1 − p) min(a, a_m) · (1 − ρ)
///   soil      ε = k_s Δt |w| (1 − v)(1 − p) min(a, a_m) · (1 − ρ) max(1 − m/m_c, 0)
///
/// k_a is `rate`, k_s `soil_rate`, w the wind, v vegetation, p the share of sand that was deposited, a the
/// sand that bounces in the time of a hop [m], a_m `most_bouncing`, ρ erosion_resistance, m relative
/// moisture, m_c `moisture_cutoff`. Abrasion acts where the sand before the deposit is shallower than
/// `cover` and a > 0, but neither on obstacles nor under water. It is part of saltation's deposition pass.
/// Reads bedrock, soil, sand, erosion_resistance and what that pass reads; writes bedrock, soil, sand.

#include "kernels/field/dice.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/sand/repose.hpp"

namespace desert_sim {

struct AbrasionParameters {
  float rate = 0.0f;
  float soil_rate = -1.0f;
  float cover = 0.025f;
  float moisture_cutoff = 0.5f;
  float most_bouncing = 1.0f;

  float rate_of_soil() const { return soil_rate < 0 ? rate : soil_rate; }
  bool wears_ground() const { return rate > 0 || soil_rate > 0; }
};

constexpr auto parameter_table(const AbrasionParameters*) {
  using P = AbrasionParameters;
  return std::make_tuple(
      parameter(
          "rate", &P::rate, 0, 1, "1/m",
          "Depth of bare rock worn a second, per metre of bouncing sand and m/s of wind (k_a); 0 is off."),
      parameter("soil_rate", &P::soil_rate, -1, 1, "1/m",
                "Likewise of dry bare soil; a negative value stands for that of `rate`."),
      parameter("cover", &P::cover, 0, 10, "m", "Depth of sand that protects the ground."),
      parameter(
          "moisture_cutoff", &P::moisture_cutoff, 0.001, 1, "1",
          "Relative moisture at which soil wears no more; it wears less the nearer to that it is (Nilles "
          "2025: 50 %)."),
      parameter("most_bouncing", &P::most_bouncing, 0.001, 1000, "m",
                "Depth of bouncing sand from which more of it does not wear faster."));
}
static_assert(table_is_complete<AbrasionParameters>());

namespace abrasion {

struct Abrade {
  float rate, soil_rate;  ///< k_a Δt, k_s Δt
  float per_moisture;     ///< 1/m_c
  float most_bouncing;    ///< [m]
  Quanta cover;
  float quantum, quanta_per_metre;
  Quanta *bedrock, *soil, *sand;
  const float* resistance;
  Die die;
  LedgerView ledger;

  DESERT_HD Quanta whole(float metres, Quanta available, int i) const {
    return die.whole_at_most(metres * quanta_per_metre, available, i);
  }
  /// `sand_before_deposit`: sand of cell i before the deposit; `bouncing`: sand that bounces there in the
  /// time of a hop [quanta]; `speed`: of the wind [m/s]; v: vegetation; m: relative moisture; p: deposited
  /// share.
  DESERT_HD void operator()(int i, Quanta sand_before_deposit, float bouncing, float speed, float v, float m,
                            float p) const {
    if (bouncing <= 0.0f || sand_before_deposit >= cover) return;
    const float strength = speed * (1.0f - v) * (1.0f - p) * minimum(bouncing * quantum, most_bouncing) *
                           (1.0f - value_or_zero(resistance, i));
    if (soil && soil[i] > 0) {
      const Quanta worn = whole(soil_rate * strength * maximum(1.0f - per_moisture * m, 0.0f), soil[i], i);
      soil[i] -= worn;
      sand[i] += worn;
      ledger.convert(Material::soil, Material::sand, i, worn);
      return;
    }
    const Quanta room = bedrock[i] > -wall_height ? bedrock[i] + wall_height : 0;
    const Quanta worn = whole(rate * strength, room, i);
    bedrock[i] -= worn;
    sand[i] += worn;
    ledger.convert(Material::bedrock, Material::sand, i, worn);
  }
};

}  // namespace abrasion
}  // namespace desert_sim
