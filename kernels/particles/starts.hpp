#pragma once
/// How grains of wang.hpp start, by dice: lift-off and splash.

#include "kernels/field/dice.hpp"
#include "kernels/field/draws.hpp"
#include "kernels/particles/flight.hpp"
#include "kernels/particles/particle_parameters.hpp"

namespace desert_sim::particles {

/// Sine and cosine of an angle within ±90° [half turns].
struct Direction {
  float sine, cosine;

  DESERT_HD explicit Direction(float half_turns)
      : sine(sine_of_half_turns(half_turns)), cosine(sine_of_half_turns(0.5f - fabsf(half_turns))) {}
};

/// The speeds of grains at the start.
struct Starts {
  float lift_lowest, lift_highest;    ///< B [1]
  float angle_lowest, angle_highest;  ///< of lift-off [half turns]
  float lift_spread, splash_spread;   ///< standard deviations [half turns]
  float splash_sine, splash_cosine;   ///< of the angle of splash
  float splash_speed;                 ///< α √(g d)/a_s [m/s]
  float per_impact_speed;             ///< 1/(n_s √(g d)) [s/m]

  /// Sets the velocity of a grain with given parts upward and along the wind.
  DESERT_HD void aim(const Air& air, float up, float forward, float spread, RandomSequence& words,
                     Grain& g) const {
    const std::uint32_t radius = words.next();
    const Direction aside(clamp(spread * normal_draw(radius, words.next()), -0.5f, 0.5f));
    g.velocity_x = forward * (aside.cosine * air.along_x - aside.sine * air.along_y);
    g.velocity_y = forward * (aside.cosine * air.along_y + aside.sine * air.along_x);
    g.velocity_z = up;
  }
  DESERT_HD void lift_off(const Air& air, float shear_velocity, RandomSequence& words, Grain& g) const {
    const float up = lerp(lift_lowest, lift_highest, words.unit()) * shear_velocity;
    const Direction angle(lerp(angle_lowest, angle_highest, words.unit()));
    aim(air, up, up * angle.cosine / angle.sine, lift_spread, words, g);
  }
  DESERT_HD void splash(const Air& air, float impact_speed, RandomSequence& words, Grain& g) const {
    const float mean = splash_speed * lost_share(impact_speed * per_impact_speed);
    const float speed = minimum(mean * exponential_draw(words.next()), impact_speed);
    aim(air, speed * splash_sine, speed * splash_cosine, splash_spread, words, g);
  }
};

Starts make_starts(const ParticleParameters& p);

}  // namespace desert_sim::particles
