#pragma once
/// The stacks of slab_model.hpp, and how slabs and holes roll over their slopes.

#include "kernels/backend/for_each.hpp"
#include "kernels/slabs/blocks.hpp"
#include "kernels/wind/downwind.hpp"

namespace desert_sim::slabs {

using wind::Downwind;

/// The lattice of stacks, by line and place downwind.
struct Lattice {
  Downwind order;
  int shift;      ///< of the wind [cells a line; 16.16 fixed point]
  Quanta slab;    ///< [quanta]
  Quanta repose;  ///< steepest difference of neighbours at rest [quanta]
  Quanta *height, *sand, *shade;
  std::uint32_t* arriving;

  static constexpr std::uint32_t one_slab = 1, one_hole = 1u << 16;

  /// How far to the side the wind's way from line 0 has come at a line [cells].
  DESERT_HD int offset(int line) const {
    return static_cast<int>((static_cast<long long>(line) * shift + fixed_point_one / 2) >> 16);
  }
  /// Of a cell at most a round beyond the edges; −1 beyond an open one.
  DESERT_HD int slot(int line, int place) const {
    const int lines = order.lines(), length = order.length();
    const int l = order.periodic_along() ? wrap(line, lines) : line;
    const int p = order.periodic_across() ? wrap(place, length) : place;
    const bool within = static_cast<unsigned>(l) < static_cast<unsigned>(lines) &&
                        static_cast<unsigned>(p) < static_cast<unsigned>(length);
    return within ? l * length + p : -1;
  }
  DESERT_HD bool has_slab(int n) const { return sand[n] >= slab; }
  DESERT_HD void add(int n, int slabs) const {
    sand[n] += slabs * slab;
    height[n] += slabs * slab;
  }
};

/// The neighbours in the order in which equal slopes are taken: downwind first (where `against`: upwind),
/// then the sides, the one or the other first.
struct Neighbour {
  int line, place;

  DESERT_HD static Neighbour of(int k, bool against, bool other_side) {
    const int forward = against ? -1 : 1, side = other_side ? -1 : 1;
    return {k == 0 ? forward : k == 3 ? -forward : 0, k == 1 ? side : k == 2 ? -side : 0};
  }
};

/// What rolls over the slopes in and around a block. `inside`: that lies so far from the edges that all cells
/// that are read lie in the same row of memory as on the lattice.
template <bool inside>
struct Rolling {
  static constexpr bool is_inside = inside;
  const Lattice& lattice;
  const Block& block;
  /// Slabs roll by themselves so far beyond their block.
  static constexpr int reach = 3;
  static_assert(2 * (reach + 1) <= least_side, "blocks of a colour neither write nor read the same cells");

  struct Cell {
    int line, place, slot;
  };

  DESERT_HD Cell cell(int line, int place) const {
    return {line, place, inside ? line * lattice.order.length() + place : lattice.slot(line, place)};
  }
  /// The neighbour to which the slope is steepest of those that are too steep: downhill, or uphill to one
  /// that has a slab. The cell itself if there is none.
  template <bool uphill>
  DESERT_HD Cell steepest(Cell from) const {
    const Quanta here = lattice.height[from.slot];
    Quanta most = lattice.repose;
    int found = -1;
    const bool other_side = ((from.line ^ from.place) & 1) != 0;
    unrolled<4>([&](auto k) DESERT_INLINE {
      const Neighbour n = Neighbour::of(k, uphill, other_side);
      const int there = cell(from.line + n.line, from.place + n.place).slot;
      if (!inside && there < 0) return;
      const Quanta other = lattice.height[there], slope = uphill ? other - here : here - other;
      if (slope <= most || (uphill && !lattice.has_slab(there))) return;
      most = slope;
      found = k;
    });
    if (found < 0) return from;
    const Neighbour n = Neighbour::of(found, uphill, other_side);
    return cell(from.line + n.line, from.place + n.place);
  }

  /// Puts a slab down.
  DESERT_HD void put(Cell at) const {
    for (;;) {
      const Cell next = steepest<false>(at);
      if (next.slot == at.slot) return lattice.add(at.slot, 1);
      if (block.beyond(next.line, next.place) > reach) {
        atomic_add(&lattice.arriving[next.slot], Lattice::one_slab);
        return;
      }
      at = next;
    }
  }
  /// Takes a slab from a cell that has one.
  DESERT_HD void take(Cell at) const {
    for (;;) {
      const Cell next = steepest<true>(at);
      if (next.slot == at.slot) return lattice.add(at.slot, -1);
      if (block.beyond(next.line, next.place) > reach) return take_outside(next);
      at = next;
    }
  }
  /// Goes on with a hole: what is too steep above rolls into it.
  DESERT_HD void fill(Cell at) const {
    const Cell above = steepest<true>(at);
    if (above.slot == at.slot) return;
    lattice.add(at.slot, 1);
    if (block.beyond(above.line, above.place) > reach) return take_outside(above);
    take(above);
  }

 private:
  DESERT_HD void take_outside(Cell at) const {
    lattice.add(at.slot, -1);
    atomic_add(&lattice.arriving[at.slot], Lattice::one_hole);
  }
};

/// Calls work(rolling) with what suits the block.
template <class Work>
DESERT_HD void with_rolling(const Lattice& lattice, const Block& block, const Work& work) {
  constexpr int read = Rolling<true>::reach + 1;
  const bool inside = block.line >= read && block.place >= read &&
                      block.line + block.lines + read <= lattice.order.lines() &&
                      block.place + block.places + read <= lattice.order.length();
  if (inside)
    work(Rolling<true>{lattice, block});
  else
    work(Rolling<false>{lattice, block});
}

/// Slabs that have come to a block are put down, and holes go on. On a GPU, whose threads have a block each,
/// all look for their next slab first, and then roll it at the same time.
template <class Rolling>
DESERT_HD void settle(const Rolling& rolling) {
  const Lattice& lattice = rolling.lattice;
  const Block& block = rolling.block;
  typename Rolling::Cell at{block.line, block.place - 1, -1};
  std::uint32_t come = 0;
  for (;;) {
    while (come == 0) {
      if (++at.place == block.place + block.places) {
        at.place = block.place;
        if (++at.line == block.line + block.lines) return;
      }
      at.slot = rolling.cell(at.line, at.place).slot;
      come = lattice.arriving[at.slot];
    }
    const bool hole = come >= Lattice::one_hole;
    come -= hole ? Lattice::one_hole : Lattice::one_slab;
    if (come == 0) lattice.arriving[at.slot] = 0;
    if (hole)
      rolling.fill(at);
    else
      rolling.put(at);
  }
}

struct Settle {
  Lattice lattice;
  Blocks blocks;
  int turn;

  DESERT_HD void operator()(int item) const {
    const Block block = blocks.block(turn, item);
    if (block.cells() == 0) return;
    with_rolling(lattice, block, [](const auto& rolling) DESERT_INLINE { settle(rolling); });
  }
};

}  // namespace desert_sim::slabs
