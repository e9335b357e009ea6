#pragma once
/// The size of wind ripples, and the wind that shapes them.
///
/// Wavelength and speed of fully developed ripples are linear in the speed of the wind (Andreotti, Claudin
/// and Pouliquen 2006, Phys. Rev. Lett. 96, 028001; Paris et al. 2019, section 6, likewise). With u the speed
/// of the wind at the surface and u_t the `threshold_speed`,
///
///   wavelength  λ = min(`shortest` + `growth` (u − u_t), `longest`)    [m]
///   height      H = `steepness` λ s((u − u_t)/(1 m/s))                  [m], from trough to crest
///   celerity    c = `celerity` (u − u_t)                                [m/s], downwind
///
/// with s(t) = 3 t² − 2 t³ on 0 … 1, so that ripples rise smoothly from flat sand. By default λ and H span
/// the sizes that are observed, 13 … 300 mm and 0.6 … 14 mm.
///
/// Ripples need time to adapt. What shapes them is the running mean of the wind high above the ground over
/// the `response_time` T, as a vector w̄ and as a speed ū, and the number of ripples that have passed, N:
///
///   dw̄/dt = (w − w̄)/T,   dū/dt = (|w| − ū)/T,   dN/dt = c(ū)/λ(ū)
///
/// |w̄|/ū is 1 in a wind of one direction, and less in winds of several. All of it is continuous in time,
/// however the wind jumps.

#include <cmath>

#include "kernels/base/math.hpp"
#include "kernels/micro_relief/micro_relief_parameters.hpp"
#include "kernels/wind/vector.hpp"
#include "src/core/elementary.hpp"

namespace desert_sim {

namespace micro_relief {

/// 3 t² − 2 t³ on 0 … 1, constant beyond.
DESERT_HD float smooth_step(float t) {
  const float c = clamp(t, 0.0f, 1.0f);
  return c * c * (3.0f - 2.0f * c);
}

struct RippleSize {
  float threshold, shortest, longest, growth, steepness, celerity;

  explicit RippleSize(const MicroReliefParameters& p)
      : threshold(p.threshold_speed),
        shortest(p.shortest),
        longest(p.longest),
        growth(p.growth),
        steepness(p.ripples ? p.steepness : 0.0f),
        celerity(p.celerity) {}

  /// [m], of a wind of this speed [m/s].
  DESERT_HD float wavelength(float speed) const {
    return minimum(shortest + growth * maximum(speed - threshold, 0.0f), longest);
  }
  /// [m], from trough to crest.
  DESERT_HD float height(float speed) const {
    constexpr float onset = 1.0f;  // [m/s]
    return steepness * wavelength(speed) * smooth_step((speed - threshold) / onset);
  }
  /// Ripples that pass in a second [1/s].
  DESERT_HD float frequency(float speed) const {
    return celerity * maximum(speed - threshold, 0.0f) / wavelength(speed);
  }
};

}  // namespace micro_relief

/// The wind that shapes ripples. It follows from the winds since the start alone, and nothing that a step
/// computes depends on it.
struct RippleWind {
  double x = 0, y = 0;  ///< w̄ [m/s]
  double speed = 0;     ///< ū [m/s]
  double passed = 0;    ///< N, less whole ripples

  /// After this wind has blown for ever.
  static RippleWind settled(wind::Vector wind) {
    return {wind.x, wind.y, elementary::hypot(wind.x, wind.y), 0};
  }
  /// `wind` [m/s] blows for `time` [s]; exact for w̄ and ū, which decay exponentially.
  void advance(wind::Vector wind, double time, const MicroReliefParameters& p) {
    const micro_relief::RippleSize size(p);
    const double kept = elementary::exp(-time / double{p.response_time}), before = speed;
    const auto approach = [kept](double from, double to) { return to + (from - to) * kept; };
    x = approach(x, wind.x);
    y = approach(y, wind.y);
    speed = approach(speed, elementary::hypot(wind.x, wind.y));
    const double rate = 0.5 * (double{size.frequency(static_cast<float>(before))} +
                               size.frequency(static_cast<float>(speed)));
    passed += time * rate;
    passed -= std::floor(passed);
  }
};
constexpr auto parameter_table(const RippleWind*) {
  using P = RippleWind;
  return std::make_tuple(parameter("x", &P::x, -101, 101, "m/s", "Mean wind, eastward part."),
                         parameter("y", &P::y, -101, 101, "m/s", "Mean wind, northward part."),
                         parameter("speed", &P::speed, 0, 101, "m/s", "Mean speed of the wind."),
                         parameter("passed", &P::passed, 0, 1, "1", "Ripples that passed, less whole ones."));
}
static_assert(table_is_complete<RippleWind>());

}  // namespace desert_sim
