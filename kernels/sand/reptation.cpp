/// The laws and the step of reptation.hpp; compiled once for each backend.
#include "kernels/sand/reptation.hpp"

#include "kernels/backend/for_each.hpp"
#include "kernels/backend/loops.hpp"
#include "kernels/field/random.hpp"
#include "kernels/sand/repose.hpp"
#include "src/core/parameters.hpp"

namespace desert_sim::reptation {

/// Sets the angles of repose where saltation, whose deposition pass otherwise does so, is off.
struct SetAngles {
  Grid grid;
  Angle angle;
  const float *strength, *wind_x, *wind_y, *wind_shadow, *vegetation;  ///< strength: null without impacts
  repose::RelativeMoisture moisture;

  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    const float speed = hypotenuse(wind_x[i], wind_y[i]);
    const float dry = angle.lowered_tangent(value_or_zero(strength, i), speed, value_or_zero(wind_shadow, i));
    angle.repose[i] = angle.tangent_at(dry, value_or_zero(vegetation, i), moisture(i));
  }
};

template <class E>
void set_angles(E& exec, const TerrainView& t, const Angle& angle, const ReposeParameters& p,
                const float* strength) {
  for_each_cell(
      exec, t.grid,
      SetAngles{t.grid, angle, strength, t.real(Layer::wind_x), t.real(Layer::wind_y),
                t.real(Layer::wind_shadow), t.real(Layer::vegetation), repose::RelativeMoisture(t, p)});
}

/// Heights, impact strengths and winds that the laws below read.
struct Surface {
  Grid grid;
  const Quanta *bedrock, *soil, *sand;
  const float *reptation_strength, *wind_x, *wind_y, *obstacle;

  DESERT_HD Quanta height(int i) const { return bedrock[i] + value_or_zero(soil, i) + sand[i]; }
  DESERT_HD float speed(int i) const { return hypotenuse(wind_x[i], wind_y[i]); }
  DESERT_HD bool solid(int i) const { return value_or_zero(obstacle, i) > 0.0f; }
};

struct SmoothingFlux {
  Surface s;
  float strength;                        ///< k_r Δt / (sub-steps · l)
  Die pair_dice[Neighbours::count / 2];  ///< of directions k and k + 1, k even
  Quanta* change;

  /// Sand that i gives to its neighbour j in direction k [quanta], negative if it receives. The magnitude is
  /// the same whichever of the two cells computes it, because both roll the die of the same one.
  DESERT_HD Quanta flux(int i, int j, int k) const {
    const Quanta drop = s.height(i) - s.height(j);
    const float steep = strength * static_cast<float>(drop < 0 ? -drop : drop) / Neighbours::distance(k) *
                        0.5f * (s.reptation_strength[i] + s.reptation_strength[j]) * 0.5f *
                        (s.speed(i) + s.speed(j));
    const Quanta moved =
        pair_dice[k / 2].whole_at_most(0.125f * steep, s.sand[drop > 0 ? i : j] / 8, k % 2 == 0 ? i : j);
    return drop > 0 ? moved : -moved;
  }

  DESERT_HD void operator()(int x, int y) const {
    const int i = s.grid.index(x, y);
    Quanta given = 0;
    if (!s.solid(i))
      for (int k = 0; k < Neighbours::count; ++k) {
        const int j = neighbour_index(s.grid, x + Neighbours::dx(k), y + Neighbours::dy(k));
        if (j >= 0 && !s.solid(j)) given += flux(i, j, k);
      }
    change[i] = -given;
  }
};

/// Diffusivity r |w|, whose maximum sets the number of sub-steps.
struct Diffusivity {
  Surface s;
  DESERT_HD float operator()(int x, int y) const {
    const int i = s.grid.index(x, y);
    return s.reptation_strength[i] * s.speed(i);
  }
};

struct SteepestEvent {
  Surface s;
  std::uint64_t seed, tick;
  float slab;  ///< [quanta]
  Die die, share_die;
  Quanta* change;

