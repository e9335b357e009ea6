#pragma once
/// The stacks of slab_model.hpp, and how slabs and holes roll over their slopes.

#include "kernels/backend/for_each.hpp"
#include "kernels/field/random.hpp"
#include "kernels/slabs/colours.hpp"
#include "kernels/wind/downwind.hpp"

namespace desert_sim::slabs {

using wind::Downwind;

/// The lattice of stacks, by line and place downwind. Of a line, places with the same remainder by four lie
/// beside each other, so that cells of a colour do.
struct Lattice {
  Downwind order;
  int shift;      ///< of the wind [cells a line; 16.16 fixed point]
  Quanta slab;    ///< [quanta]
  Quanta repose;  ///< steepest difference of neighbours at rest [quanta]
  Quanta* height;
  const Quanta* base;       ///< what slabs lie on; none can be taken from below it
  Quanta* shade;            ///< height of the shadow
  std::uint8_t* state;      ///< has_slab_bit and shaded_bit, which follow from the three
  std::uint32_t* pending;   ///< slabs that have come and do not rest yet, and holes · 2¹⁶ that do not yet
  int quarter, pitch;       ///< from a place to the next but three, and from a line to the next [words]
  const float* resistance;  ///< R of a cell to the wind, by plants or as packed snow; null: 0 everywhere
  float held_from;          ///< R from which the slope may be steeper
  Quanta held_repose;       ///< steepest difference there [quanta]

  static constexpr std::uint32_t one_slab = 1, one_hole = 1u << 16;
  static constexpr std::uint8_t has_slab_bit = 1, shaded_bit = 2;

  static int quarter_of(int length) { return (length + 3) / 4; }
  /// Words of a field.
  static std::size_t words(int lines, int length) {
    return static_cast<std::size_t>(lines) * static_cast<std::size_t>(4 * quarter_of(length));
  }
  /// How far to the side the wind's way from line 0 has come at a line [cells].
  DESERT_HD int offset(int line) const {
    return static_cast<int>((static_cast<long long>(line) * shift + fixed_point_one / 2) >> 16);
  }
  /// Of a cell of the grid.
  DESERT_HD int slot(int line, int place) const {
    return line * pitch + (place & 3) * quarter + (place >> 2);
  }
  /// Of a slot of line 0.
  DESERT_HD int place_of_slot(int n) const {
    const int residue = (n >= quarter) + (n >= 2 * quarter) + (n >= 3 * quarter);
    return residue + 4 * (n - residue * quarter);
  }
  DESERT_HD int slot_of(int x, int y) const { return slot(order.line_of(x, y), order.place_of(x, y)); }
  /// Of a cell that may lie beyond the edges; −1 beyond an open one.
  DESERT_HD int slot_within(int line, int place) const {
    const int lines = order.lines(), length = order.length();
    const int l = order.periodic_along() ? wrap(line, lines) : line;
    const int p = order.periodic_across() ? wrap(place, length) : place;
    const bool within = static_cast<unsigned>(l) < static_cast<unsigned>(lines) &&
                        static_cast<unsigned>(p) < static_cast<unsigned>(length);
    return within ? slot(l, p) : -1;
  }
  DESERT_HD bool has_slab(int n) const { return (state[n] & has_slab_bit) != 0; }
  DESERT_HD bool is_shaded(int n) const { return (state[n] & shaded_bit) != 0; }
  /// Steepest difference at rest to a lower neighbour of this cell, where there is resistance.
  DESERT_HD Quanta repose_of(int n) const { return resistance[n] >= held_from ? held_repose : repose; }
  /// Whether a slab that is polled stays, with probability 1 − p_e, p_e = 1 − R in [0, 1].
  DESERT_HD bool withstands(int n, std::uint32_t word) const { return unit_from(word) < resistance[n]; }
  /// Whether a slab that lands stays, with probability p_d = p + R (1 − p) in [0, 1]; p in 2⁻³².
  DESERT_HD bool keeps(int n, std::uint32_t p, std::uint32_t word) const {
    const float bare = static_cast<float>(p) * (1.0f / 4294967296.0f);
    return unit_from(word) < bare + resistance[n] * (1.0f - bare);
  }
  /// Whether there is a slab but those that holes will take.
  DESERT_HD bool can_give(int n) const {
    const std::uint32_t holes = pending[n] >> 16;
    return holes == 0 ? has_slab(n) : height[n] - base[n] >= static_cast<Quanta>(holes + 1) * slab;
  }
  DESERT_HD void set_state(int n, Quanta height_here, Quanta shade_here) const {
    const int slab_there = height_here - base[n] >= slab, shaded = height_here < shade_here;
    state[n] = static_cast<std::uint8_t>(slab_there | (shaded << 1));
  }
  /// Puts a slab on a cell, which may rise out of the shadow.
  DESERT_HD void add(int n) const {
    const Quanta now = height[n] + slab;
    height[n] = now;
    const bool shaded = is_shaded(n) && now < shade[n];
    state[n] = shaded ? has_slab_bit | shaded_bit : has_slab_bit;
  }
  /// Takes one from it.
  DESERT_HD void remove(int n) const {
    const Quanta now = height[n] - slab;
    height[n] = now;
    const bool shaded = is_shaded(n) || now < shade[n];
    state[n] =
        static_cast<std::uint8_t>((now - base[n] >= slab ? has_slab_bit : 0) | (shaded ? shaded_bit : 0));
  }
};

/// The cells of a run. `inside`: away from the edges of the grid, so that their neighbours lie equally far
/// from all of them in memory. `resisting`: there is resistance, so that the repose is that of a cell.
template <bool inside, bool resisting>
struct Rolling {
  Lattice lattice;
  Run run;
  int first;         ///< slot of the first cell
  int neighbour[4];  ///< downwind, to one side, to the other, upwind [slots from a cell; if inside]
  bool odd;          ///< cells of a chessboard prefer either side

