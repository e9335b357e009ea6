#pragma once
/// Reptation: grains that saltation hits creep down the slope. Nilles 2024 §3.7 and its later version, Paris
/// 2019 §5.1; physics.md B5. r is the strength that saltation left: (deposited + bounced)(1 − v) [m].
///
///   adaptive_repose  tan θ = lerp(tan θ_sand exp(−k_r r |w| (1 − r_s use_shadow)), tan θ_vegetated, v) ·
///   moisture,
///                    the donor's angle in the avalanche that follows
///   smoothing        flux between neighbours k_r |Δh|/(l d) ½(r_i + r_j) ½(|w_i| + |w_j|) Δt, down the
///   slope, at most
///                    the donor's sand, mean over 8; in as many sub-steps as its diffusion number needs
///   steepest         with probability (1 − v)(1 − e^(−r)), `slab`·Δt to the two steepest neighbours, by
///   their slopes
///
/// Saltation's deposit sets the angles, of every choice (without r but for adaptive_repose), in the same
/// pass: see Impacts. Reads sand, bedrock, soil, wind, wind_shadow, vegetation, moisture; writes sand and the
/// scratch layer of repose tangents.

#include <cstdint>

#include "kernels/backend/exec.hpp"
#include "kernels/sand/repose.hpp"

namespace desert_sim {

enum class ReptationMethod : int { off, adaptive_repose, smoothing, steepest };
constexpr const char* reptation_methods[] = {"off", "adaptive_repose", "smoothing", "steepest"};

struct ReptationParameters {
  ReptationMethod method = ReptationMethod::adaptive_repose;
  float strength = 0.1f;
  bool use_shadow = true;
  float slab = 0.1f;
};

constexpr auto parameter_table(const ReptationParameters*) {
  using P = ReptationParameters;
  return std::make_tuple(
      parameter("method", &P::method, reptation_methods, "How saltation's impacts move sand down the slope."),
      parameter("strength", &P::strength, 0, 10, "s/m^2", "Strength of adaptive_repose and smoothing (k_r)."),
      parameter("use_shadow", &P::use_shadow,
                "Whether adaptive_repose spares what lies in the wind's shadow."),
      parameter("slab", &P::slab, 0, 10, "m", "Sand that one event of `steepest` moves in 1 s."));
}
static_assert(table_is_complete<ReptationParameters>());

namespace reptation {

/// The angle of repose of a cell's sand where impacts of strength r [m] loosen it, in the wind's speed [m/s].
struct Angle {
  repose::Tangents tangents;
  float loosening;  ///< k_r of adaptive_repose, else 0
  float sparing;    ///< share of the loosening from which the wind's shadow spares: 1 or 0
  float* repose;

  Angle(const ReptationParameters& p, const ReposeParameters& repose_parameters, float* tangents_of_repose)
      : tangents(repose_parameters),
        loosening(p.method == ReptationMethod::adaptive_repose ? p.strength : 0.0f),
        sparing(p.use_shadow ? 1.0f : 0.0f),
        repose(tangents_of_repose) {}

  /// The tangent of dry bare sand.
  DESERT_HD float loosened(float r, float speed, float shadow) const {
    if (!(loosening > 0.0f)) return tangents.sand;
    return tangents.sand * exp_negative(loosening * r * speed * (1.0f - shadow * sparing));
  }
  /// v vegetation, m relative moisture.
  DESERT_HD float of(float dry_and_bare, float v, float m) const {
    return lerp(dry_and_bare, tangents.vegetated, v) * repose::moisture_factor(m);
  }
};

/// What saltation leaves behind in a cell: its angle, and the strength itself where somebody needs it.
struct Impacts {
  Angle angle;
  float* strength;  ///< [m], or null

  DESERT_HD void set(int i, float r, float loosened_angle, float v, float m) const {
    angle.repose[i] = angle.of(loosened_angle, v, m);
    if (strength) strength[i] = r;
  }
};

template <class E>
void set_angles(E& exec, const TerrainView& t, const Angle& angle, const ReposeParameters& p,
                const float* strength);

/// Whether step() does anything: adaptive_repose has done with the angles.
inline bool moves_sand(const ReptationParameters& p) {
  return p.method == ReptationMethod::steepest ||
         (p.method == ReptationMethod::smoothing && p.strength > 0.0f);
}

/// Moves sand. Scratch: `change` (quanta) one a cell. `seed` and `tick` (steps done) draw the events of
/// `steepest`.
template <class E>
void step(E& exec, const TerrainView& t, const ReptationParameters& p, float time_step, std::uint64_t seed,
          std::uint64_t tick, const float* reptation_strength, Quanta* change);

}  // namespace reptation
}  // namespace desert_sim
