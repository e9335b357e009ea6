#pragma once
/// Rain: showers that drift and change, of the same strength wherever it rains. Nilles 2025 eq. 31;
/// physics.md C1.
///
///   w += Δt φ  where  u(n(x / scale, t · frequency)) ≤ p,   p = lerp(p_low, p_high, clamp(W / h, 0, 1))
///
/// n is smooth value noise, u(n) = 1/(1 + e^(−4n)) makes it uniform in 0…1 within 0.02, so that p is the
/// share of the ground on which it rains; W = elevation + water. What falls in a step is whole quanta, of
/// which so many fall in n steps as the rate says, however little it is a step.
///
/// Reads bedrock, soil, sand, water; writes water.

#include "kernels/backend/for_each.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/field/math.hpp"
#include "kernels/field/random.hpp"
#include "src/core/parameters.hpp"

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

/// Whole quanta of step n of something that comes at `quanta` a step.
inline Quanta of_step(double quanta, std::uint64_t n) {
  const double before = static_cast<double>(n);
  return static_cast<Quanta>(std::floor(quanta * (before + 1.0)) - std::floor(quanta * before));
}

struct Fall {
  Grid grid;
  RainParameters p;
  std::uint64_t seed;
  float phase;             ///< t · frequency
  float datum, quantum;    ///< [m]
  int repeat_x, repeat_y;  ///< showers after which a periodic axis has them again; 0: never
  Quanta amount;
  const Quanta *bedrock, *soil, *sand;
  Quanta* water;
  LedgerView ledger;

  DESERT_HD float share(int i) const {
    const Quanta surface = bedrock[i] + value_or_zero(soil, i) + sand[i] + water[i];
    return lerp(p.share_low, p.share_high, clamp((datum + surface * quantum) / p.height, 0.0f, 1.0f));
  }
  /// Position in showers; of a repeating axis so that a whole number of them fits.
  DESERT_HD float place(int cell, int cells, int repeat) const {
    const float at = static_cast<float>(cell) + 0.5f;
    return repeat > 0 ? at * (static_cast<float>(repeat) / static_cast<float>(cells))
                      : at * grid.cell_size / p.scale;
  }

  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    const float part = share(i);
    if (!(part > 0.0f)) return;
    if (part < 1.0f) {
      const float noise = value_noise(seed, Purpose::rain, place(x, grid.width, repeat_x),
                                      place(y, grid.height, repeat_y), phase, repeat_x, repeat_y);
      const float odds = 4.0f * (noise < 0.0f ? -noise : noise), e = exp_negative(odds);
      const float uniform = noise < 0.0f ? e / (1.0f + e) : 1.0f / (1.0f + e);
      if (uniform > part) return;
    }
    water[i] += amount;
    ledger.book_in(Material::water, i, amount);
  }
};

/// `tick`: steps done; `datum`: elevation of quantum 0 [m].
template <class E>
void step(E& exec, const TerrainView& t, const RainParameters& p, float time_step, std::uint64_t seed,
          std::uint64_t tick, double datum, LedgerView ledger) {
  const Quanta amount = of_step(static_cast<double>(p.rate) * time_step * t.quanta_per_metre, tick);
  if (amount <= 0) return;
  const auto repeat = [&](int cells, bool periodic) {
    const float showers = static_cast<float>(cells) * t.grid.cell_size / p.scale;
    return periodic ? (showers > 1.0f ? static_cast<int>(showers) : 1) : 0;
  };
  const double phase = static_cast<double>(tick) * time_step * p.frequency;
  // Far out a float no longer tells one step from the next; the noise has no memory that this would break.
  constexpr double cycle = 65536.0;
  for_each_cell(exec, t.grid,
                Fall{t.grid, p, seed, static_cast<float>(std::fmod(phase, cycle)), static_cast<float>(datum),
                     t.quantum, repeat(t.grid.width, t.grid.periodic_x),
                     repeat(t.grid.height, t.grid.periodic_y), amount, t.quanta(Layer::bedrock),
                     t.quanta(Layer::soil), t.quanta(Layer::sand), t.quanta(Layer::water), ledger});
}

}  // namespace rain
}  // namespace desert_sim
