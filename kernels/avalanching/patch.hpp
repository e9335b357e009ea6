#pragma once
/// Slides between pairs of neighbours, and the order in which the pairs of a patch of 4 × 4 cells are
/// relaxed.
///
/// Where the drop from cell i to its neighbour j exceeds the drop at repose, A slides from i to j:
///
///   e = h_i − h_j − tan θ_i · d l
///   A = min(ω e, s_i)
///
/// With ω = ½ this is what Nilles 2024, eq. 9–11, gives for a cell with one receiver, and leaves the two at
/// repose. Pairs are relaxed one after the other, each seeing what those before it have done (Gauss-Seidel),
/// so that a cell with several receivers serves them in turn. As in successive over-relaxation, ω a little
/// above ½ converges sooner. With ω ≤ 1 the receiver never gets higher than the donor was, and the donor
/// never lower than the receiver was.
///
/// No cell therefore falls below the lowest one of its tile, and in a tile whose ground nowhere reaches above
/// that (flat rock, or sand deeper than the rock's relief) no pair ever asks for more sand than the donor
/// has. Such a tile is `deep`: its pairs need not look at the ground, and a slide is two fused multiply-adds,
/// each rounded once.
///
/// On a GPU a thread holds one patch in registers; on a CPU patches beside each other form SIMD vectors.
/// Pairs that share no cell follow each other in the code, so that they do not wait for each other. Diagonal
/// pairs come first, because they start to slide last, at √2 times the drop. If they came after the straight
/// pairs, these would leave them next to nothing, sand would hardly ever take the shortest way down a slope
/// that faces north-east, and crests under two winds would lie 4 … 8 degrees off
/// (doc/notebook/avalanching.md, "Diagonal pairs first").
///
///       diagonals, in quads of      columns             rows
///       cells with both of theirs
///          o o o o                  o o o o             o-o-o-o
///           A B A    A, then B,     | | | |
///          o o o o   C, D           o o o o             first the outer
///           C D C                   | | | |             two pairs, then
///          o o o o                  o o o o             the middle one
///           A B A                   | | | |
///          o o o o                  o o o o

#include "kernels/avalanching/tile_units.hpp"
#include "kernels/backend/for_each.hpp"

namespace desert_sim::avalanching {

struct Patch {
  static constexpr int side = 4, cells = side * side;
};

/// The given share with the last bit of its mantissa set, and less than 1 (0 stays 0). Its product with an
/// excess then never lies halfway between two whole units, so that it is rounded to the same number of units
/// where it is subtracted from the donor and where it is added to the receiver.
DESERT_HD float with_odd_mantissa(float share) {
  return share == 0.0f ? 0.0f : fast_min(float_from_bits(bits_of(share) | 1u), 1.0f - 1.0f / 16777216.0f);
}

/// The share of a gap that nothing crosses: of no excess does it make a unit. It is not 0, as products with
/// it must be no subnormal numbers, which take processors long (quads.hpp).
constexpr float closed_gap = 1e-10f;

/// Shares ω for the three gaps between a patch's columns and for those between its rows, prepared by
/// with_odd_mantissa(). Those between rows are the same for all patches beside each other.
template <int lanes>
struct Shares {
  float x[Patch::side - 1][lanes], y[Patch::side - 1];
};

/// The pairs of `lanes` patches beside each other. Height h, top of the ground below the sand, and drop at
/// repose over one cell are stored at index at(row, column) + lane, in Units.
template <int lanes, bool deep, class At>
struct PairsOfPatches {
  float* h;
  const float *ground, *drop;  ///< ground is not read if `deep`
  At at;
  const Shares<lanes>& shares;
  float* max_moved;  ///< a patch's maximum of what a pair has moved; updated

  DESERT_HD void relax() const {
    relax_quad<0, 0>(), relax_quad<0, 2>(), relax_quad<2, 0>(), relax_quad<2, 2>();
    relax_quad<0, 1>(), relax_quad<2, 1>();
    relax_quad<1, 0>(), relax_quad<1, 2>();
    relax_quad<1, 1>();
    unrolled<Patch::side>([&](auto n)
                              DESERT_INLINE { relax_vertical_pair<0, n>(), relax_vertical_pair<2, n>(); });
    unrolled<Patch::side>([&](auto n) DESERT_INLINE { relax_vertical_pair<1, n>(); });
    unrolled<Patch::side>(
        [&](auto n) DESERT_INLINE { relax_horizontal_pair<n, 0>(), relax_horizontal_pair<n, 2>(); });
    unrolled<Patch::side>([&](auto n) DESERT_INLINE { relax_horizontal_pair<n, 1>(); });
  }

 private:
  /// Relaxes both diagonal pairs of a quad of four cells.
  template <int row, int column>
  DESERT_HD void relax_quad() const {
    float share[lanes];  // in a loop of its own, because it would keep the pairs' loops from vectorising
    DESERT_SIMD
    for (int n = 0; n < lanes; ++n) share[n] = fast_min(shares.x[column][n], shares.y[row]);
    const auto of = [&](int n) DESERT_INLINE { return share[n]; };
    relax_pair<row, column, 1, 1>(of);
    relax_pair<row, column + 1, 1, -1>(of);
  }
  /// Relaxes the pair of a column; relax_horizontal_pair() does so with that of a row.
  template <int row, int column>
  DESERT_HD void relax_vertical_pair() const {
    relax_pair<row, column, 1, 0>([&](int) DESERT_INLINE { return shares.y[row]; });
  }
  template <int row, int column>
  DESERT_HD void relax_horizontal_pair() const {
    relax_pair<row, column, 0, 1>([&](int n) DESERT_INLINE { return shares.x[column][n]; });
  }
  /// Relaxes the pair of a cell a and the cell b that lies `up` rows and `right` columns from it. The excess
  /// is positive where sand slides from a to b, and negative from b to a. All heights are whole units.
  template <int row, int column, int up, int right, class ShareOf>
  DESERT_HD void relax_pair(const ShareOf& share_of) const {
    constexpr float distance = up != 0 && right != 0 ? Neighbours::distance(4) : 1.0f;
    float *a = h + at(row, column), *b = h + at(row + up, column + right);
    const float* ground_a = deep ? nullptr : ground + at(row, column);
    const float* ground_b = deep ? nullptr : ground + at(row + up, column + right);
    const float *drop_a = drop + at(row, column), *drop_b = drop + at(row + up, column + right);
    DESERT_SIMD
    for (int n = 0; n < lanes; ++n) {
      const float share = share_of(n), before_a = a[n], before_b = b[n], difference = before_a - before_b;
      const float excess = positive_part(fused(-distance, drop_a[n], difference)) -
                           positive_part(fused(-distance, drop_b[n], -difference));
      const float left = fused(-share, excess, before_a);
      if constexpr (deep) {
        const float risen = fused(share, excess, before_b);
        a[n] = left, b[n] = risen;
        max_moved[n] = fast_max(max_moved[n], fabsf(before_a - left));
      } else {
        const float limited = fast_max(fast_min(left, before_a - (ground_b[n] - before_b)), ground_a[n]);
        const float moved = before_a - limited;
        a[n] = limited, b[n] = before_b + moved;
        max_moved[n] = fast_max(max_moved[n], fabsf(moved));
      }
    }
  }
};

}  // namespace desert_sim::avalanching
