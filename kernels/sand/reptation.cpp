/// The laws and the step of reptation.hpp; compiled once for each backend.
#include "kernels/sand/reptation.hpp"

#include "kernels/backend/for_each.hpp"
#include "kernels/backend/loops.hpp"
#include "kernels/base/math.hpp"
#include "kernels/field/random.hpp"
#include "kernels/field/surface_laws.hpp"
#include "kernels/sand/creep.hpp"
#include "kernels/sand/repose.hpp"
#include "src/core/parameter_table.hpp"

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

/// The same where there are neither impacts nor plants nor moisture.
struct SetDryAngles {
  Grid grid;
  float tangent;
  float* repose;
  DESERT_HD void operator()(int x, int y) const { repose[grid.index(x, y)] = tangent; }
};

template <class E>
void set_angles(E& exec, const TerrainView& t, const Angle& angle, const ReposeParameters& p,
                const float* strength) {
  if (!strength && !t.real(Layer::vegetation) && !t.quanta(Layer::moisture))
    return for_each_cell(exec, t.grid,
                         SetDryAngles{t.grid, angle.tangent_at(angle.tangents.sand, 0, 0), angle.repose});
  for_each_cell(
      exec, t.grid,
      SetAngles{t.grid, angle, strength, t.real(Layer::wind_x), t.real(Layer::wind_y),
                t.real(Layer::wind_shadow), t.real(Layer::vegetation), repose::RelativeMoisture(t, p)});
}

/// Heights, impact strengths and winds that the laws below read. No branches, so that CPUs vectorise.
struct Surface {
  /// Of a type that a written change might alter. Otherwise GCC would carry the speed of a cell to the next
  /// one along a row, whose neighbour it is, and not vectorise.
  using Wind = float DESERT_MAY_ALIAS;

  Grid grid;
  surface::SolidHeight height;
  const float* reptation_strength;
  const Wind *wind_x, *wind_y;
  const float* obstacle;  ///< any other layer where there are none
  float least_obstacle;   ///< of which all values are below this then

  Surface(const TerrainView& t, const float* impacts)
      : grid(t.grid),
        height(t),
        reptation_strength(impacts),
        wind_x(t.real(Layer::wind_x)),
        wind_y(t.real(Layer::wind_y)),
        obstacle(t.real(Layer::obstacle) ? t.real(Layer::obstacle) : impacts),
        least_obstacle(t.real(Layer::obstacle) ? 0.0f : HUGE_VALF) {}
  DESERT_HD Quanta sand(int i) const { return height.sand[i]; }
  DESERT_HD float speed(int i) const { return hypotenuse(wind_x[i], wind_y[i]); }
  DESERT_HD bool solid(int i) const { return obstacle[i] > least_obstacle; }
};

/// `inside`: for cells that have all their neighbours.
template <bool inside>
struct Smooth {
  Surface s;
  float strength;                        ///< k Δt / l
  Die pair_dice[Neighbours::count / 2];  ///< of directions k and k + 1, k even
  Quanta* change;

  DESERT_HD int neighbour(int x, int y) const {
    return inside ? s.grid.index(x, y) : neighbour_index(s.grid, x, y);
  }
  /// Sand that cell i gives to its neighbour j in direction k [quanta], negative if it receives. The
  /// magnitude is the same whichever of the two cells computes it, because both roll the die of the same one.
  /// `height`, `sand`, r and `speed` are those of i.
  DESERT_HD Quanta flux(int i, Quanta height, Quanta sand, float r, float speed, int j, int k) const {
    const Quanta drop = height - s.height(j), others = s.sand(j), donor = drop > 0 ? sand : others;
    const float steep = fabsf(static_cast<float>(drop));
    const float wanted = strength * steep / Neighbours::distance(k) * 0.5f * (r + s.reptation_strength[j]) *
                         0.5f * (speed + s.speed(j));
    const Quanta moved =
        pair_dice[k / 2].whole_at_most(0.125f * minimum(wanted, 0.5f * steep), donor / 8, k % 2 == 0 ? i : j);
    return drop > 0 ? moved : -moved;
  }

