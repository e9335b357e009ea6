#pragma once
/// Saltation: the wind lifts sand, carries it a hop, and part of it stays. Expected values, no dice.
/// Nilles 2024 §3.6; physics.md B1–B3.
///
///   lift     L = min(s, ε_s (1 − r_s)(1 − v)(r_e > 0 ? ½ : 1) M + (r_e < 0 ? k_e : 0)),  a += L
///            M = clamp(1 − 10 m, 0, 1), 0 under water; nothing lifts in still air or below the threshold
///            speed
///   advect   a moves by w Δt / l cells and is shared bilinearly among four (scattered integers: exact, any
///   order) deposit  p = clamp(max(r_s, (1 − f) + v f, r_e), 0, 1), f = 0.4 on sand, 0.5 on soil, 0.6 on
///   rock; 0 on obstacles
///            and in the lane before a cliff; · clamp(1 − 10 m, 0.01, 1), under water · 0.01;  s += p a
///   bounce   a ← (1 − p) a stays in the air; strength of reptation r = (deposited + bounced)(1 − v)
///
/// On open edges sand that is carried over an edge is booked as out; `influx` enters where the wind blows in,
/// spread over the first hop. Reads sand, wind, wind_shadow, echo, vegetation, obstacle, moisture, water;
/// writes sand, airborne_sand, and through abrasion bedrock and soil.

#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/sand/abrasion.hpp"
#include "kernels/sand/reptation.hpp"

namespace desert_sim {

struct SaltationParameters {
  bool enabled = true;
  float lift = 1.0f;
  float threshold_speed = 0.0f;
  float bounce_on_sand = 0.4f;
  float bounce_on_soil = 0.5f;
  float bounce_on_rock = 0.6f;
  float bare_depth = 0.001f;
  float influx = 0.0f;
};

constexpr auto parameter_table(const SaltationParameters*) {
  using P = SaltationParameters;
  return std::make_tuple(
      parameter("enabled", &P::enabled, "Whether the wind carries sand."),
      parameter("lift", &P::lift, 0, 10, "m", "Sand lifted from an open cell a step of 1 s (epsilon_s)."),
      parameter("threshold_speed", &P::threshold_speed, 0, 100, "m/s", "Wind below which nothing is lifted."),
      parameter("bounce_on_sand", &P::bounce_on_sand, 0, 1, "1",
                "Share of landing sand that bounces on sand (f)."),
      parameter("bounce_on_soil", &P::bounce_on_soil, 0, 1, "1",
                "Share of landing sand that bounces on soil."),
      parameter("bounce_on_rock", &P::bounce_on_rock, 0, 1, "1",
                "Share of landing sand that bounces on rock."),
      parameter("bare_depth", &P::bare_depth, 0, 1, "m",
                "Depth of sand below which the ground counts as bare."),
      parameter("influx", &P::influx, 0, 100, "m^2/s",
                "Sand that enters an open windward edge, per metre of edge."));
}
static_assert(table_is_complete<SaltationParameters>());

namespace wind_shadow {
struct Shadow;
}

namespace saltation {

/// `landed` (quanta): scratch memory of one value a cell. `shade`: what finds the wind's shadow first, or
/// null where it is there.
template <class E>
void step(E& exec, const TerrainView& t, const SaltationParameters& p, const AbrasionParameters& a,
          const ReposeParameters& repose, float time_step, LedgerView ledger, Quanta* landed,
          const reptation::Impacts& impacts, const wind_shadow::Shadow* shade);

}  // namespace saltation
}  // namespace desert_sim