  DESERT_HD float chance(int cell) const {
    return random_unit(seed, Purpose::reptation, static_cast<std::uint32_t>(cell),
                       static_cast<std::uint32_t>(tick), static_cast<std::uint32_t>(tick >> 32));
  }

  DESERT_HD void operator()(int x, int y) const {
    const int i = s.grid.index(x, y);
    const float probability = 1.0f - exp_negative(s.reptation_strength[i]);
    if (s.sand[i] <= 0 || s.solid(i) || chance(i) >= probability) return;
    int first = -1, second = -1;
    float first_slope = 0.0f, second_slope = 0.0f;
    for (int k = 0; k < Neighbours::count; ++k) {
      const int j = neighbour_index(s.grid, x + Neighbours::dx(k), y + Neighbours::dy(k));
      if (j < 0 || s.solid(j)) continue;
      const float slope = static_cast<float>(s.height(i) - s.height(j)) / Neighbours::distance(k);
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
    // At most half the steepest drop moves, so that an event does not overshoot.
    const Quanta moved = die.whole_at_most(minimum(slab, 0.5f * first_slope), s.sand[i], i);
    const float second_part = second < 0 ? 0.0f : second_slope / (first_slope + second_slope);
    const Quanta to_second = share_die.whole_at_most(static_cast<float>(moved) * second_part, moved, i);
    atomic_add(&change[i], -moved);
    atomic_add(&change[first], moved - to_second);
    if (second >= 0) atomic_add(&change[second], to_second);
  }
};

struct ApplyChange {
  Grid grid;
  const Quanta* change;
  Quanta* sand;
  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    sand[i] += change[i];
  }
};

template <class E>
void step(E& exec, const TerrainView& t, const ReptationParameters& p, float time_step, std::uint64_t seed,
          std::uint64_t tick, const Dice& dice, const float* reptation_strength, Quanta* change) {
  if (!moves_sand(p)) return;
  const Surface surface{t.grid,
                        t.quanta(Layer::bedrock),
                        t.quanta(Layer::soil),
                        t.quanta(Layer::sand),
                        reptation_strength,
                        t.real(Layer::wind_x),
                        t.real(Layer::wind_y),
                        t.real(Layer::obstacle)};
  const ApplyChange apply{t.grid, change, t.quanta(Layer::sand)};
  if (p.method == ReptationMethod::smoothing) {
    // The explicit scheme is stable while k_r Δt/l · r |w| ≤ ½: then a cell gives less than half of what
    // would level it with its eight neighbours.
    const float strength = p.strength * time_step / t.grid.cell_size;
    const float diffusivity = max_cells(exec, t.grid, Diffusivity{surface});
    const int substeps = static_cast<int>(clamp(ceilf(strength * diffusivity / 0.5f), 1.0f, 1000.0f));
    for (int n = 0; n < substeps; ++n) {
      for_each_cell(
          exec, t.grid,
          SmoothingFlux{
              surface,
              strength / substeps,
              {dice[Roll::reptation_east].of_part(n), dice[Roll::reptation_north].of_part(n),
               dice[Roll::reptation_north_east].of_part(n), dice[Roll::reptation_north_west].of_part(n)},
              change});
      for_each_cell(exec, t.grid, apply);
    }
  } else {
    exec.set_zero(change, sizeof(Quanta) * t.grid.cells());
    for_each_cell(exec, t.grid,
                  SteepestEvent{surface, seed, tick, p.slab * time_step * t.quanta_per_metre,
                                dice[Roll::reptation], dice[Roll::reptation_second], change});
    for_each_cell(exec, t.grid, apply);
  }
}

template void set_angles(Backend&, const TerrainView&, const Angle&, const ReposeParameters&, const float*);
template void step(Backend&, const TerrainView&, const ReptationParameters&, float, std::uint64_t,
                   std::uint64_t, const Dice&, const float*, Quanta*);

}  // namespace desert_sim::reptation
