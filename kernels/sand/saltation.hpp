#pragma once
/// Saltation: the wind lifts sand, carries it a hop, and part of it stays. Expected values, no dice.
/// Nilles 2024 §3.6; physics.md B1–B3.
///
///   lift     L = min(s, ε_s (1 − r_s)(1 − v)(r_e > 0 ? ½ : 1) M + (r_e < 0 ? k_e : 0)),  a += L
///            M = clamp(1 − 10 m, 0, 1), 0 under water; nothing lifts in still air or below the threshold
///            speed
///   advect   a moves by w Δt / l cells and is shared bilinearly among four (scattered integers: exact, any
///   order) deposit  p = clamp(max(r_s, (1 − f) + v f, r_e), 0, 1), f = 0.4 on sand, 0.5 on soil, 0.6 on
///   rock; 0 on obstacles
///            and in the lane before a cliff; · clamp(1 − 10 m, 0.01, 1), under water · 0.01;  s += p a
///   bounce   a ← (1 − p) a stays in the air; strength of reptation r = (deposited + bounced)(1 − v)
///
/// On open edges sand that is carried over an edge is booked as out; `influx` enters where the wind blows in,
/// spread over the first hop. Reads sand, wind, wind_shadow, echo, vegetation, obstacle, moisture, water;
/// writes sand, airborne_sand, and through abrasion bedrock and soil.

#include "kernels/backend/for_each.hpp"
#include "kernels/backend/vec4.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/sand/abrasion.hpp"
#include "kernels/sand/carried.hpp"
#include "kernels/sand/reptation.hpp"
#include "kernels/sand/saltation_inputs.hpp"
#include "kernels/wind/wind_shadow.hpp"
#include "src/core/parameters.hpp"

namespace desert_sim {

struct SaltationParameters {
  bool enabled = true;
  float lift = 1.0f;
  float threshold_speed = 0.0f;
  float bounce_on_sand = 0.4f;
  float bounce_on_soil = 0.5f;
  float bounce_on_rock = 0.6f;
  float bare_depth = 0.001f;
  float influx = 0.0f;
};

constexpr auto parameter_table(const SaltationParameters*) {
  using P = SaltationParameters;
  return std::make_tuple(
      parameter("enabled", &P::enabled, "Whether the wind carries sand."),
      parameter("lift", &P::lift, 0, 10, "m", "Sand lifted from an open cell a step of 1 s (epsilon_s)."),
      parameter("threshold_speed", &P::threshold_speed, 0, 100, "m/s", "Wind below which nothing is lifted."),
      parameter("bounce_on_sand", &P::bounce_on_sand, 0, 1, "1",
                "Share of landing sand that bounces on sand (f)."),
      parameter("bounce_on_soil", &P::bounce_on_soil, 0, 1, "1",
                "Share of landing sand that bounces on soil."),
      parameter("bounce_on_rock", &P::bounce_on_rock, 0, 1, "1",
                "Share of landing sand that bounces on rock."),
      parameter("bare_depth", &P::bare_depth, 0, 1, "m",
                "Depth of sand below which the ground counts as bare."),
      parameter("influx", &P::influx, 0, 100, "m^2/s",
                "Sand that enters an open windward edge, per metre of edge."));
}
static_assert(table_is_complete<SaltationParameters>());

namespace saltation {

/// Lifts, and scatters what is in the air over a cell to the four cells around where it lands.
template <bool bare>
struct LiftAndAdvect {
  template <int count>
  using Parcels = Carried<count>;
  Inputs<bare> in;
  SaltationParameters p;
  float cells_a_speed;  ///< of a hop
  Quanta* sand;
  const Quanta* airborne;
  LedgerView ledger;

  /// What a cell's lift depends on. All of it is read before anything is asked, so that a GPU waits once.
  struct Cell {
    float u, v;
    Quanta lying, carried;
    float shadow, eddy, plants, moisture;
    bool flooded;
  };
  DESERT_HD Cell read(int x, int y, float shadow) const {
    const int i = in.grid.index(x, y);
    return {in.wind_x[i], in.wind_y[i], sand[i],        airborne[i],  shadow,
            in.eddy(i),   in.plants(i), in.moisture(i), in.flooded(i)};
  }
  DESERT_HD Cell read(int x, int y) const {
    return read(x, y, value_or_zero(in.wind_shadow, in.grid.index(x, y)));
  }
  DESERT_HD Quanta lifted(const Cell& c) const {
    const float speed_squared = c.u * c.u + c.v * c.v;
    if (c.lying <= 0 || !(speed_squared > 0.0f)) return 0;
    if (speed_squared < p.threshold_speed * p.threshold_speed) return 0;
    const float wet = c.flooded ? 0.0f : dryness(c.moisture);
    const float metres =
        in.time_step * (p.lift * (1.0f - c.shadow) * (1.0f - c.plants) * (c.eddy > 0.0f ? 0.5f : 1.0f) * wet +
                        (c.eddy < 0.0f ? -c.eddy : 0.0f));
    return take(metres, in.quanta_per_metre, c.lying);
  }

