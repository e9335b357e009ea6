/// The laws and the step of soil.hpp; compiled once for each backend.
#include "kernels/soil/soil.hpp"

#include "kernels/backend/for_each.hpp"
#include "kernels/backend/loops.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/sand/repose.hpp"
#include "src/core/parameter_table.hpp"

namespace desert_sim::soil {

struct ConvertSoilAndSand {
  Grid grid;
  SoilParameters p;
  float time_step, quantum, quanta_per_metre;
  float per_cover;  ///< 1/s_c [1/m]
  Die drying_die, forming_die;
  repose::RelativeMoisture relative_moisture;
  const float* vegetation;
  Quanta *soil, *sand, *humus;
  LedgerView ledger;

  DESERT_HD void lose_humus(int i, Quanta amount) const {
    if (humus) humus[i] -= amount < humus[i] ? amount : humus[i];
  }
  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    const float m = relative_moisture(i), v = value_or_zero(vegetation, i), s = sand[i] * quantum;
    const float drying_factor = maximum(1.0f - m / p.dry, 0.0f) * exp_negative(per_cover * maximum(s, 0.0f));
    const Quanta dried = drying_die.whole_at_most(
        p.drying * time_step * (1.0f - v) * drying_factor * quanta_per_metre, soil[i], i);
    const Quanta fertile = humus ? (humus[i] < sand[i] ? humus[i] : sand[i]) : 0;
    const Quanta formed =
        forming_die.whole_at_most(p.forming * time_step * v * m * quanta_per_metre, fertile, i);
    soil[i] += formed - dried;
    sand[i] += dried - formed;
    lose_humus(i, dried + formed);
    ledger.convert(Material::soil, Material::sand, i, dried);
    ledger.convert(Material::sand, Material::soil, i, formed);
  }
};

template <class E>
void step(E& exec, const TerrainView& t, const SoilParameters& p, const ReposeParameters& repose,
          float time_step, const Dice& dice, LedgerView ledger) {
  for_each_cell(
      exec, t.grid,
      ConvertSoilAndSand{t.grid, p, time_step, t.quantum, t.quanta_per_metre, 1.0f / p.cover,
                         dice[Roll::soil_drying], dice[Roll::soil_forming],
                         repose::RelativeMoisture(t, repose), t.real(Layer::vegetation),
                         t.quanta(Layer::soil), t.quanta(Layer::sand), t.quanta(Layer::humus), ledger});
}

template void step(Backend&, const TerrainView&, const SoilParameters&, const ReposeParameters&, float,
                   const Dice&, LedgerView);

}  // namespace desert_sim::soil
