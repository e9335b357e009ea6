#pragma once
/// Slip and sinkage of a wheel, by the ground under it. Two laws (`traversability.wheel_law`):
///
/// `bekker`, the terramechanics of Bekker (pressure), Reece and Wong (shear): a wheel of radius r, width b
/// and load W stands in ground of the constants c, φ, k_c, k_φ, n, K
///
///   static sinkage        z₀ = (3 W / (b (3 − n)(k_c/b + k_φ) √(2r)))^(2/(2n+1)),  at most r
///   length of contact     L  = √(z₀ (2r − z₀))
///   rolling resistance    R  = b (k_c/b + k_φ) z₀^(n+1)/(n + 1)
///   thrust at slip s      H  = (c b L + W tan φ)(1 − (1 − e^(−x))/x),   x = s L/K
///   steady slip           H  = R + W tan α,  by Newton's method; 1 where no slip is enough
///   sinkage               z  = z₀ (1 + |s|)/(1 − |s|/2)          (Lyasko's slip sinkage)
///   sideways              H(tan β) = W |tan α_across|,  β the slip angle
///
/// `light`, measured on a small rover in dry sand (arXiv 2601.04547), v the speed [m/s], α the slope [deg], F
/// the load of a wheel [N]:
///
///   s      = (0.00522 v + 0.00105) α² + 0.0265 v + 0.0256        (downhill the first term is subtracted)
///   z [mm] = 33.56 s + 0.929 (F − F_ref) + 3.11                   F_ref the rover's weight by its wheels
///   tan β  = 0.00105 α²                                           the same law at v = 0, without its offset
///
/// The constants of ground between loose and packed are linear in the looseness that counts for the wheel,
///
///   ℓ = looseness · max(1 − 2 m, 0) · min(depth of sand/r, 1)
///
/// because damp sand holds together (m relative moisture), and thin sand lets the wheel down on what is
/// below. Moisture multiplies shear strength by f(m) of repose.hpp, which grows to half-wet ground and
/// falls to mud, and there the moduli of pressure, too. `light` is multiplied by lerp(`light_packed`, 1,
/// ℓ)/min(f, 1).
///
/// A wheel sinks no deeper than its diameter, nor than there is sand: rock and soil carry it, with the
/// shear strength of packed ground. Wheels on one frame that turn alike have one slip, which follows from
/// the *mean* of their slopes and of their ground. A rover therefore calls longitudinal_slip() once, with
/// the means under its wheels, and sinkage() for each wheel. Tracks of wheels ahead are not considered;
/// whoever packs the layer looseness under its wheels has them.

#include "kernels/base/math.hpp"
#include "kernels/rover/traversability_parameters.hpp"
#include "kernels/sand/repose.hpp"

namespace desert_sim::wheels {

/// The ground under one wheel, or the mean under several.
struct Ground {
  float looseness;   ///< 0 packed … 1 fresh
  float sand_depth;  ///< [m]
  float moisture;    ///< relative, 0 … 1
};

/// Constants of the ground.
struct Soil {
  float cohesion;      ///< c [Pa]
  float tan_friction;  ///< tan φ
  float k_c, k_phi, exponent;
  float shear;  ///< K [m]
};

/// The wheels of one rover on any ground; copied to the device.
struct WheelGround {
  WheelLaw law;
  float radius, width;  ///< r, b [m]
  float load;           ///< nominal load W of a wheel [N]
  Soil loose, packed;
  float light_packed;
  repose::MoistureFactor moisture_factor;  ///< f

  // ---- what a rover needs

  /// Steady slip s = 1 − v/(ω r) of a rover that drives at `speed` [m/s] where the ground rises by `slope`
  /// [rad] along its way. 1: the wheels turn on the spot. Negative: downhill it slides ahead of its wheels;
  /// −1 at least.
  DESERT_HD float longitudinal_slip(float slope, float speed, const Ground& ground) const {
    if (law == WheelLaw::light) return light_slip(slope, speed, ground);
    const Support support = support_of(1.0f, ground);
    const float needed = tangent(slope) + support.resistance;
    return needed < 0.0f ? -slip_for(-needed, support) : slip_for(needed, support);
  }