  template <int count>
  DESERT_HD void prepare(int x, int y, const Cell& c, Carried<count>& parcels, int n) const {
    const Quanta lift = lifted(c);
    sand[in.grid.index(x, y)] = c.lying - lift;
    parcels.set(n, x, y, subcells(c.u * cells_a_speed), subcells(c.v * cells_a_speed), c.carried + lift);
  }
  template <int count>
  DESERT_HD void prepare(int x, int y, Carried<count>& parcels, int n) const {
    prepare(x, y, read(x, y), parcels, n);
  }

  template <int count, class Add>
  DESERT_HD void deliver(int x, int y, const Carried<count>& parcels, int n, const Add& add) const {
    Landing{in.grid, Material::sand, ledger}.deliver(x, y, parcels, n, add);
  }
};

/// LiftAndAdvect of a cell whose shadow is found in the same pass.
template <bool bare>
struct ShadeAndLift {
  static constexpr bool compact_warps = true;
  template <int count>
  using Parcels = Carried<count>;
  wind_shadow::Shadow shade;
  LiftAndAdvect<bare> lift;

  template <int count>
  DESERT_HD void prepare(int x, int y, Carried<count>& parcels, int n) const {
    auto cell = lift.read(x, y, 0.0f);  // on its way while the shadow is looked for
    cell.shadow = shade(x, y);
    lift.prepare(x, y, cell, parcels, n);
  }
  template <int count, class Add>
  DESERT_HD void deliver(int x, int y, const Carried<count>& parcels, int n, const Add& add) const {
    lift.deliver(x, y, parcels, n, add);
  }
};

/// Sand that the wind brings in over an open edge; see `influx`.
template <bool bare>
struct Influx {
  Inputs<bare> in;
  float influx;
  Quanta* landed;
  LedgerView ledger;

  /// Depth brought over one edge to the cell that lies `cell` cells from it, with wind `speed` into the grid.
  DESERT_HD float over_edge(int cell, float speed) const {
    const float l = in.grid.cell_size, hop = speed * in.time_step;
    if (!(hop > 0.0f)) return 0.0f;
    return influx * in.time_step / hop * clamp((hop - cell * l) / l, 0.0f, 1.0f);
  }

  DESERT_HD void operator()(int x, int y) const {
    const Grid& g = in.grid;
    const int i = g.index(x, y);
    const float u = in.wind_x[i], v = in.wind_y[i];
    const float speed = hypotenuse(u, v);
    if (!(speed > 1e-6f)) return;
    float depth = 0.0f;
    if (!g.periodic_x) depth += over_edge(u > 0.0f ? x : g.width - 1 - x, fabsf(u)) * fabsf(u) / speed;
    if (!g.periodic_y) depth += over_edge(v > 0.0f ? y : g.height - 1 - y, fabsf(v)) * fabsf(v) / speed;
    const Quanta amount = take(depth, in.quanta_per_metre, wall_height);
    landed[i] += amount;
    ledger.book_in(Material::sand, i, amount);
  }
};

/// Deposits a share of what landed; the rest bounces on. Wears the ground, and leaves the impacts' marks.
template <bool bare>
struct Deposit {
  Inputs<bare> in;
  SaltationParameters p;
  abrasion::Wear wear;
  const Quanta* landed;
  Quanta *sand, *airborne;
  reptation::Impacts impacts;

  /// `cover`: the sand that lies there; v vegetation, m relative moisture.
  DESERT_HD float share(int i, Quanta cover, float shadow, float v, float m) const {
    const float r_e = in.eddy(i);
    if (r_e < 0.0f || in.solid(i)) return 0.0f;
    const bool sandy = cover > 0 && cover * in.quantum >= p.bare_depth;
    const float bounce =
        sandy ? p.bounce_on_sand : (in.there_may_be(in.soil, i) > 0 ? p.bounce_on_soil : p.bounce_on_rock);
    const float held = maximum((1.0f - bounce) + v * bounce, maximum(shadow, r_e));
    const float wet = in.flooded(i) ? 0.01f : maximum(dryness(m), 0.01f);
    return clamp(held, 0.0f, 1.0f) * wet;
  }

  /// What becomes of sand that arrives. Reads, but does not write: what is written waits for all that is read
  /// once.
  struct Outcome {
    float held;  ///< share
    Quanta stays, bounces;
    float strength, loosened;  ///< of the impacts, and the angle of dry bare sand that they leave
  };
  DESERT_HD Outcome settle(int i, Quanta arriving, Quanta cover, float shadow, float speed, float v,
                           float m) const {
    const float held = share(i, cover, shadow, v, m), depth = arriving * in.quantum;
    const Quanta stays = take(held * depth, in.quanta_per_metre, arriving);
    const float strength = depth * (1.0f - v);
    return {held, stays, arriving - stays, strength, impacts.angle.loosened(strength, speed, shadow)};
  }

