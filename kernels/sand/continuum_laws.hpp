#pragma once
/// The laws of continuum.hpp, cell by cell.

#include "kernels/backend/for_each.hpp"
#include "kernels/field/dice.hpp"
#include "kernels/sand/continuum.hpp"
#include "kernels/sand/saltation_inputs.hpp"
#include "kernels/wind/downwind.hpp"

namespace desert_sim::continuum {

using wind::Downwind;

/// Fields of the workspace, as laws take them.
struct SweepFields {
  float *decay, *gain;
  int* shift;
  std::uint32_t* sides;
  Quanta *lying, *entering, *change, *out;

  explicit SweepFields(const Workspace& work)
      : decay(work.decay.data()),
        gain(work.gain.data()),
        shift(work.shift.data()),
        sides(work.sides.data()),
        lying(work.lying.data()),
        entering(work.entering.data()),
        change(work.change.data()),
        out(work.out.data()) {}
};

/// Cells a line by which the fall of the ground turns the flux.
DESERT_HD float turned(std::uint32_t sides) {
  return (static_cast<float>(sides & 65535u) - static_cast<float>(sides >> 16)) / 65536.0f;
}

/// What a cell would do with the sand that comes: everything about it that does not depend on its inflow.
struct Prepare {
  using Layers = saltation::Inputs<false>;
  Layers in;
  Downwind order;
  SaturatedFlux flux;
  float plant_drag, per_friction;  ///< Γ, 1/μ
  float cells_per_length;          ///< l/L_sat
  float depth_per_flux;            ///< Δt/l in quanta [quanta s/m²]
  float time_in_quanta;            ///< Δt [quanta s/m]
  float slope_per_quantum;         ///< of a difference of two neighbours' heights [1]
  float influx;                    ///< [m²/s]
  Die influx_die;
  LedgerView ledger;
  const float* heights;
  const Quanta* sand;
  Quanta* airborne;
  SweepFields to;

  DESERT_HD float height(int x, int y) const { return heights[sample_index(in.grid, x, y)]; }
  /// Mean slope from one cell to another, two cells further along an axis.
  DESERT_HD float slope(int from_x, int from_y, int to_x, int to_y) const {
    return 0.5f * (height(to_x, to_y) - height(from_x, from_y)) * slope_per_quantum;
  }
  /// Shares that go to the two sides of where the stress leads, in proportion to the fall to each across the
  /// stress. Differences along the line are one-sided: a ridge of one cell would have no slope otherwise.
  DESERT_HD std::uint32_t downhill(int x, int y, float shift, float turn) const {
    const int d_x = order.along_x ? 0 : 1, d_y = 1 - d_x, forward = order.backward ? -1 : 1;
    const int a_x = d_y * forward, a_y = d_x * forward;
    const float here = height(x, y), along = slope(x - a_x, y - a_y, x + a_x, y + a_y);
    const float to_right = (height(x + d_x, y + d_y) - here) * slope_per_quantum,
                to_left = (here - height(x - d_x, y - d_y)) * slope_per_quantum;
    const float right = clamp(-turn * (to_right - shift * along), 0.0f, 0.5f);
    const float left = clamp(turn * (to_left - shift * along), 0.0f, 0.5f);
    return static_cast<std::uint32_t>(left * 65536.0f) << 16 | static_cast<std::uint32_t>(right * 65536.0f);
  }

  DESERT_HD void operator()(int x, int y) const {
    const int i = in.grid.index(x, y), n = order.slot(x, y);
    const float u = in.wind_x[i], v = in.wind_y[i], speed = hypotenuse(u, v);
    const float per_speed = speed > 0.0f ? 1.0f / speed : 0.0f, e_x = u * per_speed, e_y = v * per_speed;
    const float rising = e_x * slope(x - 1, y, x + 1, y) + e_y * slope(x, y - 1, x, y + 1);
    const float dry = in.flooded(i) ? 0.0f : saltation::dryness(in.moisture(i));
    const float shields =
        maximum(flux.shields_per_wind_squared * speed * speed, 1e-20f) / (1.0f + plant_drag * in.plants(i));
    const float at_threshold = flux.threshold * maximum(1.0f + rising * per_friction, 0.0f);
    const float q = dry > 0.0f ? flux(shields, at_threshold / dry) : 0.0f;

    const float shift = order.shift(u, v), turn = sqrtf(flux.threshold / shields) * per_friction;
    const std::uint32_t sides =
        shields > flux.threshold ? downhill(x, y, shift, turn * sqrtf(1.0f + shift * shift)) : 0u;
    const float across = shift + turned(sides),
                path = sqrtf(1.0f + across * across);  // through the cell [cells]
    const float decay = exp_negative(cells_per_length * path);
    set(i, n, decay, q * depth_per_flux * (1.0f - decay) / path, shift);
    to.sides[n] = sides;
    to.entering[n] = airborne[i] + over_edge(x, y, i, shift, sqrtf(1.0f + shift * shift));
    airborne[i] = 0;
  }

