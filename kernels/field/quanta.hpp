#pragma once
/// Material is counted. Layers of moving material hold 32-bit integers, `quantum` metres each (a power of
/// two, 2⁻²⁰ m unless the relief needs a coarser one). A law computes an amount in float, rounds it once, and
/// takes exactly that from one place and gives it to another.

#include <cmath>
#include <cstdint>
#include <cstring>

#include "kernels/backend/macros.hpp"

namespace desert_sim {

using Quanta = std::int32_t;

/// Heights stay below 2³⁰ quanta, so that the difference of any two fits; this stands for an infinitely high
/// wall.
constexpr Quanta wall_height = Quanta{1} << 30;
/// Terrain is loaded and edited within ±2²⁹ quanta of the datum: moving sand then has room to pile up.
constexpr Quanta load_limit = Quanta{1} << 29;

/// `metres` expressed in quanta, rounded to nearest, and not more than `available`.
DESERT_HD Quanta take(float metres, float quanta_per_metre, Quanta available) {
  const float wanted = rintf(metres * quanta_per_metre);
  if (!(wanted > 0.0f)) return 0;
  if (wanted >= static_cast<float>(available)) return available;
  return static_cast<Quanta>(wanted);
}

/// What a displacement may be [cells]; Simulation refuses scenarios whose hops or marches are longer.
constexpr int longest_reach = 16384;
/// A displacement in cells as a 16.16 fixed-point number. Rounding is symmetric, so that mirrored winds
/// mirror.
/// Winds that features make faster than `longest_reach` allows carry that far.
DESERT_HD int subcells(float cells) {
  const float longest = longest_reach;
  const float held = cells > longest ? longest : (cells < -longest ? -longest : cells);
  return static_cast<int>(rintf(held * 65536.0f));
}
constexpr int subcell_one = 65536;
/// 1 and what a displacement goes beyond whole cells: exact, without the slow conversion from an integer.
DESERT_HD float one_and_fraction(int subcell) {
  const std::uint32_t bits = 0x3f800000u + static_cast<std::uint32_t>(subcell & 65535) * 128;
  float one_and;
  memcpy(&one_and, &bits, sizeof one_and);
  return one_and;
}
/// What a displacement goes beyond whole cells, 0 … 1.
DESERT_HD float fraction(int subcell) { return one_and_fraction(subcell) - 1.0f; }
/// The nearest whole cell to a displacement; halves go away from zero, so that mirrored marches mirror.
DESERT_HD int nearest_cell(int subcell) { return (subcell + 32768 - (subcell < 0 ? 1 : 0)) >> 16; }

/// a·b / 2³², rounded down.
DESERT_HD std::uint32_t high_product(std::uint32_t a, std::uint32_t b) {
#if defined(__CUDA_ARCH__)
  return __umulhi(a, b);
#else
  return static_cast<std::uint32_t>((static_cast<std::uint64_t>(a) * b) >> 32);
#endif
}

/// The share wx·wy (each 0…2¹⁶) of an amount that is not negative, rounded down: the four shares of a
/// bilinear split never exceed it.
DESERT_HD Quanta bilinear_share(Quanta amount, int wx, int wy) {
  const std::uint32_t share =
      static_cast<std::uint32_t>(wx) * static_cast<std::uint32_t>(wy);  // of 2³²: that is 0 here
  if (wx == subcell_one && wy == subcell_one) return amount;
  return static_cast<Quanta>(high_product(static_cast<std::uint32_t>(amount), share));
}

}  // namespace desert_sim
