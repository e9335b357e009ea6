#pragma once
/// Counter-based random numbers: a number depends on (seed, purpose, counters) only, never on order or
/// threads.

#include <Random123/philox.h>

#include <cmath>
#include <cstdint>

#include "kernels/base/macros.hpp"

namespace desert_sim {

enum class Purpose : std::uint32_t {
  reptation = 1,
  terrain_noise,
  terrain_discs,
  wind_rose,
  turbulence,
  rain,
  rounding,
  rover_odometry,
  rover_imu,
  ripples,
  sand_bumps,
  plants = 32,
  planting,
  range_noise = 64,
  beam_path,
};

/// Four random words from three counters.
struct RandomWords {
  std::uint32_t word[4];
};
DESERT_HD RandomWords random_words(std::uint64_t seed, Purpose purpose, std::uint32_t a, std::uint32_t b,
                                   std::uint32_t c) {
  const r123::Philox4x32::ctr_type counter{{a, b, c, static_cast<std::uint32_t>(purpose)}};
  const r123::Philox4x32::key_type key{
      {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}};
  const r123::Philox4x32::ctr_type words = r123::Philox4x32()(counter, key);
  return {{words[0], words[1], words[2], words[3]}};
}

/// Uniform in [0, 1), 24 bits of a word.
DESERT_HD float unit_from(std::uint32_t word) { return static_cast<float>(word >> 8) * (1.0f / 16777216.0f); }

/// The same from up to three counters.
DESERT_HD float random_unit(std::uint64_t seed, Purpose purpose, std::uint32_t a, std::uint32_t b = 0,
                            std::uint32_t c = 0) {
  return unit_from(random_words(seed, purpose, a, b, c).word[0]);
}

/// The lattice point below a coordinate; far out, the outermost one that an integer can count.
DESERT_HD int lattice_floor(float coordinate) {
  return static_cast<int>(fminf(fmaxf(floorf(coordinate), -2147483648.0f), 2147483520.0f));
}

/// Smooth value noise in [−1, 1]: random values on the integer lattice, interpolated with continuous second
/// derivatives. The third coordinate is z0 + share, with 0 ≤ share ≤ 1. With `period_x` or `period_y` > 0 the
/// noise repeats after so many lattice cells.
DESERT_HD float value_noise(std::uint64_t seed, Purpose purpose, float x, float y, std::uint32_t z0,
                            float share, int period_x, int period_y) {
  const int x0 = lattice_floor(x), y0 = lattice_floor(y);
  const auto fade = [](float t) { return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f); };
  const float fx = fade(x - floorf(x)), fy = fade(y - floorf(y)), fz = fade(share);
  const auto cycled = [](int i, int period) { return period > 0 ? ((i % period) + period) % period : i; };
  float sum = 0.0f;
  for (int n = 0; n < 8; ++n) {
    const int dx = n & 1, dy = (n >> 1) & 1, dz = n >> 2;
    const float weight = (dx ? fx : 1.0f - fx) * (dy ? fy : 1.0f - fy) * (dz ? fz : 1.0f - fz);
    const float value = random_unit(seed, purpose, static_cast<std::uint32_t>(cycled(x0 + dx, period_x)),
                                    static_cast<std::uint32_t>(cycled(y0 + dy, period_y)),
                                    z0 + static_cast<std::uint32_t>(dz));
    sum += weight * (2.0f * value - 1.0f);
  }
  return sum;
}
DESERT_HD float value_noise(std::uint64_t seed, Purpose purpose, float x, float y, float z, int period_x = 0,
                            int period_y = 0) {
  return value_noise(seed, purpose, x, y, static_cast<std::uint32_t>(lattice_floor(z)), z - floorf(z),
                     period_x, period_y);
}

}  // namespace desert_sim