  DESERT_HD Rolling(const Lattice& of, const Run& cells)
      : lattice(of),
        run(cells),
        first(of.slot(cells.line, cells.place)),
        odd(((cells.line ^ cells.place) & 1) != 0) {
    const int here = run.place & 3, last_jump = 1 - 3 * of.quarter;
    const int left = here == 3 ? last_jump : of.quarter, right = here == 0 ? -last_jump : -of.quarter;
    neighbour[0] = of.pitch;
    neighbour[1] = odd ? right : left;
    neighbour[2] = odd ? left : right;
    neighbour[3] = -of.pitch;
  }
  /// Slot of a neighbour of the nth cell; −1 beyond an open edge.
  DESERT_HD int beside(int n, int k) const {
    if (inside) return first + n + neighbour[k];
    const int side = k == 1 ? 1 : k == 2 ? -1 : 0, along = k == 0 ? 1 : k == 3 ? -1 : 0;
    return lattice.slot_within(run.line + along, run.place + 4 * n + (odd ? -side : side));
  }
  /// The neighbour to which the slope is steepest of those that are too steep: downhill, or uphill to one
  /// that can give a slab. Of equal ones the first downwind, or uphill the first upwind. −1 if there is none.
  template <bool uphill>
  DESERT_HD int steepest(int n) const {
    const int found = steepest_to<uphill>(n, [](int) DESERT_INLINE { return true; });
    if (!uphill || found < 0 || lattice.can_give(found)) return found;
    return steepest_to<uphill>(n, [this](int there) DESERT_INLINE { return lattice.can_give(there); });
  }
  /// All that is pending at the nth cell comes to rest, or rolls a cell further.
  DESERT_HD void settle(int n) const {
    const int at = first + n;
    std::uint32_t left = lattice.pending[at];
    lattice.pending[at] = left & ~(Lattice::one_hole - 1u);
    for (; (left & (Lattice::one_hole - 1u)) != 0; left -= Lattice::one_slab) {
      const int to = steepest<false>(n);
      if (to < 0)
        lattice.add(at);
      else
        lattice.pending[to] += Lattice::one_slab;
    }
    for (; left != 0; left -= Lattice::one_hole) {
      lattice.pending[at] = left - Lattice::one_hole;
      make_hole(n);
    }
  }
  /// Takes a slab from the nth cell, or makes what is too steep above it roll into the hole.
  DESERT_HD void make_hole(int n) const {
    const int above = steepest<true>(n);
    if (above < 0)
      lattice.remove(first + n);
    else
      lattice.pending[above] += Lattice::one_hole;
  }
  /// Bit n: whether something is pending at the nth cell.
  DESERT_HD std::uint32_t pending() const {
    const std::uint32_t* const from = lattice.pending + first;
    std::uint32_t bits = 0;
    if (run.count == Colours::longest_run) {
#if !defined(__CUDACC__)
#pragma omp simd reduction(| : bits)
#endif
      for (int n = 0; n < Colours::longest_run; ++n) bits |= from[n] != 0 ? 1u << n : 0u;
    } else {
      for (int n = 0; n < run.count; ++n) bits |= from[n] != 0 ? 1u << n : 0u;
    }
    return bits;
  }
  DESERT_HD void settle() const {
    for (std::uint32_t left = pending(); left != 0; left &= left - 1u) settle(lowest_bit(left));
  }

 private:
  template <bool uphill, class Counts>
  DESERT_HD int steepest_to(int n, const Counts& counts) const {
    const Quanta here = lattice.height[first + n];
    Quanta most = resisting ? 0 : lattice.repose;
    int found = -1;
    unrolled<4>([&](auto k) DESERT_INLINE {
      const int there = beside(n, uphill ? 3 - k : k);
      if (!inside && there < 0) return;
      const Quanta other = lattice.height[there], slope = uphill ? other - here : here - other;
      const bool is_loose = !resisting || slope > lattice.repose_of(uphill ? there : first + n);
      const bool is_steeper = slope > most && is_loose && counts(there);
      most = is_steeper ? slope : most;
      found = is_steeper ? there : found;
    });
    return found;
  }
};

/// Calls work(rolling) with what suits the run.
template <class Work>
DESERT_HD void with_rolling(const Lattice& lattice, const Run& run, const Work& work) {
  const bool inside = run.line > 0 && run.place > 0 && run.line < lattice.order.lines() - 1 &&
                      run.place + 4 * (run.count - 1) < lattice.order.length() - 1;
  if (lattice.resistance != nullptr) {
    if (inside)
      work(Rolling<true, true>(lattice, run));
    else
      work(Rolling<false, true>(lattice, run));
  } else if (inside) {
    work(Rolling<true, false>(lattice, run));
  } else {
    work(Rolling<false, false>(lattice, run));
  }
}

/// What is pending at the cells of a colour.
struct Settle {
  static constexpr int cells_of_a_call = Colours::longest_run;
  Lattice lattice;
  Colours colours;
  int colour;

  DESERT_HD void operator()(int column, int row) const {
    const Run run = colours.run(colour, column, row);
    if (run.count > 0)
      with_rolling(lattice, run, [](const auto& rolling) DESERT_INLINE { rolling.settle(); });
  }
};

}  // namespace desert_sim::slabs
