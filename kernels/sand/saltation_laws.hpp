#pragma once
/// The laws of saltation.hpp, cell by cell.

#include "kernels/backend/for_each.hpp"
#include "kernels/backend/vec4.hpp"
#include "kernels/field/dice.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/sand/abrasion.hpp"
#include "kernels/sand/carried.hpp"
#include "kernels/sand/reptation.hpp"
#include "kernels/sand/saltation.hpp"
#include "kernels/sand/saltation_inputs.hpp"
#include "src/core/parameter_table.hpp"

namespace desert_sim::saltation {

/// How much sand the wind can lift from a cell in the time of a hop.
template <bool bare>
struct Lift {
  Inputs<bare> in;
  SaltationParameters p;

  /// [quanta], no more than `lying`. u, v: wind [m/s].
  DESERT_HD float operator()(float u, float v, float shadow, float echo, float plants, float moisture,
                             bool flooded, Quanta lying) const {
    const float speed_squared = u * u + v * v;
    if (lying <= 0 || !(speed_squared > 0.0f)) return 0.0f;
    if (speed_squared < p.threshold_speed * p.threshold_speed) return 0.0f;
    const float wet = flooded ? 0.0f : in.dryness(moisture);
    const float metres = in.hop_time * (p.lift * (1.0f - shadow) * (1.0f - plants) *
                                            (echo > 0.0f ? in.sticky_lift : 1.0f) * wet +
                                        (echo < 0.0f ? -echo : 0.0f));
    return minimum(metres * in.quanta_per_metre, static_cast<float>(lying));
  }
};

/// Lifts sand, and scatters what hops to the four cells around its landing point.
template <bool bare>
struct LiftAndAdvect {
  template <int count>
  using Parcels = BilinearParcels<count>;
  Inputs<bare> in;
  Lift<bare> lift;
  float hop_per_speed;  ///< length of a hop over wind speed, T / l [cells s/m]
  Die lift_die, wait_die, landing_die;
  Quanta *sand, *airborne;
  LedgerView ledger;

  /// Values on which a cell's lift depends. All are loaded before the first branch, so that a GPU waits for
  /// memory once.
  struct Cell {
    float u, v;
    Quanta lying, carried;
    float shadow, echo, plants, moisture;
    bool flooded;
  };
  DESERT_HD Cell read(int x, int y, float shadow) const {
    const int i = in.grid.index(x, y);
    return {in.wind_x[i],     in.wind_y[i], sand[i],        airborne[i],  shadow,
            in.echo_value(i), in.plants(i), in.moisture(i), in.flooded(i)};
  }
  DESERT_HD Cell read(int x, int y) const {
    return read(x, y, value_or_zero(in.wind_shadow, in.grid.index(x, y)));
  }

  /// What leaves the ground of cell i, and what of the sand in the air hops with it.
  DESERT_HD Quanta lifted(const Cell& c, int i) const {
    const float liftable = lift(c.u, c.v, c.shadow, c.echo, c.plants, c.moisture, c.flooded, c.lying);
    return lift_die.whole_at_most(in.hop_share * liftable, c.lying, i);
  }
  DESERT_HD Quanta bouncing(const Cell& c, int i) const {
    if (in.hop_share >= 1.0f) return c.carried;
    return wait_die.whole_at_most(in.hop_share * static_cast<float>(c.carried), c.carried, i);
  }

  template <int count>
  DESERT_HD void prepare(int x, int y, const Cell& c, BilinearParcels<count>& parcels, int n) const {
    const int i = in.grid.index(x, y);
    const Quanta from_ground = lifted(c, i), from_air = bouncing(c, i);
    if (in.hop_share < 1.0f) airborne[i] = c.carried - from_air;
    const Quanta carried = from_ground + from_air;
    sand[i] = c.lying - from_ground;
    // Where the four shares are so small that rounding would falsify them, all lands in one of the cells.
    const std::uint32_t die = landing_die.word(i);
    const bool few = static_cast<float>(carried) < Die::small;
    const int dx = to_fixed_point(c.u * hop_per_speed), dy = to_fixed_point(c.v * hop_per_speed);
    parcels.set(n, x, y, Die::whole_cells_if(few, dx, die), Die::whole_cells_if(few, dy, die >> 16), carried);
  }
  template <int count>
  DESERT_HD void prepare(int x, int y, BilinearParcels<count>& parcels, int n) const {
    prepare(x, y, read(x, y), parcels, n);
  }

