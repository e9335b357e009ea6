#pragma once
/// Material is counted in integers, so that it is conserved exactly. Layers of moving material hold 32-bit
/// integers of `quantum` metres each (a power of two, 2⁻²⁰ m unless the relief needs a coarser one). A law
/// computes an amount in float, rounds it once, and takes exactly that from one place and gives it to
/// another.

#include <cmath>
#include <cstdint>
#include <cstring>

#include "kernels/base/macros.hpp"

namespace desert_sim {

using Quanta = std::int32_t;

/// Height of an infinitely high wall. Heights stay below 2³⁰ quanta, so that the difference of any two fits.
constexpr Quanta wall_height = Quanta{1} << 30;
/// Terrain is loaded and edited within ±2²⁹ quanta of the datum, so that moving sand has room to pile up.
constexpr Quanta load_limit = Quanta{1} << 29;

/// Sources fill a cell, and flowing water its neighbours, up to here; the rest of the way to a wall is room
/// for what slides and hops in a step.
constexpr Quanta fill_limit = wall_height / 4 * 3;
/// The part of `amount` for which there is room on a surface.
DESERT_HD Quanta with_room(Quanta amount, Quanta surface) {
  const Quanta room = fill_limit - surface;
  return amount <= room ? amount : (room > 0 ? room : 0);
}
/// The most that moves into a cell over an open edge at once.
constexpr Quanta most_influx = Quanta{1} << 26;

/// Sums modulo 2³², for parts of an amount that are too large by themselves.
DESERT_HD Quanta sum_modulo(Quanta a, Quanta b) {
  return static_cast<Quanta>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}
DESERT_HD Quanta difference_modulo(Quanta a, Quanta b) {
  return static_cast<Quanta>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}

/// `metres` in quanta, rounded to nearest, not less than 0 and not more than `available`.
DESERT_HD Quanta to_quanta_at_most(float metres, float quanta_per_metre, Quanta available) {
  const float wanted = rintf(metres * quanta_per_metre);
  if (!(wanted > 0.0f)) return 0;
  if (wanted >= static_cast<float>(available)) return available;
  return static_cast<Quanta>(wanted);
}

/// Longest displacement [cells]; Simulation refuses scenarios with longer hops or marches.
constexpr int max_displacement = 16384;
/// A displacement [cells] as a 16.16 fixed-point number. Rounding is symmetric, so that mirrored winds give
/// mirrored displacements. Longer ones than `max_displacement`, which wind features can cause, are clamped to
/// it.
DESERT_HD int to_fixed_point(float cells) {
  const float longest = max_displacement;
  const float held = cells > longest ? longest : (cells < -longest ? -longest : cells);
  return static_cast<int>(rintf(held * 65536.0f));
}
constexpr int fixed_point_one = 65536;
/// 1 + the fraction of a cell in a displacement: exact, and without the slow conversion from an integer.
DESERT_HD float one_plus_fraction(int subcell) {
  const std::uint32_t bits = 0x3f800000u + static_cast<std::uint32_t>(subcell & 65535) * 128;
  float one_and;
  memcpy(&one_and, &bits, sizeof one_and);
  return one_and;
}
/// The fraction of a cell in a displacement, 0 ≤ fraction < 1.
DESERT_HD float fraction(int subcell) { return one_plus_fraction(subcell) - 1.0f; }
/// A displacement rounded to whole cells, halves away from zero, so that mirrored marches are mirrored.
DESERT_HD int nearest_cell(int subcell) { return (subcell + 32768 - (subcell < 0 ? 1 : 0)) >> 16; }

/// a·b / 2³², rounded down.
DESERT_HD std::uint32_t multiply_high(std::uint32_t a, std::uint32_t b) {
#if defined(__CUDA_ARCH__)
  return __umulhi(a, b);
#else
  return static_cast<std::uint32_t>((static_cast<std::uint64_t>(a) * b) >> 32);
#endif
}

/// Number of the lowest bit that is set, of a word that is not 0.
DESERT_HD int lowest_bit(std::uint32_t word) {
#if defined(__CUDA_ARCH__)
  return __ffs(static_cast<int>(word)) - 1;
#else
  return __builtin_ctz(word);
#endif
}

/// The share wx·wy (each 0 … 2¹⁶ for 0 … 1) of an amount that is not negative, rounded down, so that the four
/// shares of a bilinear split never exceed the amount.
DESERT_HD Quanta bilinear_share(Quanta amount, int wx, int wy) {
  const std::uint32_t share =
      static_cast<std::uint32_t>(wx) * static_cast<std::uint32_t>(wy);  // in 2⁻³²; 1 overflows to 0
  if (wx == fixed_point_one && wy == fixed_point_one) return amount;
  return static_cast<Quanta>(multiply_high(static_cast<std::uint32_t>(amount), share));
}

}  // namespace desert_sim
