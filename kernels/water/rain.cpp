/// The laws and the step of rain.hpp; compiled once for each backend.
#include "kernels/water/rain.hpp"

#include "kernels/backend/for_each.hpp"
#include "kernels/backend/loops.hpp"
#include "kernels/base/math.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/field/random.hpp"
#include "src/core/parameter_table.hpp"

namespace desert_sim::rain {

struct RainOnCell {
  Grid grid;
  RainParameters p;
  std::uint64_t seed;
  float phase;             ///< t · frequency
  float datum, quantum;    ///< [m]
  int repeat_x, repeat_y;  ///< period of the noise along a periodic axis [lattice cells]; 0: none
  Quanta amount;
  const Quanta *bedrock, *soil, *sand;
  Quanta* water;
  LedgerView ledger;

  DESERT_HD Quanta surface(int i) const { return bedrock[i] + value_or_zero(soil, i) + sand[i] + water[i]; }
  DESERT_HD float share(int i) const {
    return lerp(p.share_low, p.share_high, clamp((datum + surface(i) * quantum) / p.height, 0.0f, 1.0f));
  }
  /// Position in the lattice of the noise; a periodic axis is scaled to a whole number of lattice cells.
  DESERT_HD float lattice_position(int cell, int cells, int repeat) const {
    const float at = static_cast<float>(cell) + 0.5f;
    return repeat > 0 ? at * (static_cast<float>(repeat) / static_cast<float>(cells))
                      : at * grid.cell_size / p.scale;
  }

  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    const float part = share(i);
    if (!(part > 0.0f)) return;
    if (part < 1.0f) {
      const float noise = value_noise(seed, Purpose::rain, lattice_position(x, grid.width, repeat_x),
                                      lattice_position(y, grid.height, repeat_y), phase, repeat_x, repeat_y);
      const float odds = 4.0f * (noise < 0.0f ? -noise : noise), e = exp_negative(odds);
      const float uniform = noise < 0.0f ? e / (1.0f + e) : 1.0f / (1.0f + e);
      if (uniform > part) return;
    }
    const Quanta stays = with_room(amount, surface(i));
    water[i] += stays;
    ledger.book_in(Material::water, i, amount);
    ledger.book_out(Material::water, i, amount - stays);
  }
};

template <class E>
void step(E& exec, const TerrainView& t, const RainParameters& p, const StepInputs& in, LedgerView ledger) {
  const Quanta amount =
      quanta_of_step(static_cast<double>(p.rate) * in.time_step * t.quanta_per_metre, in.tick);
  if (amount <= 0) return;
  const auto repeat = [&](int cells, bool periodic) {
    const float showers = static_cast<float>(cells) * t.grid.cell_size / p.scale;
    return periodic ? (showers > 1.0f ? static_cast<int>(showers) : 1) : 0;
  };
  const double phase = in.time * p.frequency;
  // At a large phase a float could not resolve single steps, so the phase wraps; there the showers jump.
  constexpr double cycle = 65536.0;
  for_each_cell(exec, t.grid,
                RainOnCell{t.grid, p, in.seed, static_cast<float>(std::fmod(phase, cycle)),
                           static_cast<float>(in.datum), t.quantum, repeat(t.grid.width, t.grid.periodic_x),
                           repeat(t.grid.height, t.grid.periodic_y), amount, t.quanta(Layer::bedrock),
                           t.quanta(Layer::soil), t.quanta(Layer::sand), t.quanta(Layer::water), ledger});
}

template void step(Backend&, const TerrainView&, const RainParameters&, const StepInputs&, LedgerView);

}  // namespace desert_sim::rain