  template <int count, class Add>
  DESERT_HD void deliver(int x, int y, const BilinearParcels<count>& parcels, int n, const Add& add) const {
    ParcelDelivery{in.grid, Material::sand, ledger}.deliver(x, y, parcels, n, add);
  }
};

/// Adds the flux of a hop, of the very quanta that LiftAndAdvect moves after it.
template <bool bare>
struct AddFlux {
  LiftAndAdvect<bare> advect;
  float per_quantum;  ///< depth of a quantum, times T/Δt [m]
  float *flux_x, *flux_y;

  DESERT_HD void operator()(int x, int y) const {
    const int i = advect.in.grid.index(x, y);
    const auto c = advect.read(x, y);
    const float moved = static_cast<float>(advect.lifted(c, i) + advect.bouncing(c, i)) * per_quantum;
    flux_x[i] += moved * c.u;
    flux_y[i] += moved * c.v;
  }
};

/// Sand that the wind carries in over an open edge (parameter `influx`).
template <bool bare>
struct Influx {
  Inputs<bare> in;
  float influx;
  Die die;
  FilledHeight filled;
  Quanta* landed;
  LedgerView ledger;

  /// Share of what lands in the cell which lies `cell` cells from an edge that has hopped over this edge;
  /// `speed`: of the wind into the grid [m/s].
  DESERT_HD float over_edge(int cell, float speed) const {
    const float l = in.grid.cell_size, hop = speed * in.hop_time;
    return clamp((hop - cell * l) / l, 0.0f, 1.0f);
  }

  /// Depth [m] that all edges bring to a cell. In a corner sand comes over either edge, and some of it over
  /// both, which counts once.
  DESERT_HD float over_edges(int x, int y) const {
    const Grid& g = in.grid;
    const int i = g.index(x, y);
    const float u = in.wind_x[i], v = in.wind_y[i];
    const float speed = hypotenuse(u, v);
    if (!(speed > 1e-6f)) return 0.0f;
    const float over_x = g.periodic_x ? 0.0f : over_edge(u > 0.0f ? x : g.width - 1 - x, fabsf(u));
    const float over_y = g.periodic_y ? 0.0f : over_edge(v > 0.0f ? y : g.height - 1 - y, fabsf(v));
    return influx * in.hop_share / speed * (over_x + over_y - over_x * over_y);
  }

  DESERT_HD void operator()(int x, int y) const {
    const int i = in.grid.index(x, y);
    bring(i, die.whole_at_most(over_edges(x, y) * in.quanta_per_metre, most_influx, i));
  }
  /// Into a cell that is full comes nothing.
  DESERT_HD void bring(int i, Quanta amount) const {
    if (amount <= 0) return;
    const Quanta comes = with_room(amount, filled(i));
    landed[i] += comes;
    ledger.book_in(Material::sand, i, comes);
  }
};

/// Sand that comes down in a cell: grains of one hop land around its mean, with the standard deviation
/// `hop_spread` along each axis. Of what landed in a cell, the shares of a binomial kernel go to its eight
/// neighbours; both cells of a pair compute the same amounts, so that none is lost.
struct Landing {
  Grid grid;
  const Quanta* landed;
  std::int32_t to_side, to_corner;  ///< shares of a cell's sand that each of its neighbours gets [2⁻³¹]

  Landing(const Grid& g, const Quanta* landed_sand, float spread) : grid(g), landed(landed_sand) {
    const double cells = static_cast<double>(spread) / static_cast<double>(g.cell_size);
    const double wing = cells < 0.7 ? 0.5 * cells * cells : 0.25;
    to_side = static_cast<std::int32_t>(wing * (1 - 2 * wing) * 2147483648.0);
    to_corner = static_cast<std::int32_t>(wing * wing * 2147483648.0);
  }
  /// [quanta]. `inside`: for cells that have all their neighbours.
  template <bool inside>
  DESERT_HD Quanta at(int x, int y) const {
    const Quanta here = landed[grid.index(x, y)], side = part(here, to_side), corner = part(here, to_corner);
    Quanta sum = here;
    unrolled<Neighbours::count>([&](auto k) DESERT_INLINE {
      const int to_x = x + Neighbours::dx(k), to_y = y + Neighbours::dy(k);
      const int j = inside ? grid.index(to_x, to_y) : neighbour_index(grid, to_x, to_y);
      const bool straight = Neighbours::dx(k) == 0 || Neighbours::dy(k) == 0;
      if (j >= 0) sum += straight ? part(landed[j], to_side) - side : part(landed[j], to_corner) - corner;
    });
    return sum;
  }
  DESERT_HD static Quanta part(Quanta of, std::int32_t share) {
    return static_cast<Quanta>((static_cast<std::int64_t>(of) * share) >> 31);
  }
};

/// The deposited share of what lands on a cell.
template <bool bare>
struct DepositedShare {
  Inputs<bare> in;
  SaltationParameters p;