  /// Tangent of the slip angle: the drift sideways over the way made forward, where the ground rises by
  /// `cross_slope` [rad] to the left. Positive to the right, which is downhill; −1 … 1, at which the rover
  /// slides.
  DESERT_HD float lateral_slip(float cross_slope, const Ground& ground) const {
    const float steepness = fabsf(cross_slope);
    float drift;
    if (law == WheelLaw::light) {
      const float degrees = steepness * degrees_per_radian;
      drift = minimum(light_slope_factor * degrees * degrees * light_share(ground), 1.0f);
    } else {
      drift = slip_for(tangent(steepness), support_of(1.0f, ground));
    }
    return cross_slope < 0.0f ? -drift : drift;
  }

  /// How deep the wheel stands in the ground [m], positive down, once it has turned over the length of its
  /// contact at this slip. `load_share`: its load over the nominal one.
  DESERT_HD float sinkage(float slip, float load_share, const Ground& ground) const {
    const float s = minimum(fabsf(slip), 1.0f);
    float depth;
    if (law == WheelLaw::light)
      depth = 1e-3f * (33.56f * s + 0.929f * (load_share - 1.0f) * load + 3.11f) *
              lerp(light_packed, 1.0f, softness(ground));
    else
      depth = static_sinkage(load_share, ground) * (1.0f + s) / (1.0f - 0.5f * s);
    return clamp(depth, 0.0f, minimum(maximum(ground.sand_depth, 0.0f), 2.0f * radius));
  }

  /// The sinkage of a wheel that stood `depth` [m] deep, after its rim has turned over `rim_way` = ω r Δt
  /// [m] at this slip: it digs itself in, and out, as
  ///
  ///   dz/d(rim way) = (z(s) − z)/L,   L the length of its contact at z(s), a tenth of r at least,
  ///
  /// whose exact solution this is, so that the result does not depend on how a way is divided. A rover keeps
  /// one depth a wheel and calls this at each of its steps.
  DESERT_HD float sinkage_after(float depth, float rim_way, float slip, float load_share,
                                const Ground& ground) const {
    const float steady = sinkage(slip, load_share, ground);
    const float length = maximum(contact_length(steady), 0.1f * radius);
    return steady + (depth - steady) * exp_negative(fabsf(rim_way) / length);
  }

  // ---- the parts of the laws

  /// What carries the wheel, over its load.
  struct Support {
    float resistance;  ///< R/W
    float strength;    ///< (c b L/W + tan φ) f(m), what H/W tends to
    float stretch;     ///< L/K
  };

  /// ℓ, the looseness that counts for the wheel.
  DESERT_HD float softness(const Ground& ground) const {
    const float deep = clamp(ground.sand_depth / radius, 0.0f, 1.0f),
                dry = clamp(1.0f - 2.0f * ground.moisture, 0.0f, 1.0f);
    return clamp(ground.looseness, 0.0f, 1.0f) * deep * dry;
  }
  DESERT_HD Soil soil(const Ground& ground) const {
    const float l = softness(ground), weak = minimum(moisture_factor(ground.moisture), 1.0f);
    return {lerp(packed.cohesion, loose.cohesion, l), lerp(packed.tan_friction, loose.tan_friction, l),
            weak * lerp(packed.k_c, loose.k_c, l),    weak * lerp(packed.k_phi, loose.k_phi, l),
            lerp(packed.exponent, loose.exponent, l), lerp(packed.shear, loose.shear, l)};
  }
  DESERT_HD float static_sinkage(float load_share, const Soil& s) const {
    const float modulus = s.k_c / width + s.k_phi, n = s.exponent;
    const float pressed =
        3.0f * load * maximum(load_share, 0.0f) / (width * (3.0f - n) * modulus * sqrtf(2.0f * radius));
    return minimum(power(pressed, 2.0f / (2.0f * n + 1.0f)), radius);
  }
  DESERT_HD float static_sinkage(float load_share, const Ground& ground) const {
    return static_sinkage(load_share, soil(ground));
  }
  /// Length of the arc below the surface, as its projection ahead of the axle.
  DESERT_HD float contact_length(float depth) const {
    return sqrtf(maximum(depth * (2.0f * radius - depth), 0.0f));
  }
  DESERT_HD Support support_of(float load_share, const Ground& ground) const {
    const Soil s = soil(ground);
    const float weight = load * load_share;
    const float standing = static_sinkage(load_share, s), length = contact_length(standing);
    const float pressed = minimum(standing, maximum(ground.sand_depth, 0.0f)), n = s.exponent;
    const float resistance = width * (s.k_c / width + s.k_phi) * power(pressed, n + 1.0f) / (n + 1.0f);
    return {resistance / weight,
            (s.cohesion * width * length / weight + s.tan_friction) * moisture_factor(ground.moisture),
            length / s.shear};
  }
  /// Share of the strength that shear over the contact mobilises at x = s L/K: 1 − (1 − e^(−x))/x.
  DESERT_HD static float mobilised(float x) { return x > 0.0f ? 1.0f - lost_share(x) / x : 0.0f; }

