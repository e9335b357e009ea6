#pragma once
/// Rain: showers that come and go, with the same intensity wherever it rains. Nilles 2025 §3.4.3, eq. 31.
///
///   w += Δt φ   where u(n(x/`scale`, t·`frequency`)) ≤ p
///   p    = lerp(p_low, p_high, clamp(W/`height`, 0, 1)),   W = elevation + water
///   u(n) = 1/(1 + e^(−4 n))
///
/// φ is `rate` and n smooth value noise. u makes the noise uniform in 0 … 1 to within 0.02, so that p is the
/// share of the ground on which it rains. A step adds whole quanta, whose sum over the steps follows the
/// rate, however little falls in one step. The ledger records them as inflow.
///
/// Reads bedrock, soil, sand, water; writes water.

#include <cmath>
#include <cstdint>

#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "src/core/parameter_table.hpp"

namespace desert_sim {

struct RainParameters {
  float rate = 0.0f;
  float share_low = 1.0f;
  float share_high = 1.0f;
  float height = 100.0f;
  float scale = 200.0f;
  float frequency = 0.01f;
};

constexpr auto parameter_table(const RainParameters*) {
  using P = RainParameters;
  return std::make_tuple(
      parameter("rate", &P::rate, 0, 1, "m/s",
                "Depth that falls a second where it rains; 2.8e-6 is 10 mm an hour; 0 is off."),
      parameter("share_low", &P::share_low, 0, 1, "1",
                "Share of the ground on which it rains, at elevation 0."),
      parameter("share_high", &P::share_high, 0, 1, "1", "Likewise at the elevation `height` and above."),
      parameter("height", &P::height, 0.001, 1e4, "m", "Elevation of share_high."),
      parameter("scale", &P::scale, 0.01, 1e6, "m", "Size of showers."),
      parameter("frequency", &P::frequency, 0, 10, "1/s", "How fast showers come and go; 0: they stay."));
}
static_assert(table_is_complete<RainParameters>());

namespace rain {

/// Whole quanta of step n of a source of `quanta` a step; sums over steps are rounded down only once. Not
/// more than a wall is high: a torrent that would fill it in a step does not fit into the layer.
inline Quanta quanta_of_step(double quanta, std::uint64_t n) {
  const double before = static_cast<double>(n),
               amount = std::floor(quanta * (before + 1.0)) - std::floor(quanta * before);
  return static_cast<Quanta>(std::min(amount, double{wall_height}));
}

struct StepInputs {
  float time_step;           ///< [s]
  double time;               ///< simulated [s]
  std::uint64_t seed, tick;  ///< tick: steps done
  double datum;              ///< elevation of quantum 0 [m]
};

template <class E>
void step(E& exec, const TerrainView& t, const RainParameters& p, const StepInputs& in, LedgerView ledger);

}  // namespace rain
}  // namespace desert_sim
