#pragma once
/// Slides by the gradient, for scheme `gradient`: one law for slopes of every aspect.
///
/// A quad is four cells that meet at a corner. The drops along its diagonals give the gradient there, and its
/// twist what these two do not see:
///
///      c   d        p = h_a − h_d,   q = h_b − h_c        drops over √2 l
///       ┼           t = h_a + h_d − h_b − h_c             twist
///      a   b        g² = (p² + q² + t²) / 2 l²
///
/// Where g exceeds tan θ, the mean of the tangents of repose of the four cells, the share
///
///   e = 1 − tan θ / g
///
/// of the drops slides: ω p e from a to d, ω q e from b to c, and ⅓ ω t e from each of a and d to b and c.
/// With ω = ½ a plane is left at repose. With ω ≤ ¾ no cell leaves the range of the four where all of them
/// have sand enough; beside bare rock the twist can put sand on a cell that is higher than the donors, by up
/// to a quarter of that range. On slopes that follow an axis and on those that follow a diagonal the same
/// flux results, and a cone is round within 2 %.
/// A law that looks at each neighbour for itself (patch.hpp) lets a rough slope that faces along a diagonal
/// move a fifth faster; tan θ of the donor alone, a tenth where it differs from cell to cell
/// (doc/notebook/avalanching.md).
///
/// Drops count in g only as far as there is sand to slide along them, so that sand beside a step of bare rock
/// keeps its slope. In quads with a wall sand slides along the straight pairs of the other cells.
///
/// Quads are relaxed one after the other, in an order that is transposed from sweep to sweep: in a fixed one
/// slides along one axis would be twice as fast as along the other where the angle of repose is low.

#include "kernels/avalanching/patch.hpp"
#include "kernels/avalanching/tile_units.hpp"
#include "kernels/backend/for_each.hpp"

namespace desert_sim::avalanching {

/// 1/√x by half the exponent and a step of third order, within 2e-5; the same bits on host and device. For 0
/// it is some 1e19.
DESERT_HD float inverse_root(float x) {
  const float y = float_from_bits(0x5f3759dfu - (bits_of(x) >> 1));
  const float error = fused(-x * y, y, 1.0f);
  return fused(y * error, fused(0.375f, error, 0.5f), y);
}

/// Drops of a quad, and the sand of its cells, all in the same unit.
struct Quad {
  float p, q, t;
  float sand_a, sand_b, sand_c, sand_d;  ///< not read if all of it is `deep`
};

/// What would slide with ω = 1, signed as p, q, t. It may be more than the donors have; who moves it limits
/// it to that.
struct QuadSlides {
  float p, q, t;
  static constexpr float of_twist = 1.0f / 3.0f;

  /// `drop`: drop at repose over one cell.
  template <bool deep>
  DESERT_HD static QuadSlides of(const Quad& quad, float drop) {
    const float p = quad.p, q = quad.q, t = quad.t;
    if constexpr (deep) {
      const float share = over(fused(p, p, fused(q, q, t * t)), drop);
      return {p * share, q * share, t * share};
    } else {
      const float p_sand = p > 0.0f ? quad.sand_a : quad.sand_d,
                  q_sand = q > 0.0f ? quad.sand_b : quad.sand_c;
      const float t_sand = t > 0.0f ? fast_min(quad.sand_a, quad.sand_d) : fast_min(quad.sand_b, quad.sand_c);
      const float p_slides = fast_min(fabsf(p), p_sand), q_slides = fast_min(fabsf(q), q_sand),
                  t_slides = fast_min(fabsf(t), t_sand);
      const float pp = p_slides * p_slides, qq = q_slides * q_slides, tt = t_slides * t_slides;
      return {p * over(fused(p, p, qq + tt), drop), q * over(fused(q, q, pp + tt), drop),
              t * over(fused(t, t, pp + qq), drop)};
    }
  }

 private:
  /// The share e of drops whose squares have this sum.
  DESERT_HD static float over(float squares, float drop) {
    return positive_part(fused(-drop, inverse_root(0.5f * squares), 1.0f));
  }
};

/// Shares ω of the quads of patches beside each other: the lesser one of the two gaps that cross in a quad.
template <int lanes>
struct QuadShares {
  const Shares<lanes>& of_gaps;
  bool transposed;

  DESERT_HD QuadShares(const Shares<lanes>& shares, bool transpose)
      : of_gaps(shares), transposed(transpose) {}
  DESERT_HD float operator()(int row, int column, int lane) const {
    return fast_min(of_gaps.x[transposed ? row : column][lane], of_gaps.y[transposed ? column : row]);
  }
};

/// The quads of `lanes` patches beside each other; members are as in PairsOfPatches. In a transposed sweep
/// `at` and `shares` have rows for columns.
template <int lanes, bool deep, class At>
struct QuadsOfPatches {
  float* h;
  const float *ground, *drop;
  At at;
  QuadShares<lanes> shares;
  float* max_moved;

