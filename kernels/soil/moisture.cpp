/// The laws and the step of moisture.hpp; compiled once for each backend.
#include "kernels/soil/moisture.hpp"

#include "kernels/backend/for_each.hpp"
#include "kernels/backend/loops.hpp"
#include "kernels/base/math.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "src/core/parameter_table.hpp"

namespace desert_sim::moisture {

/// Capacity and seepage rate of the ground.
struct Ground {
  const Quanta *soil, *sand;
  float capacity, deepest, per_deepest;  ///< c_M, d_M, 1/d_M
  float quantum, quanta_per_metre;
  MoistureParameters p;

  /// Moisture that the ground can hold, C [quanta].
  DESERT_HD Quanta capacity_quanta(int i) const {
    const float depth = static_cast<float>(value_or_zero(soil, i) + sand[i]) * quantum;
    return static_cast<Quanta>(capacity * minimum(depth, deepest) * quanta_per_metre);
  }
  DESERT_HD bool wet(Quanta moisture, Quanta full) const {
    return static_cast<float>(moisture) > p.wet_from * static_cast<float>(full);
  }
  DESERT_HD float rate(int i) const {
    return lerp(p.seepage_soil, p.seepage_sand, minimum(sand[i] * quantum * per_deepest, 1.0f));
  }
};

/// Moves water into the ground, or out of it above its capacity; then evaporates moisture where no water
/// stands.
struct SeepAndDry {
  Grid grid;
  Ground ground;
  float time_step;
  Die seepage_die, evaporation_die;
  const float* vegetation;
  Quanta *water, *moisture;
  LedgerView ledger;

  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    const Quanta capacity = ground.capacity_quanta(i), moisture_before = moisture[i], standing = water[i];
    const float rate = ground.rate(i);
    Quanta in = capacity - moisture_before;  // negative: the excess re-emerges
    if (in > 0) {
      const float part =
          rate * time_step * (ground.wet(moisture_before, capacity) ? ground.p.when_wet : 1.0f);
      const Quanta wanted = seepage_die.whole_at_most(part * static_cast<float>(in), in, i);
      in = wanted < standing ? wanted : standing;
      ledger.convert(Material::water, Material::moisture, i, in);
    } else {
      ledger.convert(Material::moisture, Material::water, i, -in);
    }
    const Quanta wet = moisture_before + in;
    water[i] = standing - in;
    Quanta dried = 0;
    if (!((standing - in) * ground.quantum > wet_depth)) {
      const float speed =
          ground.p.evaporation * rate * (1.0f - ground.p.plant_hold * value_or_zero(vegetation, i));
      dried = evaporation_die.whole_at_most(lost_share(speed * time_step) * static_cast<float>(wet), wet, i);
      ledger.book_out(Material::moisture, i, dried);
    }
    moisture[i] = wet - dried;
  }
};

/// Moisture that a cell gains from its four neighbours by diffusion.
struct DiffuseMoisture {
  Grid grid;
  Ground ground;
  float number;  ///< D Δt/l² ≤ ¼
  Die east_die, north_die;
  const Quanta* moisture;
  Quanta* gain;

  /// What cell i gains through a face to the cell at (x, y), negative if it loses. `ahead`: to the
  /// east or north; the die is that of the western or southern cell, so that both cells count the same.
  DESERT_HD Quanta gain_from(int i, Quanta capacity, float wet, int x, int y, const Die& die,
                             bool ahead) const {
    const int j = neighbour_index(grid, x, y);
    if (j < 0) return 0;
    const Quanta neighbour_capacity = ground.capacity_quanta(j);
    if (neighbour_capacity <= 0 || capacity <= 0) return 0;
    const float other = static_cast<float>(moisture[j]) / static_cast<float>(neighbour_capacity);
    const float amount = number *
                         static_cast<float>(capacity < neighbour_capacity ? capacity : neighbour_capacity) *
                         fabsf(other - wet);
    const bool gains = other > wet;
    // At most a quarter of what the donor has, so that its four faces never take more than there is.
    const Quanta moved = die.whole_at_most(amount, moisture[gains ? j : i] / 4, ahead ? i : j);
    return gains ? moved : -moved;
  }
  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    const Quanta capacity = ground.capacity_quanta(i);
    const float wet = capacity > 0 ? static_cast<float>(moisture[i]) / static_cast<float>(capacity) : 0.0f;
    gain[i] = gain_from(i, capacity, wet, x + 1, y, east_die, true) +
              gain_from(i, capacity, wet, x - 1, y, east_die, false) +
              gain_from(i, capacity, wet, x, y + 1, north_die, true) +
              gain_from(i, capacity, wet, x, y - 1, north_die, false);
  }
};

struct ApplyDiffusion {
  Grid grid;
  const Quanta* gain;
  Quanta* moisture;
  DESERT_HD void operator()(int x, int y) const { moisture[grid.index(x, y)] += gain[grid.index(x, y)]; }
};

template <class E>
void step(E& exec, const TerrainView& t, const MoistureParameters& p, const StepInputs& in, const Dice& dice,
          LedgerView ledger) {
  const Ground ground{t.quanta(Layer::soil),
                      t.quanta(Layer::sand),
                      in.repose.moisture_capacity,
                      in.repose.moisture_depth,
                      1.0f / in.repose.moisture_depth,
                      t.quantum,
                      t.quanta_per_metre,
                      p};
  Quanta *water = t.quanta(Layer::water), *moisture = t.quanta(Layer::moisture);
  for_each_cell(exec, t.grid,
                SeepAndDry{t.grid, ground, in.time_step, dice[Roll::seepage], dice[Roll::ground_evaporation],
                           t.real(Layer::vegetation), water, moisture, ledger});
  const float number = p.diffusion * in.time_step / (t.grid.cell_size * t.grid.cell_size);
  if (!(number > 0.0f)) return;
  const int parts = static_cast<int>(std::ceil(number * 4.0f));
  for (int n = 0; n < parts; ++n) {
    for_each_cell(exec, t.grid,
                  DiffuseMoisture{t.grid, ground, number / static_cast<float>(parts),
                                  dice[Roll::moisture_east].of_part(n), dice[Roll::moisture_north].of_part(n),
                                  moisture, in.gain});
    for_each_cell(exec, t.grid, ApplyDiffusion{t.grid, in.gain, moisture});
  }
}

template void step(Backend&, const TerrainView&, const MoistureParameters&, const StepInputs&, const Dice&,
                   LedgerView);

}  // namespace desert_sim::moisture
