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
/// pairs do not ask what is below the sand, and a slide is one multiplication and addition, rounded once.
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

#include "desert_sim/kernels/avalanching_units.hpp"
#include "desert_sim/kernels/for_each.hpp"

namespace desert_sim::avalanching {

struct Patch {
  static constexpr int side = 4, cells = side * side;
};

/// Shares ω of what slides over the three gaps between a patch's columns, and between its rows; the latter
/// are alike for patches beside each other.
template <int lanes>
struct Shares {
  float x[Patch::side - 1][lanes], y[Patch::side - 1];
};

/// Of a diagonal pair's share, what counts its excess over one cell as it is over √2: a little less, so that
/// no rounding makes ω = 1 more than all that lies between the two.
constexpr float diagonal_distance = 1.414213f;

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
    unrolled<Patch::side>([&](auto n) DESERT_INLINE { pair<0, n, 1, 0>(), pair<2, n, 1, 0>(); });
    unrolled<Patch::side>([&](auto n) DESERT_INLINE { pair<1, n, 1, 0>(); });
    unrolled<Patch::side>([&](auto n) DESERT_INLINE { pair<n, 0, 0, 1>(), pair<n, 2, 0, 1>(); });
    unrolled<Patch::side>([&](auto n) DESERT_INLINE { pair<n, 1, 0, 1>(); });
  }

 private:
  /// Both diagonal pairs of four cells.
  template <int row, int column>
  DESERT_HD void quad() const {
    pair<row, column, 1, 1>();
    pair<row, column + 1, 1, -1>();
  }
  /// A cell a and the one that lies `up` rows and `right` columns from it, b: what slides from a to b, or if
  /// it is negative, from b to a.
  template <int row, int column, int up, int right>
  DESERT_HD void pair() const {
    constexpr bool diagonal = up != 0 && right != 0;
    constexpr int gap = right < 0 ? column - 1 : column;
    float *a = h + at(row, column), *b = h + at(row + up, column + right);
    const float* ground_a = deep ? nullptr : ground + at(row, column);
    const float* ground_b = deep ? nullptr : ground + at(row + up, column + right);
    const float *drop_a = drop + at(row, column), *drop_b = drop + at(row + up, column + right);
    DESERT_SIMD
    for (int n = 0; n < lanes; ++n) {
      const float share = diagonal ? lower(shares.x[gap][n], shares.y[row]) * diagonal_distance
                                   : (up != 0 ? shares.y[row] : shares.x[gap][n]);
      const float over_one = diagonal ? (a[n] - b[n]) * (1.0f / Neighbours::distance(4)) : a[n] - b[n];
      const float excess = positive_part(over_one - drop_a[n]) - positive_part(-over_one - drop_b[n]);
      if constexpr (deep)
        slide(a[n], b[n], fused(-share, excess, a[n]), most[n]);
      else
        slide(a[n], b[n], a[n] - lower(higher(share * excess, ground_b[n] - b[n]), a[n] - ground_a[n]),
              most[n]);
    }
  }
  /// What is no longer in a is in b. All are whole units.
  DESERT_HD static void slide(float& a, float& b, float left, float& most) {
    const float moved = a - left;
    b += moved;
    a = left;
    most = higher(most, fabsf(moved));
  }
};

}  // namespace desert_sim::avalanching
