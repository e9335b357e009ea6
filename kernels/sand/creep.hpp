#pragma once
/// Creep of sand to the two steepest of the eight neighbours (Paris 2019 §5.1). An event moves
///
///   q = min(ε_R, half the steepest drop, s)    drop: fall of the surface over the distance d = 1 or √2
///
/// divided among the two in proportion to their drops. At most half the steepest drop moves, so that an event
/// does not overshoot; sand neither leaves obstacles nor goes there.

#include "kernels/backend/atomics.hpp"
#include "kernels/field/dice.hpp"
#include "kernels/field/layers.hpp"

namespace desert_sim::reptation {

struct CreepToSteepest {
  Grid grid;
  const Quanta *bedrock, *soil, *sand;
  const float* obstacle;
  Die amount, second_amount;
  Quanta* change;  ///< of the sand of each cell; the law adds to it

  DESERT_HD Quanta height(int i) const { return bedrock[i] + value_or_zero(soil, i) + sand[i]; }

  /// `wanted`: ε_R of all events of the cell [quanta].
  DESERT_HD void operator()(int x, int y, float wanted) const {
    const int i = grid.index(x, y);
    int first = -1, second = -1;
    float first_slope = 0.0f, second_slope = 0.0f;
    for (int k = 0; k < Neighbours::count; ++k) {
      const int j = neighbour_index(grid, x + Neighbours::dx(k), y + Neighbours::dy(k));
      if (j < 0 || value_or_zero(obstacle, j) > 0.0f) continue;
      const float slope = static_cast<float>(height(i) - height(j)) / Neighbours::distance(k);
      if (slope > first_slope) {
        second = first;
        second_slope = first_slope;
        first = j;
        first_slope = slope;
      } else if (slope > second_slope) {
        second = j;
        second_slope = slope;
      }
    }
    if (first < 0) return;
    const Quanta moved = amount.whole_at_most(minimum(wanted, 0.5f * first_slope), sand[i], i);
    const float second_part = second < 0 ? 0.0f : second_slope / (first_slope + second_slope);
    const Quanta to_second = second_amount.whole_at_most(static_cast<float>(moved) * second_part, moved, i);
    atomic_add(&change[i], -moved);
    atomic_add(&change[first], moved - to_second);
    if (second >= 0) atomic_add(&change[second], to_second);
  }
};

inline CreepToSteepest creep_to_steepest(const TerrainView& t, const Dice& dice, Quanta* change) {
  return {t.grid,
          t.quanta(Layer::bedrock),
          t.quanta(Layer::soil),
          t.quanta(Layer::sand),
          t.real(Layer::obstacle),
          dice[Roll::reptation],
          dice[Roll::reptation_second],
          change};
}

struct ApplyChange {
  Grid grid;
  const Quanta* change;
  Quanta* sand;
  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    sand[i] += change[i];
  }
};

}  // namespace desert_sim::reptation
