#pragma once
/// Slides between pairs of neighbours, and the order in which a patch of 4 × 4 cells goes through its pairs.
///
/// Where the drop from one cell to its neighbour is more than what sand rests at,
///
///   e = h_i − h_j − tan θ_i d l,   A = min(ω e, s_i)
///
/// slides from i to j: with ω = ½ that is what Nilles 2024, eq. 9–11, give for a cell with one receiver, and
/// the two are left at repose. Pairs follow each other, each sees what those before it have done, so that a
/// cell with several receivers serves them in turn; and as always when unknowns are relaxed in turn, going
/// too far (ω a little over ½) gets sooner to where all are at rest. A never makes the receiver higher than
/// the donor was (ω ≤ 1).
///
/// So no cell falls below the lowest of its tile, and in a tile where the ground nowhere reaches above that
/// (flat rock, or deep sand over any) no pair ever wants more than the donor has. Such a tile is `deep`: its
/// pairs do not ask what is below the sand, and a slide is two multiplications and additions, each rounded
/// once.
///
/// A thread works on a patch, which it holds in registers; a CPU on several beside each other, as vectors.
/// Pairs that share no cell stand together, so that they do not wait for each other. Diagonal pairs come
/// first, which start to slide last, at √2 times the drop: behind the others, which leave them next to
/// nothing, sand hardly ever goes down a slope that faces north-east by the shortest way, and crests under
/// two winds lie 4 … 8 degrees off (test/bench/README.md, "Diagonal pairs first").
///
// clang-format off
///     diagonals, by quads of      columns             rows
///     cells with both of theirs
///        o o o o                  o o o o             o-o-o-o
///         A B A    A, then B,     | | | |
///        o o o o   C, D           o o o o             first the outer
///         C D C                   | | | |             two pairs, then
///        o o o o                  o o o o             the middle one
///         A B A                   | | | |
///        o o o o                  o o o o
// clang-format on

#include "kernels/avalanching/tile_units.hpp"
#include "kernels/backend/for_each.hpp"

namespace desert_sim::avalanching {

struct Patch {
  static constexpr int side = 4, cells = side * side;
};

/// A share whose last bit is set, next to the given one and less than 1. Its product with an excess then
/// never lies halfway between two whole units: rounded once where it is taken away and once where it is
/// added, it becomes the same number of them.
DESERT_HD float never_halfway(float share) {
  return share == 0.0f ? 0.0f : lower(float_of(bits_of(share) | 1u), 1.0f - 1.0f / 16777216.0f);
}

/// Shares ω of what slides over the three gaps between a patch's columns, and between its rows, as
/// never_halfway() has them; the latter are alike for patches beside each other.
template <int lanes>
struct Shares {
  float x[Patch::side - 1][lanes], y[Patch::side - 1];
};

/// The pairs of `lanes` patches beside each other, whose heights h, top of the ground below the sand, and
/// drop at repose over one cell stand at [at(row, column) + lane]; heights and grounds in Units.
template <int lanes, bool deep, class At>
struct PairsOfPatches {
  float* h;
  const float *ground, *drop;  ///< `deep`: no ground
  At at;
  const Shares<lanes>& shares;
  float* most;  ///< of each patch: raised to the most that a pair has moved

  DESERT_HD void relax() const {
    quad<0, 0>(), quad<0, 2>(), quad<2, 0>(), quad<2, 2>();
    quad<0, 1>(), quad<2, 1>();
    quad<1, 0>(), quad<1, 2>();
    quad<1, 1>();
    unrolled<Patch::side>([&](auto n) DESERT_INLINE { upright<0, n>(), upright<2, n>(); });
    unrolled<Patch::side>([&](auto n) DESERT_INLINE { upright<1, n>(); });
    unrolled<Patch::side>([&](auto n) DESERT_INLINE { level<n, 0>(), level<n, 2>(); });
    unrolled<Patch::side>([&](auto n) DESERT_INLINE { level<n, 1>(); });
  }

 private:
  /// Both diagonal pairs of four cells.
  template <int row, int column>
  DESERT_HD void quad() const {
    float share[lanes];  // by itself: in the pairs' own loops compilers see no minimum, and make no vectors
    DESERT_SIMD
    for (int n = 0; n < lanes; ++n) share[n] = lower(shares.x[column][n], shares.y[row]);
    const auto of = [&](int n) DESERT_INLINE { return share[n]; };
    pair<row, column, 1, 1>(of);
    pair<row, column + 1, 1, -1>(of);
  }
  /// A pair above each other, and one beside each other.
  template <int row, int column>
  DESERT_HD void upright() const {
    pair<row, column, 1, 0>([&](int) DESERT_INLINE { return shares.y[row]; });
  }
  template <int row, int column>
  DESERT_HD void level() const {
    pair<row, column, 0, 1>([&](int n) DESERT_INLINE { return shares.x[column][n]; });
  }
  /// A cell a and the one that lies `up` rows and `right` columns from it, b: what slides from a to b, or if
  /// it is negative, from b to a. All heights are whole units.
  template <int row, int column, int up, int right, class ShareOf>
  DESERT_HD void pair(const ShareOf& share_of) const {
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
        most[n] = higher(most[n], fabsf(before_a - left));
      } else {
        const float limited = higher(lower(left, before_a - (ground_b[n] - before_b)), ground_a[n]);
        const float moved = before_a - limited;
        a[n] = limited, b[n] = before_b + moved;
        most[n] = higher(most[n], fabsf(moved));
      }
    }
  }
};

}  // namespace desert_sim::avalanching