  /// Its derivative, (1 − e^(−x)(1 + x))/x².
  DESERT_HD static float mobilised_slope(float x) {
    if (x < 0.05f) return 0.5f - x * (1.0f / 3.0f - 0.125f * x);
    return (1.0f - exp_negative(x) * (1.0f + x)) / (x * x);
  }

  /// The slip, 0 … 1, whose thrust over load is `needed` ≥ 0; 1 where none is enough. Newton's method from
  /// below: mobilised() is concave and begins as x/2 − x²/6, so that each step comes nearer and none goes
  /// too far.
  DESERT_HD static float slip_for(float needed, const Support& support) {
    const float share = needed / support.strength;
    if (share >= mobilised(support.stretch)) return 1.0f;
    float x = share * (2.0f + share * (4.0f / 3.0f));
    for (int n = 0; n < newton_steps; ++n) x += (share - mobilised(x)) / mobilised_slope(x);
    return clamp(x / support.stretch, 0.0f, 1.0f);
  }

  DESERT_HD float light_share(const Ground& ground) const {
    return lerp(light_packed, 1.0f, softness(ground)) / minimum(moisture_factor(ground.moisture), 1.0f);
  }
  DESERT_HD float light_slip(float slope, float speed, const Ground& ground) const {
    const float degrees = slope * degrees_per_radian;
    const float rise = (0.00522f * speed + light_slope_factor) * degrees * degrees;
    const float s = (slope < 0.0f ? -rise : rise) + 0.0265f * speed + 0.0256f;
    return clamp(s * light_share(ground), -1.0f, 1.0f);
  }

  static constexpr int newton_steps = 6;
  static constexpr float degrees_per_radian = 57.29578f, light_slope_factor = 0.00105f;

  DESERT_HD static float tangent(float angle) {
    const float half_turns = angle * 0.318309886f;
    return sine_of_half_turns(half_turns) / sine_of_half_turns(0.5f - fabsf(half_turns));
  }
};

inline WheelGround make_wheel_ground(const TraversabilityParameters& rover, const WheelGroundParameters& g,
                                     const ReposeParameters& repose = {}) {
  const auto tan_of = [](float degrees) { return repose::Tangents::tangent(degrees); };
  return {rover.wheel_law,
          rover.wheel_radius,
          rover.wheel_width,
          rover.mass * rover.gravity / static_cast<float>(rover.wheels),
          {g.loose_cohesion, tan_of(g.loose_friction_deg), g.loose_k_c, g.loose_k_phi, g.loose_exponent,
           g.loose_shear},
          {g.packed_cohesion, tan_of(g.packed_friction_deg), g.packed_k_c, g.packed_k_phi, g.packed_exponent,
           g.packed_shear},
          g.light_packed,
          repose::MoistureFactor(repose)};
}

}  // namespace desert_sim::wheels
