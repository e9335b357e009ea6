#pragma once
/// Gusts: a wind whose speed and direction vary at random around what a wind regime says.

#include <cstdint>

#include "kernels/wind/vector.hpp"
#include "src/core/parameter_table.hpp"

namespace desert_sim {

struct GustParameters {
  double gust_speed = 0;
  double gust_direction_deg = 0;
  double gust_time = 10;
  std::uint64_t seed = 0;
};
constexpr auto parameter_table(const GustParameters*) {
  using P = GustParameters;
  return std::make_tuple(
      parameter("gust_speed", &P::gust_speed, 0, 1, "1",
                "Standard deviation of the speed, relative to that of the regime."),
      parameter("gust_direction_deg", &P::gust_direction_deg, 0, 180, "deg",
                "Standard deviation of the direction."),
      parameter("gust_time", &P::gust_time, 1e-3, 1e12, "s", "How long a gust lasts, in simulated time."),
      parameter("seed", &P::seed, 0, highest_uint64, "1", "Of the random draws."));
}
static_assert(table_is_complete<GustParameters>());

/// While the n-th gust lasts, the wind has the speed v (1 + s Z₁), between 0 and the highest speed that a
/// regime may have (or v, if that is higher), and the direction d + σ Z₂. v and d are those of the regime, s
/// and σ the deviations of the table, and Z₁ and Z₂ normal draws of (seed, member, n) alone. Without
/// deviations it is the regime's wind, to the bit.
struct Gusts : GustParameters {
  std::uint32_t member = 1;  ///< of the ensemble, from 1 on
  double start_time = 0;     ///< simulated time at which the first gust begins [s]

  /// The wind at simulated time `time` [s], where the regime has the wind `regime` [m/s].
  wind::Vector around(wind::Vector regime, double time) const;
};

}  // namespace desert_sim