  DESERT_HD void relax() const {
    const bool walls = has_walls();
    relax_quad<0, 0>(walls), relax_quad<0, 2>(walls), relax_quad<2, 0>(walls), relax_quad<2, 2>(walls);
    relax_quad<0, 1>(walls), relax_quad<2, 1>(walls);
    relax_quad<1, 0>(walls), relax_quad<1, 2>(walls);
    relax_quad<1, 1>(walls);
  }

 private:
  /// Whether any cell is a wall. Heights are less than 2, and walls alone have this bit.
  static constexpr std::uint32_t wall_bit = 0x40000000u;
  DESERT_HD bool has_walls() const {
    std::uint32_t bits = 0;
    unrolled<Patch::cells>([&](auto n) DESERT_INLINE {
      const float* cell = h + at(n / Patch::side, n % Patch::side);
      for (int lane = 0; lane < lanes; ++lane) bits |= bits_of(cell[lane]);
    });
    return (bits & wall_bit) != 0;
  }

  template <int row, int column>
  DESERT_HD void relax_quad(bool walls) const {
    const int a = at(row, column), b = at(row, column + 1), c = at(row + 1, column),
              d = at(row + 1, column + 1);
    float share[lanes];
    DESERT_SIMD
    for (int n = 0; n < lanes; ++n) share[n] = shares(row, column, n);
    if (walls)
      for (int n = 0; n < lanes; ++n)
        if ((bits_of(h[a + n]) | bits_of(h[b + n]) | bits_of(h[c + n]) | bits_of(h[d + n])) & wall_bit) {
          relax_straight_pair(a + n, b + n, share[n], n), relax_straight_pair(c + n, d + n, share[n], n);
          relax_straight_pair(a + n, c + n, share[n], n), relax_straight_pair(b + n, d + n, share[n], n);
          share[n] = 0.0f;
        }
    relax_diagonals_and_twist(a, b, c, d, share);
  }

  DESERT_HD void relax_diagonals_and_twist(int a, int b, int c, int d, const float (&share)[lanes]) const {
    float *h_a = h + a, *h_b = h + b, *h_c = h + c, *h_d = h + d;
    const float *drop_a = drop + a, *drop_b = drop + b, *drop_c = drop + c, *drop_d = drop + d;
    DESERT_SIMD
    for (int n = 0; n < lanes; ++n) {
      const float at_a = h_a[n], at_b = h_b[n], at_c = h_c[n], at_d = h_d[n], w = share[n];
      Quad quad{at_a - at_d, at_b - at_c, (at_a - at_b) - (at_c - at_d), 0.0f, 0.0f, 0.0f, 0.0f};
      if constexpr (!deep) {
        quad.sand_a = at_a - ground[a + n], quad.sand_b = at_b - ground[b + n];
        quad.sand_c = at_c - ground[c + n], quad.sand_d = at_d - ground[d + n];
      }
      const float mean_drop = 0.25f * ((drop_a[n] + drop_b[n]) + (drop_c[n] + drop_d[n]));
      const QuadSlides slides = QuadSlides::of<deep>(quad, mean_drop);
      // Rounded to whole units by the subtraction, so that each unit that leaves one cell enters another.
      float p = at_a - fused(-w, slides.p, at_a), q = at_b - fused(-w, slides.q, at_b);
      if constexpr (!deep) {
        p = fast_max(fast_min(p, quad.sand_a), -quad.sand_d);
        q = fast_max(fast_min(q, quad.sand_b), -quad.sand_c);
      }
      const float left_a = at_a - p, left_d = at_d + p, left_b = at_b - q, left_c = at_c + q;
      float t = left_a - fused(-w * QuadSlides::of_twist, slides.t, left_a);
      if constexpr (!deep)
        t = fast_max(fast_min(t, fast_min(quad.sand_a - p, quad.sand_d + p)),
                     -fast_min(quad.sand_b - q, quad.sand_c + q));
      h_a[n] = left_a - t, h_d[n] = left_d - t, h_b[n] = left_b + t, h_c[n] = left_c + t;
      max_moved[n] = fast_max(max_moved[n], fast_max(fast_max(fabsf(p), fabsf(q)), fabsf(t)));
    }
  }

  /// Relaxes the pair of cells i and j beside a wall, or with one: a wall neither gives nor takes.
  DESERT_HD void relax_straight_pair(int i, int j, float share, int lane) const {
    if ((bits_of(h[i]) | bits_of(h[j])) & wall_bit) return;
    const float before_i = h[i], before_j = h[j], difference = before_i - before_j;
    const float excess = positive_part(difference - drop[i]) - positive_part(-difference - drop[j]);
    float moved = before_i - fused(-share, excess, before_i);
    if constexpr (!deep) moved = fast_max(fast_min(moved, before_i - ground[i]), -(before_j - ground[j]));
    h[i] = before_i - moved, h[j] = before_j + moved;
    max_moved[lane] = fast_max(max_moved[lane], fabsf(moved));
  }
};

}  // namespace desert_sim::avalanching
