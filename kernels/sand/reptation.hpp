#pragma once
/// Reptation (creep): the impacts of saltating grains move sand down the slope. Nilles 2024 §3.7, eq. 6–8
/// (smoothing); Nilles and Günther 2024 (adaptive_repose); Paris 2019 §5.1 (steepest).
///
/// Saltation gives each cell an impact strength r = (deposited + bounced)(1 − v) [m per hop]. The methods are
///
///   adaptive_repose   tan θ = lerp(tan θ_sand · exp(−k_r r |w| (1 − r_s)), tan θ_vegetated, v) · f(m)
///   smoothing         q_ij  = ⅛ min(k Δt |h_i − h_j|/(l d) · ½(r_i + r_j) · ½(|w_i| + |w_j|),
///                                   ½ |h_i − h_j|, s_donor)
///   steepest          P     = 1 − e^(−r),   amount = min(`slab`, half the steepest drop, s)
///
/// with the factors of repose.hpp, d = 1 or √2, k_r = `strength`. `adaptive_repose` lowers the donor's angle
/// of repose θ in the avalanche that follows; without `use_shadow` its r_s is 0. `smoothing` moves q_ij [m]
/// from the higher to the lower of two neighbours, the method `smoothing` in as many sub-steps as its
/// diffusion number needs. Beside another method there is one sub-step, which needs no maximum to be read
/// back; the first bound keeps it stable however large k is: a cell gives at most half of what would level it
/// with its eight neighbours. `steepest` is a
/// random event in each cell, of probability P Δt in a step of Δt ≤ 1 s (in a longer one P, with Δt times the
/// `slab`), which divides the amount among the two steepest neighbours in proportion to their slopes. Of the
/// impacts of a metre of sand each starts the event with probability 1 − v (Paris' β_R), which r contains: P
/// is the probability that at least one of them does.
///
/// As published, `adaptive_repose` shapes dunes while a weak `smoothing` keeps sand from oscillating from
/// cell to cell: k = `smoothing_strength` beside the other methods, and k = k_r + `smoothing_strength` with
/// the method `smoothing`.
///
/// The deposition pass of saltation sets the angles of repose for every method (see Impacts), and
/// set_angles() does so where saltation is off; r lowers them with adaptive_repose only.
///
/// set_angles() reads soil, sand, moisture, vegetation, wind_x, wind_y, wind_shadow; it writes the tangents
/// of repose, which are scratch. step() reads bedrock, soil, sand, obstacle, wind_x, wind_y; it writes
/// sand.

#include <cstdint>

#include "kernels/backend/exec.hpp"
#include "kernels/field/dice.hpp"
#include "kernels/sand/repose.hpp"

namespace desert_sim {

enum class ReptationMethod : int { off, adaptive_repose, smoothing, steepest };
constexpr const char* reptation_methods[] = {"off", "adaptive_repose", "smoothing", "steepest"};

struct ReptationParameters {
  ReptationMethod method = ReptationMethod::adaptive_repose;
  float strength = 0.1f;
  float smoothing_strength = 0.0f;
  bool use_shadow = true;
  float slab = 0.1f;
};

constexpr auto parameter_table(const ReptationParameters*) {
  using P = ReptationParameters;
  return std::make_tuple(
      parameter("method", &P::method, reptation_methods, "How saltation's impacts move sand down the slope."),
      parameter("strength", &P::strength, 0, 10, "s/m^2", "Strength of adaptive_repose and smoothing (k_r)."),
      parameter("smoothing_strength", &P::smoothing_strength, 0, 10, "s/m^2",
                "Strength of the smoothing that acts beside any method; 0 is none."),
      parameter("use_shadow", &P::use_shadow,
                "Whether adaptive_repose spares what lies in the wind's shadow."),
      parameter("slab", &P::slab, 0, 10, "m",
                "Sand that one event of `steepest` moves, and an impact of desertscape_2019: 0.1 keeps cells "
                "of a metre flat, 0.01 lets dunes grow."));
}
static_assert(table_is_complete<ReptationParameters>());

namespace reptation {

/// The angle of repose of a cell's sand, which impacts may lower.
struct Angle {
  repose::Tangents tangents;
  float impact_factor;  ///< k_r of adaptive_repose, else 0
  float shadow_weight;  ///< weight of the wind shadow r_s: 1 with `use_shadow`, else 0
  float* repose;

  Angle(const ReptationParameters& p, const ReposeParameters& repose_parameters, float* tangents_of_repose)
      : tangents(repose_parameters),
        impact_factor(p.method == ReptationMethod::adaptive_repose ? p.strength : 0.0f),
        shadow_weight(p.use_shadow ? 1.0f : 0.0f),
        repose(tangents_of_repose) {}

  /// Tangent of dry bare sand under impacts of strength r [m], at wind speed [m/s] and wind shadow r_s.
  DESERT_HD float lowered_tangent(float r, float speed, float shadow) const {
    if (!(impact_factor > 0.0f)) return tangents.sand;
    return tangents.sand * exp_negative(impact_factor * r * speed * (1.0f - shadow * shadow_weight));
  }
  /// Tangent at vegetation v and relative moisture m, from that of dry bare sand.
  DESERT_HD float tangent_at(float dry_and_bare, float v, float m) const {
    return lerp(dry_and_bare, tangents.vegetated, v) * tangents.moisture_factor(m);
  }
};

/// What saltation writes to a cell: its tangent of repose and, if `strength` is not null, the impact
/// strength.
struct Impacts {
  Angle angle;
  float* strength;  ///< [m], or null

  DESERT_HD void set(int i, float r, float dry_tangent, float v, float m) const {
    angle.repose[i] = angle.tangent_at(dry_tangent, v, m);
    if (strength) strength[i] = r;
  }
};

template <class E>
void set_angles(E& exec, const TerrainView& t, const Angle& angle, const ReposeParameters& p,
                const float* strength);

/// Strength k of the smoothing.
inline float smoothing_strength(const ReptationParameters& p) {
  if (p.method == ReptationMethod::off) return 0.0f;
  return p.smoothing_strength + (p.method == ReptationMethod::smoothing ? p.strength : 0.0f);
}

/// Whether step() moves sand; adaptive_repose acts through the angles of repose alone.
inline bool moves_sand(const ReptationParameters& p) {
  return p.method == ReptationMethod::steepest || smoothing_strength(p) > 0.0f;
}

struct StepInputs {
  float time_step;           ///< [s]
  std::uint64_t seed, tick;  ///< key and counter (steps done) of the random numbers of `steepest`
  const float* strength;     ///< of the impacts; see Impacts
  Quanta* change;            ///< scratch, one value a cell [quanta]
};

/// Moves sand by smoothing and `steepest`.
template <class E>
void step(E& exec, const TerrainView& t, const ReptationParameters& p, const StepInputs& in,
          const Dice& dice);

}  // namespace reptation
}  // namespace desert_sim
