#pragma once
/// The laws of continuum.hpp, cell by cell.

#include "kernels/backend/for_each.hpp"
#include "kernels/field/dice.hpp"
#include "kernels/sand/continuum.hpp"
#include "kernels/sand/continuum_shares.hpp"
#include "kernels/sand/saltation_inputs.hpp"
#include "kernels/wind/downwind.hpp"

namespace desert_sim::continuum {

/// Fields of the workspace, as laws take them.
struct SweepFields {
  float *lead, *decay, *gain, *level_gain;
  std::uint32_t* turn;
  Quanta *lying, *entering, *change, *out, *over_ends;

  explicit SweepFields(const Workspace& work)
      : lead(work.lead.data()),
        decay(work.decay.data()),
        gain(work.gain.data()),
        level_gain(work.level_gain.data()),
        turn(work.turn.data()),
        lying(work.lying.data()),
        entering(work.entering.data()),
        change(work.change.data()),
        out(work.out.data()),
        over_ends(work.over_ends.data()) {}
};

/// Where the stress leads from a cell to the next line [cells]; where there is none, where the wind does.
struct Lead {
  Grid grid;
  Downwind order;
  Drift drift;
  const float *wind_x, *wind_y;
  float* lead;

  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    const float u = wind_x[i], v = wind_y[i];
    lead[i] = u != 0.0f || v != 0.0f ? order.shift(u, v) : drift.shift;
  }
};

/// Cells at least so far from every edge are `inside` for the laws: nothing comes over an edge to them, and
/// nothing leaves over one.
constexpr int margin = 3;

/// What a cell would do with the sand that comes: everything about it that does not depend on its inflow.
/// `bare`: saltation::Inputs.
template <bool inside, bool bare>
struct Prepare {
  using Layers = saltation::Inputs<bare>;
  Layers in;
  Downwind order;
  Drift drift;
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

  DESERT_HD int sample(int x, int y) const {
    return inside ? in.grid.index(x, y) : sample_index(in.grid, x, y);
  }
  DESERT_HD float height(int x, int y) const { return heights[sample(x, y)]; }
  /// Mean slope from one cell to another, two cells further along an axis.
  DESERT_HD float slope(int from_x, int from_y, int to_x, int to_y) const {
    return 0.5f * (height(to_x, to_y) - height(from_x, from_y)) * slope_per_quantum;
  }
  /// Where the flux leads if it leads to `shift` on level ground and the ground rises by `rise` a cell across
  /// the stress, times √(Θ_t/Θ)/μ [cells a line].
  DESERT_HD static float downhill(float shift, float rise) {
    return (shift - rise) / maximum(1.0f + rise * shift, 0.1f);
  }
  /// Where the stress leads at the face to the place after (side = 1) or before (−1) of a cell, which it
  /// leads to `here`. It is a mean over what comes to the face and what is there: that of the cells alone
  /// would lie half a line too far downwind.
  DESERT_HD float at_face(int x, int y, float here, int side) const {
    const int d_x = drift.across_x, d_y = drift.across_y;
    const int up_x = x - drift.forward_x, up_y = y - drift.forward_y;
    const auto from_upwind = [&](int n) DESERT_INLINE {
      const int near = n - drift.cells, far = near - 1;
      return lerp(to.lead[sample(up_x + near * d_x, up_y + near * d_y)],
                  to.lead[sample(up_x + far * d_x, up_y + far * d_y)], drift.share_beyond);
    };
    const float beside = to.lead[sample(x + side * d_x, y + side * d_y)];
    return 0.25f * (here + beside + from_upwind(0) + from_upwind(side));
  }
  /// Where sand leads through the middle of a cell [cells a line], as far as it may be turned. Where it turns
  /// is a matter of the faces upwind, half a line before; the flux through the cell is not.
  DESERT_HD float through(float shift, float rise, float per_rise) const {
    const float there = downhill(shift, per_rise / sqrtf(1.0f + shift * shift) * rise);
    return clamp(there, drift.shift - 1.0f, drift.shift + 1.0f);
  }
  /// What turns off the way of the undisturbed wind, by the stress and, `per_rise` = √(Θ_t/Θ)/μ, by the fall
  /// of the ground across it, both at the faces between places: a ridge of one cell would have no slope
  /// otherwise. `slope_along`: from line to line.
  DESERT_HD Turn turn(int x, int y, float shift, float slope_along, float per_rise) const {
    const int d_x = drift.across_x, d_y = drift.across_y;
    const float here = height(x, y), along = shift * slope_along;
    const float rise_after = (height(x + d_x, y + d_y) - here) * slope_per_quantum - along,
                rise_before = (here - height(x - d_x, y - d_y)) * slope_per_quantum - along;
    const float across = per_rise / sqrtf(1.0f + shift * shift);
    const float after = at_face(x, y, shift, 1), before = at_face(x, y, shift, -1);
    return Turn::of(downhill(after, across * rise_after) - drift.shift,
                    drift.shift - downhill(before, across * rise_before));
  }

