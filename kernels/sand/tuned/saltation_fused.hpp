#pragma once
/// GPU forms of the laws of saltation_laws.hpp, with bit-identical results: a lift that computes the wind
/// shadow in the same pass, and a deposit of four cells at a time.

#include "kernels/backend/vec4.hpp"
#include "kernels/sand/saltation_laws.hpp"
#include "kernels/wind/wind_shadow_march.hpp"

namespace desert_sim::saltation {

/// LiftAndAdvect that computes the cell's wind shadow in the same pass.
template <bool bare>
struct ShadowAndLift {
  static constexpr bool compact_warps = true;
  template <int count>
  using Parcels = BilinearParcels<count>;
  wind_shadow::Shadow shadow_law;
  LiftAndAdvect<bare> lift;

  template <int count>
  DESERT_HD void prepare(int x, int y, BilinearParcels<count>& parcels, int n) const {
    auto cell = lift.read(x, y, 0.0f);  // these loads overlap with the march of the wind shadow
    cell.shadow = shadow_law(x, y);
    lift.prepare(x, y, cell, parcels, n);
  }
  template <int count, class Add>
  DESERT_HD void deliver(int x, int y, const BilinearParcels<count>& parcels, int n, const Add& add) const {
    lift.deliver(x, y, parcels, n, add);
  }
};

/// Landing::at() of four adjacent cells of a row; the grid's width and the first x must be multiples of four.
/// The cells share their loads and their shares. Edges take no way of their own: on small grids it would be
/// every other warp's.
DESERT_HD Vec4<Quanta> land_on_four(const Landing& landing, int x, int y) {
  const Grid& g = landing.grid;
  const bool west = g.periodic_x || x > 0, east = g.periodic_x || x + 4 < g.width;
  const bool there[3] = {g.periodic_y || y > 0, true, g.periodic_y || y + 1 < g.height};
  const int before = wrap_once(x - 1, g.width), behind = wrap_once(x + 4, g.width);
  Quanta row[3][6];  // 0 beyond an open edge
  for (int r = 0; r < 3; ++r) {
    const int to_y = wrap_once(y + r - 1, g.height);
    Vec4<Quanta> four{};
    if (there[r]) four = load_vec4(landing.landed + g.index(x, to_y));
    row[r][0] = there[r] && west ? landing.landed[g.index(before, to_y)] : 0;
    for (int n = 0; n < 4; ++n) row[r][n + 1] = four.values[n];
    row[r][5] = there[r] && east ? landing.landed[g.index(behind, to_y)] : 0;
  }
  const auto side = [&](int r, int n) { return Landing::part(row[r][n], landing.to_side); };
  const auto corner = [&](int r, int n) { return Landing::part(row[r][n], landing.to_corner); };
  const int rows = there[0] + there[2];  // beside the cells' own
  Vec4<Quanta> arriving;
  for (int n = 1; n < 5; ++n) {
    const int columns = (n > 1 || west) + (n < 4 || east);
    arriving.values[n - 1] = row[1][n] - (rows + columns) * side(1, n) - rows * columns * corner(1, n) +
                             side(0, n) + side(2, n) + side(1, n - 1) + side(1, n + 1) + corner(0, n - 1) +
                             corner(0, n + 1) + corner(2, n - 1) + corner(2, n + 1);
  }
  return arriving;
}

/// Deposit of four adjacent cells of a row in a bare desert; the grid's width must be a multiple of four.
struct DepositOfFour {
  Deposit<true> deposit;

  DESERT_HD Grid fours() const { return {deposit.in.grid.width / 4, deposit.in.grid.height, 1}; }
  DESERT_HD void operator()(int x, int y) const {
    const int first = deposit.in.grid.index(4 * x, y);
    const auto lying = load_vec4(deposit.sand + first);
    const auto u = load_vec4(deposit.in.wind_x + first), v = load_vec4(deposit.in.wind_y + first);
    Vec4<float> shadow{}, angle;
    if (deposit.in.wind_shadow) shadow = load_vec4(deposit.in.wind_shadow + first);
    Vec4<Quanta> waiting{}, sand, airborne;
    if (deposit.in.hop_share < 1.0f) waiting = load_vec4(deposit.airborne + first);
    const Vec4<Quanta> arriving = land_on_four(deposit.landing, 4 * x, y);
    for (int n = 0; n < 4; ++n) {
      const Quanta cover = deposit.covering(first + n, lying.values[n], u.values[n], v.values[n],
                                            shadow.values[n], 0.0f, 0.0f);
      const auto o = deposit.split_landed(first + n, arriving.values[n], cover, shadow.values[n],
                                          hypotenuse(u.values[n], v.values[n]), 0.0f, 0.0f);
      sand.values[n] = lying.values[n] + o.stays;
      airborne.values[n] = waiting.values[n] + o.bounces;
      angle.values[n] = deposit.impacts.angle.tangent_at(o.lowered_tangent, 0.0f, 0.0f);
      if (deposit.impacts.strength) deposit.impacts.strength[first + n] = o.strength;
    }
    store_vec4(deposit.sand + first, sand);
    store_vec4(deposit.airborne + first, airborne);
    store_vec4(deposit.impacts.angle.repose + first, angle);
  }
};

}  // namespace desert_sim::saltation