  DESERT_HD void operator()(int x, int y) const {
    const int i = s.grid.index(x, y);
    const Quanta height = s.height(i), sand = s.sand(i);
    const float r = s.reptation_strength[i], speed = s.speed(i);
    Quanta given = 0;
    unrolled<Neighbours::count>([&](auto k) DESERT_INLINE {
      const int j = neighbour(x + Neighbours::dx(k), y + Neighbours::dy(k));
      if constexpr (!inside)
        if (j < 0) return;
      const Quanta moved = flux(i, height, sand, r, speed, j, k);
      given += s.solid(j) ? 0 : moved;
    });
    change[i] = s.solid(i) ? 0 : -given;
  }
};

/// The law of one sub-step.
struct Smoothing {
  Surface s;
  float strength;
  const Dice& dice;
  int part;
  Quanta* change;

  template <bool inside>
  Smooth<inside> law() const {
    const auto die = [this](Roll roll) { return dice[roll].of_part(part); };
    return {s,
            strength,
            {die(Roll::reptation_east), die(Roll::reptation_north), die(Roll::reptation_north_east),
             die(Roll::reptation_north_west)},
            change};
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
  float share;  ///< of the events of 1 s that happen in a step
  float slab;   ///< [quanta]
  CreepToSteepest creep;

  DESERT_HD float chance(int cell) const {
    return random_unit(seed, Purpose::reptation, static_cast<std::uint32_t>(cell),
                       static_cast<std::uint32_t>(tick), static_cast<std::uint32_t>(tick >> 32));
  }

  DESERT_HD void operator()(int x, int y) const {
    const int i = s.grid.index(x, y);
    const float probability = 1.0f - exp_negative(s.reptation_strength[i]);
    if (s.sand(i) <= 0 || s.solid(i) || chance(i) >= share * probability) return;
    creep(x, y, slab);
  }
};

template <class E>
void step(E& exec, const TerrainView& t, const ReptationParameters& p, const StepInputs& in,
          const Dice& dice) {
  if (!moves_sand(p)) return;
  const float time_step = in.time_step;
  Quanta* const change = in.change;
  const Surface surface(t, in.strength);
  const ApplyChange apply{t.grid, change, t.quanta(Layer::sand)};
  if (const float k = smoothing_strength(p); k > 0.0f) {
    const float strength = k * time_step / t.grid.cell_size;
    int parts = 1;
    if (p.method == ReptationMethod::smoothing)
      parts = static_cast<int>(
          clamp(ceilf(strength * max_cells(exec, t.grid, Diffusivity{surface}) / 0.5f), 1.0f, 1000.0f));
    for (int part = 0; part < parts; ++part) {
      const Smoothing smoothing{surface, strength / static_cast<float>(parts), dice, part, change};
      for_each_cell(
          exec, t.grid,
          Bordered<Smooth<true>, Smooth<false>>{t.grid, 1, smoothing.law<true>(), smoothing.law<false>()});
      for_each_cell(exec, t.grid, apply);
    }
  }
  if (p.method == ReptationMethod::steepest) {
    exec.set_zero(change, sizeof(Quanta) * t.grid.cells());
    for_each_cell(exec, t.grid,
                  SteepestEvent{surface, in.seed, in.tick, minimum(time_step, 1.0f),
                                p.slab * maximum(time_step, 1.0f) * t.quanta_per_metre,
                                creep_to_steepest(t, dice, change)});
    for_each_cell(exec, t.grid, apply);
  }
}

template void set_angles(Backend&, const TerrainView&, const Angle&, const ReposeParameters&, const float*);
template void step(Backend&, const TerrainView&, const ReptationParameters&, const StepInputs&, const Dice&);

}  // namespace desert_sim::reptation