  DESERT_HD void operator()(int x, int y) const {
    const int i = in.grid.index(x, y), n = order.slot(x, y);
    const float u = in.wind_x[i], v = in.wind_y[i], speed = hypotenuse(u, v);
    const float per_speed = speed > 0.0f ? 1.0f / speed : 0.0f, e_x = u * per_speed, e_y = v * per_speed;
    const float slope_x = slope(x - 1, y, x + 1, y), slope_y = slope(x, y - 1, x, y + 1);
    const float rising = e_x * slope_x + e_y * slope_y;
    const float slope_along =
        static_cast<float>(drift.forward_x) * slope_x + static_cast<float>(drift.forward_y) * slope_y;
    const float dry = in.flooded(i) ? 0.0f : in.dryness(in.moisture(i));
    const float shields =
        maximum(flux.shields_per_wind_squared * speed * speed, 1e-20f) / (1.0f + plant_drag * in.plants(i));
    const float at_threshold = flux.threshold * maximum(1.0f + rising * per_friction, 0.0f);
    const float q = dry > 0.0f ? flux(shields, at_threshold / dry) : 0.0f;

    const float shift = to.lead[i], per_rise = sqrtf(flux.threshold / shields) * per_friction;
    const float to_the_fall = shields > flux.threshold ? per_rise : 0.0f;
    const float slope_across =
        static_cast<float>(drift.across_x) * slope_x + static_cast<float>(drift.across_y) * slope_y;
    const float across = through(shift, slope_across - shift * slope_along, to_the_fall),
                path = sqrtf(1.0f + across * across);  // through the cell [cells]
    const float decay = exp_negative(cells_per_length * path);
    set(i, n, decay, q * depth_per_flux * (1.0f - decay) / path);
    to.turn[n] = turn(x, y, shift, slope_along, to_the_fall).both;
    to.entering[n] = airborne[i] + over_edge(x, y, i);
    airborne[i] = 0;
  }

  DESERT_HD void set(int i, int n, float decay, float gain) const {
    const float echo = in.echo_value(i);
    const bool solid = in.solid(i);
    const bool eddy = echo < 0.0f;
    to.decay[n] = solid || eddy ? 1.0f : decay * (1.0f - maximum(echo, 0.0f));
    to.level_gain[n] = solid  ? 0.0f
                       : eddy ? -echo * time_in_quanta
                              : (echo > 0.0f ? in.sticky_lift : 1.0f) * gain;
    to.lying[n] = solid ? 0 : sand[i];
  }

  /// What the influx over open edges brings to a cell [quanta]: to the first line, and behind it to the cells
  /// at a side from which the wind blows in.
  DESERT_HD Quanta over_edge(int x, int y, int i) const {
    if (inside || !(influx > 0.0f)) return 0;
    const float shift = drift.shift, path = sqrtf(1.0f + shift * shift);
    float share = !order.periodic_along() && order.line_of(x, y) == 0 ? 1.0f : 0.0f;
    if (!order.periodic_across()) {
      const int place = order.place_of(x, y), from_side = shift > 0.0f ? place : order.length() - 1 - place;
      share = maximum(share, clamp(fabsf(shift) - static_cast<float>(from_side), 0.0f, 1.0f));
    }
    const Quanta wanted = influx_die.whole_at_most(share * influx * depth_per_flux / path, most_influx, i);
    const Quanta amount =
        with_room(wanted, static_cast<Quanta>(heights[i]));  // none into a cell that is full
    ledger.book_in(Material::sand, i, amount);
    return amount;
  }
};