  DESERT_HD void set(int i, int n, float decay, float gain, float shift) const {
    const float echo = in.echo_value(i);
    const bool solid = in.solid(i);
    const bool eddy = echo < 0.0f;
    to.decay[n] = solid || eddy ? 1.0f : decay * (1.0f - maximum(echo, 0.0f));
    to.gain[n] = solid ? 0.0f : eddy ? -echo * time_in_quanta : (echo > 0.0f ? 0.5f : 1.0f) * gain;
    to.shift[n] = to_fixed_point(shift);
    to.lying[n] = solid ? 0 : sand[i];
  }

  /// What the influx over open edges brings to a cell [quanta]: to the first line, and to the cells at a side
  /// from which the wind blows in.
  DESERT_HD Quanta over_edge(int x, int y, int i, float shift, float path) const {
    if (!(influx > 0.0f)) return 0;
    float share = !order.periodic_along() && order.line_of(x, y) == 0 ? 1.0f : 0.0f;
    if (!order.periodic_across()) {
      const int place = order.place_of(x, y), from_side = shift > 0.0f ? place : order.length() - 1 - place;
      share += clamp(fabsf(shift) - static_cast<float>(from_side), 0.0f, 1.0f);
    }
    const Quanta amount = influx_die.whole_at_most(share * influx * depth_per_flux / path, wall_height, i);
    ledger.book_in(Material::sand, i, amount);
    return amount;
  }
};

/// What a cell hands on to the next line: amounts for the places from `reach` to the one side of its own to as
/// many to the other. Where the stress leads lies between two of them, and so do the places beside it to which
/// sand is turned.
struct HandedOn {
  static constexpr int reach = 3, places = 2 * reach + 1;
  Quanta amount[places];

  DESERT_HD HandedOn(Quanta all, int shift, std::uint32_t sides) {
    const std::uint32_t beyond = static_cast<std::uint32_t>(shift) << 16;
    const Quanta left = share(all, sides & 0xffff0000u), right = share(all, sides << 16),
                 middle = all - left - right;
    const Quanta left_beyond = share(left, beyond), middle_beyond = share(middle, beyond),
                 right_beyond = share(right, beyond);
    const Quanta parts[] = {left - left_beyond, left_beyond + middle - middle_beyond,
                            middle_beyond + right - right_beyond, right_beyond, 0};
    // The first part goes to place (shift >> 16) − 1, which is −3 … 0 places from the cell's own.
    const int first = (shift >> 16) + reach - 1;
    const bool by_one = first & 1, by_two = first & 2;
    Quanta moved[places];
    for (int k = 0; k < places; ++k) {
      const Quanta as_it_is = k < 5 ? parts[k] : 0, from_before = k > 0 && k < 6 ? parts[k - 1] : 0;
      moved[k] = by_one ? from_before : as_it_is;
    }
    for (int k = 0; k < places; ++k) {
      const Quanta from_before = k > 1 ? moved[k - 2] : 0;
      amount[k] = by_two ? from_before : moved[k];
    }
  }
  /// parts/2³² of an amount that is not negative, rounded down.
  DESERT_HD static Quanta share(Quanta of, std::uint32_t parts) {
    return static_cast<Quanta>(multiply_high(static_cast<std::uint32_t>(of), parts));
  }
};

struct PassSand {
  static constexpr int words = HandedOn::places, reach = HandedOn::reach;
  using Word = Quanta;
  struct Loaded {
    float decay, gain;
    int shift;
    std::uint32_t sides, die;
    Quanta lying, entering;
  };
  struct Result {
    Quanta change, out;
  };
  Downwind order;
  Die die;
  SweepFields fields;

