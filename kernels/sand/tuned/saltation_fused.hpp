#pragma once
/// Forms of saltation's laws for the GPU, with the bits of saltation_laws.hpp: the lift that finds the wind's shadow
/// in passing, and the deposit of four cells at a time.

#include "kernels/backend/vec4.hpp"
#include "kernels/sand/saltation_laws.hpp"
#include "kernels/wind/wind_shadow_march.hpp"

namespace desert_sim::saltation {

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

}  // namespace desert_sim::saltation