/// From the middle of a cell to where e^(−(x_out − x)/L_sat) has its mean in it [cells].
DESERT_HD float place_of_mean(float cells_per_length) {
  const float square = cells_per_length * cells_per_length;
  if (cells_per_length < 0.5f) return cells_per_length * (1.0f - square * (1.0f / 60.0f)) * (1.0f / 12.0f);
  const float decay = exp_negative(cells_per_length);
  return 0.5f * (1.0f + decay) / lost_share(cells_per_length) - 1.0f / cells_per_length;
}

/// The gain of a cell along which the saturated flux is linear, from that of cells in which it is constant.
/// Where nothing is taken up, nothing is taken up of what neighbours have.
template <bool inside>
struct LinearGain {
  Grid lines;  ///< the places of a line are its columns, and lines its rows
  Drift drift;
  float ahead;  ///< place_of_mean(), on the way of the undisturbed wind [lines]
  const float *level_gain, *decay;
  float* gain;

  DESERT_HD float at(int place, int line) const {
    return level_gain[inside ? lines.index(place, line) : sample_index(lines, place, line)];
  }
  DESERT_HD void operator()(int place, int line) const {
    const int n = lines.index(place, line), near = drift.cells, far = near + 1;
    const float next = lerp(at(place + near, line + 1), at(place + far, line + 1), drift.share_beyond);
    const float before = lerp(at(place - near, line - 1), at(place - far, line - 1), drift.share_beyond);
    const float here = level_gain[n],
                linear = clamp(here + ahead * 0.5f * (next - before), 0.0f, 2.0f * here);
    gain[n] = here > 0.0f && decay[n] < 1.0f ? linear : here;
  }
};

/// A line of the sweep. A cell hands on its sand, and which part of it goes to the second place. First the
/// undisturbed wind carries what the cells of the line before hand on; then each place gives some of what
/// comes to its neighbours. The turn is taken where the sand arrives, because the ground there is what it
/// shapes: taken where it leaves, a line before, it would raise waves of four lines and less instead of
/// smoothing them. `inside`: the place is not an end of its line.
template <bool inside>
struct PassSand {
  static constexpr int words = words_handed_on, reach = reach_of_words;
  static constexpr bool completes = true;
  using Word = Quanta;
  struct Inflow {
    Quanta entering;
    Turn turn;
  };
  struct Loaded {
    float decay, gain;
    std::uint32_t die;
    Quanta lying;
    Inflow before, here, after;  ///< of the place before, of this one, of the one after
  };
  struct Result {
    Quanta change, out, to_before, to_after;
  };
  Downwind order;
  Drift drift;
  Die die;
  SweepFields fields;

  DESERT_HD bool around() const { return order.periodic_across(); }
  DESERT_HD Quanta beyond(int, Quanta) const { return 0; }
  DESERT_HD Quanta before_first(int, int) const { return 0; }
  DESERT_HD Loaded load(int line, int place) const {
    const int first = line * order.length(), n = first + place;
    return {fields.decay[n],         fields.gain[n],           die.word(n),
            fields.lying[n],         inflow(first, place - 1), inflow(first, place),
            inflow(first, place + 1)};
  }
  DESERT_HD Inflow inflow(int first, int place) const {
    const int within = inside ? place : order.place_within(place);
    if (!inside && within < 0) return {0, {0u}};
    return {fields.entering[first + within], {fields.turn[first + within]}};
  }
  template <class Before, class After>
  DESERT_HD Result pass(const Loaded& cell, const Before& before, const After& after) const {
    const int near = -drift.cells;
    // Numbers of their own, not an array or a choice: compilers vectorise the loops around.
    const Quanta far_passed = before(1, near - 1), near_passed = before(1, near);
    const Quanta come_before = cell.before.entering + before(0, near - 1) - far_passed + before(1, near - 2);
    const Quanta come = cell.here.entering + before(0, near) - near_passed + far_passed;
    const Quanta come_after = cell.after.entering + before(0, near + 1) - before(1, near + 1) + near_passed;
    const Quanta to_before = cell.here.turn.before(come), to_after = cell.here.turn.after(come);
    const Quanta turned_in = cell.before.turn.after(come_before) + cell.after.turn.before(come_after);
    const Quanta in = come - to_before - to_after + turned_in;
    const float wanted = static_cast<float>(in) * cell.decay + cell.gain;
    const Quanta out = Die::whole_at_most(wanted, in + cell.lying, cell.die);
    after(0) = out;
    return {in - out, out, to_before, to_after};
  }
  template <class Here>
  DESERT_HD void complete(const Here& here) const {
    here(1) = to_second(drift, here(0, -1), here(0, 0), here(0, 1));
  }
  DESERT_HD void store(int line, int place, const Result& result) const {
    const int n = line * order.length() + place;
    fields.change[n] = result.change;
    fields.out[n] = result.out;
    if (inside) return;
    if (place == 0) fields.over_ends[2 * line] = result.to_before;
    if (place == order.length() - 1) fields.over_ends[2 * line + 1] = result.to_after;
  }
};

