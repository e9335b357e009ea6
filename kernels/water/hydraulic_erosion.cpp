/// The laws and the step of hydraulic_erosion.hpp; compiled once for each backend.
#include "kernels/water/hydraulic_erosion.hpp"

#include "kernels/backend/buffer.hpp"
#include "kernels/backend/for_each.hpp"
#include "kernels/backend/loops.hpp"
#include "kernels/base/math.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "src/core/parameter_table.hpp"

namespace desert_sim::hydraulic_erosion {

/// Sediment capacity of each cell, computed before any ground changes.
struct Capacity {
  Grid grid;
  HydraulicErosionParameters p;
  float shallow_rise;  ///< (1 − a)/d [1/m]
  float quantum;
  const Quanta *bedrock, *soil, *sand, *water;
  const float *velocity_x, *velocity_y, *vegetation;
  float* capacity;

  DESERT_HD float surface(int x, int y) const {
    const int i = sample_index(grid, x, y);
    return static_cast<float>(bedrock[i] + value_or_zero(soil, i) + sand[i]);
  }
  DESERT_HD float sine(int x, int y) const {
    const float per = 0.5f * quantum / grid.cell_size;
    const float dx = (surface(x + 1, y) - surface(x - 1, y)) * per;
    const float dy = (surface(x, y + 1) - surface(x, y - 1)) * per;
    const float tangent2 = dx * dx + dy * dy;
    return sqrtf(tangent2 / (1.0f + tangent2));
  }
  DESERT_HD float capacity_at(int i, float slope, float speed) const {
    const float w = water[i] * quantum;
    if (!(w > wet_depth)) return 0.0f;
    return p.capacity * maximum(slope, p.least_slope) * speed *
           (1.0f - p.plant_hold * value_or_zero(vegetation, i)) *
           (minimum(p.shallow_share + shallow_rise * w, 1.0f) * exp_negative(w / p.deep));
  }

  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    capacity[i] = capacity_at(i, sine(x, y), hypotenuse(velocity_x[i], velocity_y[i]));
  }
};

/// Dissolves ground where the water carries less than its capacity, and deposits sediment where it carries
/// more.
struct Exchange {
  Grid grid;
  HydraulicErosionParameters p;
  float time_step, quantum, quanta_per_metre;
  Die dissolving_die, settling_die;
  const float *capacity, *vegetation, *resistance, *obstacle;
  const Quanta* water;
  Quanta *bedrock, *soil, *sand, *sediment;
  LedgerView ledger;

  /// The share rate · Δt of `metres`, at most `available` quanta.
  DESERT_HD Quanta exchanged(float rate, float metres, Quanta available, const Die& die, int i) const {
    return die.whole_at_most(minimum(rate * time_step, 1.0f) * metres * quanta_per_metre, available, i);
  }
  /// Dissolves from a layer of ground, at most `available` quanta of it.
  DESERT_HD Quanta dissolve(int i, Material from, Quanta* layer, Quanta available, float rate,
                            float metres) const {
    const Quanta worn = exchanged(rate, metres, available, dissolving_die, i);
    layer[i] -= worn;
    ledger.convert(from, Material::sediment, i, worn);
    return worn;
  }
  DESERT_HD Quanta deposit_sediment(int i, Quanta carried, float metres, bool dry) const {
    const float rate = p.deposit * (1.0f + p.plant_trap * value_or_zero(vegetation, i));
    const Quanta fallen = dry ? carried : exchanged(rate, metres, carried, settling_die, i);
    sand[i] += fallen;
    ledger.convert(Material::sediment, Material::sand, i, fallen);
    return fallen;
  }

  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    const Quanta carried = sediment[i];
    const float capacity_deficit = capacity[i] - carried * quantum;
    const bool dry = !(water[i] * quantum > wet_depth);
    if (capacity_deficit < 0.0f || dry) {
      sediment[i] = carried - deposit_sediment(i, carried, -capacity_deficit, dry);
    } else if (sand[i] > 0) {
      sediment[i] = carried + dissolve(i, Material::sand, sand, sand[i], p.sand, capacity_deficit);
    } else if (value_or_zero(obstacle, i) > 0.0f) {
      return;
    } else if (soil && soil[i] > 0) {
      sediment[i] = carried + dissolve(i, Material::soil, soil, soil[i], p.soil, capacity_deficit);
    } else {
      const Quanta room = bedrock[i] > -wall_height ? bedrock[i] + wall_height : 0;
      const float rate = p.rock * (1.0f - value_or_zero(resistance, i));
      sediment[i] = carried + dissolve(i, Material::bedrock, bedrock, room, rate, capacity_deficit);
    }
  }
};

template <class E>
void step(E& exec, const TerrainView& t, const HydraulicErosionParameters& p, float time_step,
          const Dice& dice, LedgerView ledger, Workspace& work) {
  Quanta *bedrock = t.quanta(Layer::bedrock), *soil = t.quanta(Layer::soil), *sand = t.quanta(Layer::sand);
  const Quanta* water = t.quanta(Layer::water);
  const float* vegetation = t.real(Layer::vegetation);
  for_each_cell(exec, t.grid,
                Capacity{t.grid, p, (1.0f - p.shallow_share) / p.shallow_depth, t.quantum, bedrock, soil,
                         sand, water, t.real(Layer::water_velocity_x), t.real(Layer::water_velocity_y),
                         vegetation, work.capacity.data()});
  for_each_cell(exec, t.grid,
                Exchange{t.grid, p, time_step, t.quantum, t.quanta_per_metre, dice[Roll::dissolving],
                         dice[Roll::settling], work.capacity.data(), vegetation,
                         t.real(Layer::erosion_resistance), t.real(Layer::obstacle), water, bedrock, soil,
                         sand, t.quanta(Layer::suspended_sediment), ledger});
}

template void step(Backend&, const TerrainView&, const HydraulicErosionParameters&, float, const Dice&,
                   LedgerView, Workspace&);

}  // namespace desert_sim::hydraulic_erosion
