#pragma once
/// The laws of desertscape.hpp, cell by cell.

#include "kernels/backend/atomics.hpp"
#include "kernels/field/draws.hpp"
#include "kernels/sand/creep.hpp"
#include "kernels/sand/saltation_laws.hpp"

namespace desert_sim::desertscape {

using saltation::DepositedShare;
using saltation::Influx;
using saltation::Inputs;
using saltation::Lift;

/// From Poisson's distribution; u uniform in [0, 1). Where many are expected, the mean in whole numbers.
DESERT_HD int poisson_draw(float mean, float u) {
  constexpr float many = 32.0f;
  if (mean > many) return static_cast<int>(minimum(mean, 1.0e6f) + u);
  float probability = exp_negative(mean), sum = probability;
  int n = 0;
  while (u >= sum && n < 128) {  // rounding may keep the sum below u
    ++n;
    probability *= mean / static_cast<float>(n);
    sum += probability;
  }
  return n;
}

/// Slabs leave the ground; what was in the air already flies with them.
struct LiftSlabs {
  Inputs<false> in;
  Lift<false> lift;
  float slabs_per_quantum;  ///< of what is lifted in the time of a hop: Δt/(T ε) [1/quanta]
  Quanta slab;
  Die die;
  Quanta *sand, *airborne, *aloft, *bounced;

  DESERT_HD void operator()(int x, int y) const {
    const int i = in.grid.index(x, y);
    const float liftable = lift(in.wind_x[i], in.wind_y[i], value_or_zero(in.wind_shadow, i),
                                in.echo_value(i), in.plants(i), in.moisture(i), in.flooded(i), wall_height);
    Quanta lifted = 0;
    if (sand[i] > 0 && liftable > 0.0f) {
      const int slabs = poisson_draw(liftable * slabs_per_quantum, unit_from(die.word(i)));
      lifted = slabs > 0 && sand[i] / slabs < slab ? sand[i] : slabs * slab;
    }
    sand[i] -= lifted;
    aloft[i] = lifted + airborne[i];
    airborne[i] = bounced[i] = 0;
  }
};

/// The flights of the slabs of a cell, over ground that does not change meanwhile.
struct FlySlabs {
  Inputs<false> in;
  DepositedShare<false> deposited;
  float hop_per_speed;  ///< T/l [cells s/m]
  float spread;         ///< standard deviation of a hop along an axis [cells]
  Quanta slab;
  Die die;
  const Quanta *sand, *aloft;
  Quanta *landed, *bounced, *airborne;
  LedgerView ledger;

  static constexpr int most_bounces = 64;

  DESERT_HD void operator()(int i) const {
    RandomSequence words{die.word(i)};
    for (Quanta left = aloft[i]; left > 0; left -= slab) fly(i, left < slab ? left : slab, words);
  }
  /// Length of a hop along an axis [cells, 16.16 fixed point].
  DESERT_HD int hop(float wind, float open, RandomSequence& words) const {
    float cells = wind * open * hop_per_speed;
    if (spread > 0.0f) {
      const std::uint32_t radius = words.next();
      cells += spread * normal_draw(radius, words.next());
    }
    return to_fixed_point(cells);
  }
  DESERT_HD void fly(int from, Quanta amount, RandomSequence& words) const {
    const Grid& grid = in.grid;
    int at = from, off_x = 0, off_y = 0;  // from the middle of the cell [16.16 fixed point]
    for (int bounces = 0;; ++bounces) {
      const float open = 1.0f - value_or_zero(in.wind_shadow, at);
      off_x += hop(in.wind_x[at], open, words);
      off_y += hop(in.wind_y[at], open, words);
      const int over_x = nearest_cell(off_x), over_y = nearest_cell(off_y);
      off_x -= over_x * fixed_point_one;
      off_y -= over_y * fixed_point_one;
      at = cell_at(grid, at % grid.width + over_x, at / grid.width + over_y);
      if (at < 0) return ledger.book_out(Material::sand, from, amount);
      const float p =
          deposited(at, sand[at], value_or_zero(in.wind_shadow, at), in.plants(at), in.moisture(at));
      if (words.unit() < p) return static_cast<void>(atomic_add(&landed[at], amount));
      atomic_add(&bounced[at], amount);
      if (bounces == most_bounces) return static_cast<void>(atomic_add(&airborne[at], amount));
    }
  }
  /// −1 beyond an open edge. Hops may be longer than the grid.
  DESERT_HD static int cell_at(const Grid& grid, int x, int y) {
    if (grid.inside(x, y)) return grid.index(x, y);
    const auto wrapped = [](int n, int cells) { return (n % cells + cells) % cells; };
    if (grid.periodic_x) x = wrapped(x, grid.width);
    if (grid.periodic_y) y = wrapped(y, grid.height);
    return grid.inside(x, y) ? grid.index(x, y) : -1;
  }
};

/// Slabs that the wind carries in over an open edge.
struct SlabInflux {
  Influx<false> flow;
  Quanta slab;

  DESERT_HD void operator()(int x, int y) const {
    const float slabs = flow.over_edges(x, y) * flow.in.quanta_per_metre / static_cast<float>(slab);
    if (!(slabs > 0.0f)) return;
    const int i = flow.in.grid.index(x, y), count = poisson_draw(slabs, unit_from(flow.die.word(i)));
    flow.bring(i, count < most_influx / slab ? slab * count : most_influx / slab * slab);
  }
};

/// What came down becomes sand; bounces wear the ground.
struct SettleSlabs {
  Inputs<false> in;
  abrasion::Abrade abrade;
  const Quanta *landed, *bounced;
  Quanta* sand;

  DESERT_HD void operator()(int x, int y) const {
    const int i = in.grid.index(x, y);
    const Quanta cover = sand[i];
    sand[i] = cover + landed[i];
    if (in.solid(i) || in.flooded(i)) return;
    const float open = 1.0f - value_or_zero(in.wind_shadow, i);
    abrade(i, cover, static_cast<float>(bounced[i]), open * hypotenuse(in.wind_x[i], in.wind_y[i]),
           in.plants(i), in.moisture(i), 0.0f);
  }
};

/// Adds the flux of the hops that began in a cell.
struct AddSlabFlux {
  Inputs<false> in;
  float per_quantum;  ///< depth of a quantum, times T/Δt [m]
  const Quanta *aloft, *bounced;
  float *flux_x, *flux_y;

  DESERT_HD void operator()(int x, int y) const {
    const int i = in.grid.index(x, y);
    const float moved =
        static_cast<float>(aloft[i] + bounced[i]) * per_quantum * (1.0f - value_or_zero(in.wind_shadow, i));
    flux_x[i] += moved * in.wind_x[i];
    flux_y[i] += moved * in.wind_y[i];
  }
};

/// Impacts set sand creeping, one event for each that plants do not prevent.
struct CreepByImpacts {
  Inputs<false> in;
  reptation::CreepToSteepest creep;
  float impacts_per_quantum;  ///< 1/ε [1/quanta]
  float creeping;             ///< depth that an event moves [quanta]
  Die die;
  const Quanta *landed, *bounced;

  DESERT_HD void operator()(int i) const {
    const float impacts = static_cast<float>(landed[i] + bounced[i]) * impacts_per_quantum;
    if (!(impacts > 0.0f) || creep.sand[i] <= 0 || in.solid(i)) return;
    const Quanta events = die.whole_at_most(impacts * (1.0f - in.plants(i)), load_limit, i);
    if (events > 0) creep(i % in.grid.width, i / in.grid.width, creeping * static_cast<float>(events));
  }
};

}  // namespace desert_sim::desertscape