/// Applies the changes, books what left the grid, lets the ground wear, and tells the flux.
template <bool inside, bool bare>
struct Settle {
  using Layers = saltation::Inputs<bare>;
  Layers in;
  Downwind order;
  Drift drift;
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
    sand[i] = before + change;
    if constexpr (!inside) {
      if (order.line_of(x, y) == 0 && order.periodic_along()) airborne[i] = over_seam(place);
      ledger.book_out(Material::sand, i, lost(order.line_of(x, y), place));
    }

    const float across = drift.shift + Turn{from.turn[n]}.mean();
    const float along = (static_cast<float>(out) + 0.5f * static_cast<float>(change)) * flux_per_quantum;
    const float q = along * sqrtf(1.0f + across * across);
    const float speed = hypotenuse(in.wind_x[i], in.wind_y[i]), plants = in.plants(i);
    const float over_a_metre = speed > 0.0f ? q / speed : 0.0f;
    if (impact_strength) impact_strength[i] = over_a_metre * (1.0f - plants);
    if (!bare && !in.solid(i) && !in.flooded(i)) {
      const float settled = change > 0 ? static_cast<float>(change) / static_cast<float>(change + out) : 0.0f;
      abrade(i, before, over_a_metre * in.quanta_per_metre, speed, plants, in.moisture(i), settled);
    }
    if (!flux_x) return;
    const wind::Vector parts = order.parts(along * share_of_time, along * share_of_time * across);
    flux_x[i] += parts.x;
    flux_y[i] += parts.y;
  }

  /// What a place of a line hands on; nothing beyond an open end.
  DESERT_HD Quanta out(int line, int place) const {
    const int within = order.place_within(place);
    return within < 0 ? 0 : from.out[line * order.length() + within];
  }
  DESERT_HD Quanta second(int line, int place) const {
    return to_second(drift, out(line, place - 1), out(line, place), out(line, place + 1));
  }
  /// What the last line hands on to a place of the first.
  DESERT_HD Quanta over_seam(int place) const {
    const int last = order.lines() - 1, near = place - drift.cells;
    return out(last, near) - second(last, near) + second(last, near - 1);
  }
  /// What goes over an open edge: with the wind from the cell to the next line, and to the side within its
  /// line.
  DESERT_HD Quanta lost(int line, int place) const {
    const Quanta all = out(line, place);
    const bool no_next_line = line == order.lines() - 1 && !order.periodic_along();
    Quanta sum = no_next_line ? all : 0;
    if (order.periodic_across()) return sum;
    const Quanta far = second(line, place);
    if (!no_next_line) {
      sum += order.place_within(place + drift.cells) < 0 ? all - far : 0;
      sum += order.place_within(place + drift.cells + 1) < 0 ? far : 0;
    }
    sum += place == 0 ? from.over_ends[2 * line] : 0;
    sum += place == order.length() - 1 ? from.over_ends[2 * line + 1] : 0;
    return sum;
  }
};

}  // namespace desert_sim::continuum