  DESERT_HD bool around() const { return order.periodic_across(); }
  DESERT_HD Quanta beyond(int, Quanta) const { return 0; }
  DESERT_HD Quanta before_first(int, int) const { return 0; }
  DESERT_HD Loaded load(int line, int place) const {
    const int n = line * order.length() + place;
    return {fields.decay[n], fields.gain[n],  fields.shift[n],   fields.sides[n],
            die.word(n),     fields.lying[n], fields.entering[n]};
  }
  template <class Words>
  DESERT_HD Result pass(const Loaded& cell, const Words& before, const Words& after) const {
    Quanta in = cell.entering;
    unrolled<words>([&](auto w) DESERT_INLINE { in += before(w, reach - w); });
    const float wanted = static_cast<float>(in) * cell.decay + cell.gain;
    const Quanta out = Die::whole_at_most(wanted, in + cell.lying, cell.die);
    const HandedOn handed(out, cell.shift, cell.sides);
    unrolled<words>([&](auto w) DESERT_INLINE { after(w) = handed.amount[w]; });
    return {in - out, out};
  }
  DESERT_HD void store(int line, int place, const Result& result) const {
    const int n = line * order.length() + place;
    fields.change[n] = result.change;
    fields.out[n] = result.out;
  }
};

/// Applies the changes, books what left the grid, lets the ground wear, and tells the flux.
struct Settle {
  using Layers = saltation::Inputs<false>;
  Layers in;
  Downwind order;
  SweepFields from;
  abrasion::Abrade abrade;
  LedgerView ledger;
  Quanta *sand, *airborne;
  float flux_per_quantum;  ///< flux of a quantum that a cell hands on [m²/s]
  float share_of_time;     ///< of this step in that over which flux_x and flux_y are a mean
  float *flux_x, *flux_y, *impact_strength;

  DESERT_HD void operator()(int x, int y) const {
    const int i = in.grid.index(x, y), n = order.slot(x, y), place = order.place_of(x, y);
    const Quanta change = from.change[n], out = from.out[n], before = sand[i];
    const int shift = from.shift[n];
    sand[i] = before + change;
    if (order.line_of(x, y) == 0 && order.periodic_along()) airborne[i] = over_seam(place);
    ledger.book_out(Material::sand, i, lost(n, order.line_of(x, y), place));

    const float across = static_cast<float>(shift) / 65536.0f + turned(from.sides[n]);
    const float along = (static_cast<float>(out) + 0.5f * static_cast<float>(change)) * flux_per_quantum;
    const float q = along * sqrtf(1.0f + across * across);
    const float speed = hypotenuse(in.wind_x[i], in.wind_y[i]), plants = in.plants(i);
    const float over_a_metre = speed > 0.0f ? q / speed : 0.0f;
    if (impact_strength) impact_strength[i] = over_a_metre * (1.0f - plants);
    if (!in.solid(i) && !in.flooded(i)) {
      const float settled = change > 0 ? static_cast<float>(change) / static_cast<float>(change + out) : 0.0f;
      abrade(i, before, over_a_metre * in.quanta_per_metre, speed, plants, in.moisture(i), settled);
    }
    if (!flux_x) return;
    const wind::Vector parts = order.parts(along * share_of_time, along * share_of_time * across);
    flux_x[i] += parts.x;
    flux_y[i] += parts.y;
  }

  DESERT_HD HandedOn handed_on(int n) const { return {from.out[n], from.shift[n], from.sides[n]}; }
  /// What the last line hands on to a place of the first.
  DESERT_HD Quanta over_seam(int place) const {
    const int last = (order.lines() - 1) * order.length();
    Quanta sum = 0;
    unrolled<HandedOn::places>([&](auto k) DESERT_INLINE {
      const int other = order.place_within(place + HandedOn::reach - k);
      if (other >= 0) sum += handed_on(last + other).amount[k];
    });
    return sum;
  }
  /// What a cell hands on over an open edge.
  DESERT_HD Quanta lost(int n, int line, int place) const {
    if (line == order.lines() - 1 && !order.periodic_along()) return from.out[n];
    if (order.periodic_across()) return 0;
    const HandedOn handed = handed_on(n);
    Quanta sum = 0;
    for (int k = 0; k < HandedOn::places; ++k)
      sum += order.place_within(place + k - HandedOn::reach) < 0 ? handed.amount[k] : 0;
    return sum;
  }
};

}  // namespace desert_sim::continuum