  /// The deposited share p. `cover`: sand of the cell before the deposit [quanta]; v: vegetation; m: relative
  /// moisture.
  DESERT_HD float operator()(int i, Quanta cover, float shadow, float v, float m) const {
    const float r_e = in.echo_value(i);
    if (r_e < 0.0f || in.solid(i)) return 0.0f;
    const bool sandy = cover > 0 && cover * in.quantum >= p.bare_depth;
    const float bounce = sandy ? p.bounce_on_sand
                               : (in.value_if_present(in.soil, i) > 0 ? p.bounce_on_soil : p.bounce_on_rock);
    const float deposited_share = maximum((1.0f - bounce) + v * bounce, maximum(shadow, r_e));
    const float damp = in.flooded(i) ? p.least_deposit : maximum(in.dryness(m), p.least_deposit);
    const float wet = bare ? 1.0f : damp;
    return clamp(deposited_share, 0.0f, 1.0f) * wet;
  }
};

/// Deposits a share of the sand that landed and lets the rest bounce; abrades the ground and sets the
/// impacts.
template <bool bare>
struct Deposit {
  Inputs<bare> in;
  Lift<bare> lift;
  abrasion::Abrade abrade;
  Die die;
  Landing landing;
  Quanta *sand, *airborne;
  reptation::Impacts impacts;

  /// Sand of a cell that the lift leaves on the ground. `lying`: its sand after the lift, which took a share.
  DESERT_HD Quanta covering(int i, Quanta lying, float u, float v, float shadow, float plants,
                            float moisture) const {
    if (in.hop_share >= 1.0f) return lying;
    const float liftable = lift(u, v, shadow, in.echo_value(i), plants, moisture, in.flooded(i), wall_height);
    const Quanta rest = lying - static_cast<Quanta>((1.0f - in.hop_share) * liftable);
    return rest > 0 ? rest : 0;
  }

  /// What a cell does with the sand that lands. split_landed() computes it without writing, so that all loads
  /// come before the first store.
  struct DepositResult {
    float deposited_share;
    Quanta stays, bounces;
    float strength;         ///< impact strength [m]
    float lowered_tangent;  ///< tangent of repose of dry bare sand under the impacts
  };
  DESERT_HD DepositResult split_landed(int i, Quanta arriving, Quanta cover, float shadow, float speed,
                                       float v, float m) const {
    const float deposited_share = DepositedShare<bare>{in, lift.p}(i, cover, shadow, v, m),
                depth = arriving * in.quantum;
    const Quanta stays = die.whole_at_most(deposited_share * static_cast<float>(arriving), arriving, i);
    const float strength = depth * (1.0f - v) / in.hop_share;
    return {deposited_share, stays, arriving - stays, strength,
            impacts.angle.lowered_tangent(strength, speed, shadow)};
  }

  DESERT_HD void deposit(int x, int y, Quanta arriving) const {
    const int i = in.grid.index(x, y);
    const Quanta lying = sand[i], waiting = in.hop_share < 1.0f ? airborne[i] : 0;
    const float v = in.plants(i), m = in.moisture(i), w_x = in.wind_x[i], w_y = in.wind_y[i];
    const float speed = hypotenuse(w_x, w_y), shadow = value_or_zero(in.wind_shadow, i);
    const Quanta cover = covering(i, lying, w_x, w_y, shadow, v, m);
    const DepositResult o = split_landed(i, arriving, cover, shadow, speed, v, m);
    sand[i] = lying + o.stays;
    airborne[i] = waiting + o.bounces;
    if (!bare && !in.solid(i) && !in.flooded(i))
      abrade(i, cover, o.bounces / in.hop_share, speed, v, m, o.deposited_share);
    impacts.set(i, o.strength, o.lowered_tangent, v, in.moisture(i));
  }
};

/// Deposit of one cell; `inside`: for cells that have all their neighbours.
template <bool bare, bool inside>
struct DepositOfOne {
  Deposit<bare> law;
  DESERT_HD void operator()(int x, int y) const { law.deposit(x, y, law.landing.template at<inside>(x, y)); }
};

}  // namespace desert_sim::saltation