  DESERT_HD void operator()(int x, int y) const {
    const int i = in.grid.index(x, y);
    const Quanta cover = sand[i];
    const float v = in.plants(i), m = in.moisture(i), speed = hypotenuse(in.wind_x[i], in.wind_y[i]);
    const Outcome o = settle(i, landed[i], cover, value_or_zero(in.wind_shadow, i), speed, v, m);
    sand[i] = cover + o.stays;
    airborne[i] = o.bounces;
    if (!bare) wear(i, cover, o.bounces, speed, v, m, o.held);
    impacts.set(i, o.strength, o.loosened, v, in.moisture(i));
  }
};

/// Deposit of four cells beside each other in a bare desert, whose rows are multiples of four long.
struct DepositOfFour {
  Deposit<true> one;

  DESERT_HD Grid fours() const { return {one.in.grid.width / 4, one.in.grid.height, 1}; }
  DESERT_HD void operator()(int x, int y) const {
    const int first = one.in.grid.index(4 * x, y);
    const auto arriving = four_at(one.landed + first), cover = four_at(one.sand + first);
    const auto u = four_at(one.in.wind_x + first), v = four_at(one.in.wind_y + first);
    Four<float> shadow{}, angle;
    if (one.in.wind_shadow) shadow = four_at(one.in.wind_shadow + first);
    Four<Quanta> sand, airborne;
    for (int n = 0; n < 4; ++n) {
      const auto o = one.settle(first + n, arriving.values[n], cover.values[n], shadow.values[n],
                                hypotenuse(u.values[n], v.values[n]), 0.0f, 0.0f);
      sand.values[n] = cover.values[n] + o.stays;
      airborne.values[n] = o.bounces;
      angle.values[n] = one.impacts.angle.of(o.loosened, 0.0f, 0.0f);
      if (one.impacts.strength) one.impacts.strength[first + n] = o.strength;
    }
    put_four(one.sand + first, sand);
    put_four(one.airborne + first, airborne);
    put_four(one.impacts.angle.repose + first, angle);
  }
};

template <bool bare, class E>
void step_where(E& exec, const TerrainView& t, const SaltationParameters& p, const ReposeParameters& repose,
                float time_step, LedgerView ledger, Quanta* landed, const abrasion::Wear& wear,
                const reptation::Impacts& impacts, const wind_shadow::Shadow* shade) {
  const Inputs<bare> in(t, repose, time_step);
  Quanta *sand = t.quanta(Layer::sand), *airborne = t.quanta(Layer::airborne_sand);
  const LiftAndAdvect<bare> lift{in, p, time_step / t.grid.cell_size, sand, airborne, ledger};
  if (shade)
    for_each_cell_adding(exec, t.grid, landed, ShadeAndLift<bare>{*shade, lift});
  else
    for_each_cell_adding(exec, t.grid, landed, lift);
  if (!t.grid.periodic() && p.influx > 0.0f)
    for_each_cell(exec, t.grid, Influx<bare>{in, p.influx, landed, ledger});
  const Deposit<bare> deposit{in, p, wear, landed, sand, airborne, impacts};
  if constexpr (bare && !works_on_rows<E>)
    if (t.grid.width % 4 == 0) {
      const DepositOfFour four{deposit};
      return for_each_cell(exec, four.fours(), four);
    }
  for_each_cell(exec, t.grid, deposit);
}

/// `landed` (quanta): scratch memory of one value a cell. `shade`: what finds the wind's shadow first, or
/// null where it is there.
template <class E>
void step(E& exec, const TerrainView& t, const SaltationParameters& p, const AbrasionParameters& a,
          const ReposeParameters& repose, float time_step, LedgerView ledger, Quanta* landed,
          const reptation::Impacts& impacts, const wind_shadow::Shadow* shade) {
  const abrasion::Wear wear{a.rate * time_step,
                            take(a.cover, t.quanta_per_metre, wall_height),
                            t.quantum,
                            t.quanta_per_metre,
                            t.quanta(Layer::bedrock),
                            t.quanta(Layer::soil),
                            t.quanta(Layer::sand),
                            t.real(Layer::erosion_resistance),
                            ledger};
  if (is_bare(t, a))
    step_where<true>(exec, t, p, repose, time_step, ledger, landed, wear, impacts, shade);
  else
    step_where<false>(exec, t, p, repose, time_step, ledger, landed, wear, impacts, shade);
}

}  // namespace saltation
}  // namespace desert_sim
