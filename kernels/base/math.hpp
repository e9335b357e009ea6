#pragma once
/// Arithmetic that gives the same bits on host and device: it uses only +, −, ×, ÷, fused multiply-add and
/// square roots, which IEEE 754 rounds alike everywhere, because library transcendental functions differ by
/// units in the last place.

#include <cmath>
#include <cstdint>
#include <cstring>

#include "kernels/base/macros.hpp"

namespace desert_sim {

DESERT_HD float minimum(float a, float b) { return a < b ? a : b; }
DESERT_HD float maximum(float a, float b) { return a > b ? a : b; }
/// Minimum and maximum of two numbers that are neither NaN nor zeros of different sign. On a GPU each is one
/// instruction, which minimum() and maximum() are not.
DESERT_HD float fast_min(float a, float b) {
#if defined(__CUDA_ARCH__)
  return fminf(a, b);
#else
  return minimum(a, b);
#endif
}
DESERT_HD float fast_max(float a, float b) {
#if defined(__CUDA_ARCH__)
  return fmaxf(a, b);
#else
  return maximum(a, b);
#endif
}
DESERT_HD float clamp(float v, float low, float high) { return minimum(maximum(v, low), high); }
/// a·b + c, rounded once. Where the processor has no such instruction, the library computes it slowly.
DESERT_HD float fused(float a, float b, float c) { return fmaf(a, b, c); }
DESERT_HD float lerp(float a, float b, float t) { return fused(t, b - a, a); }
DESERT_HD std::uint32_t bits_of(float v) {
  std::uint32_t bits;
  memcpy(&bits, &v, sizeof bits);
  return bits;
}
DESERT_HD float float_from_bits(std::uint32_t bits) {
  float v;
  memcpy(&v, &bits, sizeof v);
  return v;
}
/// Loads a value that no thread changes while the kernel runs (through the read-only cache on a GPU).
DESERT_HD float load_read_only(const float* place) {
#if defined(__CUDA_ARCH__)
  return __ldg(place);
#else
  return *place;
#endif
}
/// max(v, 0) for v ≤ 1; for larger v the result is at least 1. A CPU takes the maximum of the bits as
/// integers (a negative float's bits are a negative integer), which compilers recognise as a maximum, while
/// for floats they emit comparisons and masks.
DESERT_HD float positive_part(float v) {
#if defined(__CUDA_ARCH__)
  return __saturatef(v);  // free: a modifier of the subtraction before it
#else
  const std::int32_t bits = static_cast<std::int32_t>(bits_of(v));
  return float_from_bits(static_cast<std::uint32_t>(bits > 0 ? bits : 0));
#endif
}
/// Rounds to the nearest integer, halves away from zero; |v| ≤ 2³⁰.
DESERT_HD int round_to_int(float v) {
  const int whole = static_cast<int>(v);
  const float rest = v - static_cast<float>(whole);
  return whole + (rest >= 0.5f ? 1 : 0) - (rest <= -0.5f ? 1 : 0);
}
DESERT_HD float hypotenuse(float x, float y) { return sqrtf(x * x + y * y); }

/// e^(−x) for x ≥ 0, with a relative error below 3e-7; 0 from x = 87 on.
///
///   e^(−x) = 2^(−n) e^r,  n = round(x / ln 2),  r = n ln 2 − x,  |r| ≤ ½ ln 2
///
/// with ln 2 in two parts, and e^r by its Taylor polynomial of degree 7.
DESERT_HD float exp_negative(float x) {
  constexpr float end = 87.0f;
  // Added to the number of halvings, 1.5 · 2²³ leaves no room for a fraction: rounding and conversion, which
  // take a GPU four times as long as an addition, become one.
  constexpr float to_whole = 12582912.0f;
  const float y = fast_min(x, end), whole = y * 1.44269504f + to_whole, n = whole - to_whole;
  const float r = fused(n, -2.12194440e-4f, fused(n, 0.693359375f, -y));  // r = n ln2 − y
  float p = 1.0f / 5040.0f;
  p = fused(p, r, 1.0f / 720.0f);
  p = fused(p, r, 1.0f / 120.0f);
  p = fused(p, r, 1.0f / 24.0f);
  p = fused(p, r, 1.0f / 6.0f);
  p = fused(p, r, 0.5f);
  p = fused(p, r, 1.0f);
  p = fused(p, r, 1.0f);
  p = p * float_from_bits((127u + bits_of(to_whole) - bits_of(whole)) << 23);
  return x >= end ? 0.0f : p;
}

/// 1 − e^(−x) for x ≥ 0, also where x is so small that e^(−x) rounds to 1.
DESERT_HD float lost_share(float x) {
  return x < 0.01f ? x * (1.0f - x * (0.5f - x * (1.0f / 6.0f))) : 1.0f - exp_negative(x);
}

/// ln(x) for normal x > 0, with an error below 2e-7 (absolute near 1, else relative):
///
///   ln(2^e m) = e ln 2 + 2 artanh((m − 1)/(m + 1)),   √½ ≤ m < √2
DESERT_HD float logarithm(float x) {
  const std::uint32_t bits = bits_of(x) - 0x3f3504f3u;  // √½
  const float exponent = static_cast<float>(static_cast<std::int32_t>(bits) >> 23);
  const float m = float_from_bits((bits & 0x007fffffu) + 0x3f3504f3u);
  const float t = (m - 1.0f) / (m + 1.0f), q = t * t;
  float p = fused(q, 1.0f / 9.0f, 1.0f / 7.0f);
  p = fused(p, q, 0.2f);
  p = fused(p, q, 1.0f / 3.0f);
  return fused(exponent, 0.693359375f, 2.0f * fused(t * q, p, t)) - exponent * 2.12194440e-4f;
}

/// x^y for x ≥ 0 and a result from e^(−87) to e^(87), with a relative error below 1e-6 · (1 + |y ln x|).
DESERT_HD float power(float x, float y) {
  const float exponent = y * logarithm(x), small = exp_negative(fabsf(exponent));
  const float result = exponent <= 0.0f ? small : 1.0f / small;
  return x > 1e-37f ? result : 0.0f;
}

/// sin(π x) for |x| ≤ ½, with an error below 2e-7: its Taylor polynomial of degree 11.
DESERT_HD float sine_of_half_turns(float x) {
  const float a = 3.14159265f * x, q = a * a;
  float p = fused(q, -1.0f / 39916800.0f, 1.0f / 362880.0f);
  p = fused(p, q, -1.0f / 5040.0f);
  p = fused(p, q, 1.0f / 120.0f);
  p = fused(p, q, -1.0f / 6.0f);
  return fused(a * q, p, a);
}

/// arctan(x) for 0 ≤ x < 1e18, with a relative error below 1e-6. The angle is halved three times,
///
///   arctan x = 2 arctan(x / (1 + √(1 + x²)))
///
/// which leaves at most 0.2 as the argument of the Taylor series.
DESERT_HD float arctangent(float x) {
  for (int halving = 0; halving < 3; ++halving) x = x / (1.0f + sqrtf(1.0f + x * x));
  const float q = x * x;
  return 8.0f * (x * (1.0f + q * (-1.0f / 3.0f + q * (0.2f + q * (-1.0f / 7.0f + q * (1.0f / 9.0f))))));
}

}  // namespace desert_sim
