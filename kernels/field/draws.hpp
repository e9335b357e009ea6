#pragma once
/// Draws from distributions, made of random words (random.hpp). They use only arithmetic that IEEE 754 rounds
/// alike everywhere (math.hpp), so that the CPU and the GPU draw the same bits.

#include <cstdint>

#include "kernels/base/macros.hpp"
#include "kernels/base/math.hpp"

namespace desert_sim {

/// Uniform in (0, 1], 24 bits.
DESERT_HD float positive_unit(std::uint32_t word) {
  return static_cast<float>((word >> 8) + 1) * (1.0f / 16777216.0f);
}

/// −ln x for a normal number 0 < x ≤ 1, with an absolute error below 2e-6 (the rounding of n ln 2 + ln m):
///
///   x = 2ⁿ m,  √½ ≤ m < √2,  ln m = 2 artanh((m − 1)/(m + 1))
DESERT_HD float negative_log(float x) {
  const std::uint32_t bits = bits_of(x);
  constexpr std::uint32_t mantissa = 0x7fffff, root_two = 0x3504f3;  // the bits of √2 behind its leading one
  const bool above = (bits & mantissa) > root_two;
  const int exponent = static_cast<int>(bits >> 23) - 127 + (above ? 1 : 0);
  const float m = float_from_bits((bits & mantissa) | (above ? 126u : 127u) << 23);
  const float s = (m - 1.0f) / (m + 1.0f), q = s * s;
  const float series = 1.0f + q * (1.0f / 3.0f + q * (0.2f + q * (1.0f / 7.0f + q * (1.0f / 9.0f))));
  return static_cast<float>(-exponent) * 0.69314718f - 2.0f * s * series;
}

/// From the exponential distribution of mean 1; at most 16.7.
DESERT_HD float exponential_draw(std::uint32_t word) { return negative_log(positive_unit(word)); }

/// From the normal distribution of mean 0 and variance 1 (Box and Muller 1958); at most 5.8 away from 0.
DESERT_HD float normal_draw(std::uint32_t radius, std::uint32_t angle) {
  const float turns = fabsf(positive_unit(angle) - 0.5f);  // cos 2π x = sin π(½ − 2|x|)
  return sqrtf(2.0f * exponential_draw(radius)) * sine_of_half_turns(0.5f - 2.0f * turns);
}

}  // namespace desert_sim
