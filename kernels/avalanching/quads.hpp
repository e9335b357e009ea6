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
/// of the drops slides: ω p e from a to d, ω q e from b to c, and from each of a and d to b and c
///
///   ⅓ ω t, limited to ± ω e max(⅓ |t|, (1 − e) min(|p|, |q|))
///
/// With ω = ½ a plane is left at repose. With ω ≤ ¾ no cell leaves the range of the four where all of them
/// have sand enough, and beside bare rock QuadSlides::limit() sees to it. On slopes that follow an axis and
/// on those that follow a diagonal the same flux results, and a cone is round within 2 %.
///
/// p and q are means over two rows and two columns, and level nothing that alternates from cell to cell
/// across a slope, as the hourglass modes of finite elements with one point of integration (Flanagan &
/// Belytschko 1981). The twist levels it. If e ⅓ t of it slid, e being small on most slopes, thin sand
/// would be twice as uneven from cell to cell.
///
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

/// Drops of a quad, and the sand of its cells, all in the same unit.
struct Quad {
  float p, q, t;
  float sand_a, sand_b, sand_c, sand_d;  ///< not read if all of it is `deep`
};

/// The shares e of the drops p, q and t that slide with ω = 1. Where sand is deep they are the same.
struct SlidingShares {
  float p, q, t;

  /// `drops`: the sum of the four cells' drops at repose over one cell. `least`: the share where nothing
  /// slides.
  template <bool deep>
  DESERT_HD static SlidingShares of(const Quad& quad, float drops, float least) {
    const float p = quad.p, q = quad.q, t = quad.t;
    if constexpr (deep) {
      const float share = over(fused(p, p, fused(q, q, t * t)), drops, least);
      return {share, share, share};
    } else {
      const float p_sand = p > 0.0f ? quad.sand_a : quad.sand_d,
                  q_sand = q > 0.0f ? quad.sand_b : quad.sand_c;
      const float t_sand = t > 0.0f ? fast_min(quad.sand_a, quad.sand_d) : fast_min(quad.sand_b, quad.sand_c);
      const float p_slides = fast_min(fabsf(p), p_sand), q_slides = fast_min(fabsf(q), q_sand),
                  t_slides = fast_min(fabsf(t), t_sand);
      const float pp = p_slides * p_slides, qq = q_slides * q_slides, tt = t_slides * t_slides;
      return {over(fused(p, p, qq + tt), drops, least), over(fused(q, q, pp + tt), drops, least),
              over(fused(t, t, pp + qq), drops, least)};
    }
  }

 private:
  DESERT_HD static float over(float squares, float drops, float least) {
    return fast_max(fused(-drops, inverse_steepness(squares), 1.0f), least);
  }
  /// 1/√(8 x) by half the exponent and one step of Newton's, with constants that keep the error within 7e-4;
  /// the same bits on host and device. It is some 1e19 for 0. With x = 2 l² g² it is ¼ over the drop that g
  /// has over one cell.
  DESERT_HD static float inverse_steepness(float x) {
    constexpr float scale = 0.35355339f * 0.703952253f;
    const float y = float_from_bits(0x5f1ffff9u - (bits_of(x) >> 1));
    return fused(-x * y, y, 2.38924456f) * (y * scale);
  }
};

/// What slides along the diagonals of a quad, and by its twist from each of a and d to b and c.
struct QuadSlides {
  float p, q, t;

  /// Limits slides of a quad whose cells have these heights to what the donors have, and the twist so that
  /// no cell leaves the range of the four: beside bare rock, whose heights count in t, it might.
  DESERT_HD void limit(float a, float b, float c, float d, const Quad& quad) {
    p = fast_max(fast_min(p, quad.sand_a), -quad.sand_d);
    q = fast_max(fast_min(q, quad.sand_b), -quad.sand_c);
    const float highest = fast_max(fast_max(a, b), fast_max(c, d)),
                lowest = fast_min(fast_min(a, b), fast_min(c, d));
    const auto limit_of = [=](float donor_1, float donor_2, float sand_1, float sand_2, float receiver_1,
                              float receiver_2) DESERT_INLINE {
      const float room =
          fast_min(highest - fast_max(receiver_1, receiver_2), fast_min(donor_1, donor_2) - lowest);
      return fast_min(room, fast_min(sand_1, sand_2));
    };
    t = fast_max(fast_min(t, limit_of(a - p, d + p, quad.sand_a - p, quad.sand_d + p, b - q, c + q)),
                 -limit_of(b - q, c + q, quad.sand_b - q, quad.sand_c + q, a - p, d + p));
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
  bool walls;  ///< whether any cell of the tile is a wall

  DESERT_HD void relax() const {
    if (walls)
      relax_quads<true>();
    else
      relax_quads<false>();
  }

 private:
  template <bool beside_walls>
  DESERT_HD void relax_quads() const {
    relax_quad<0, 0, beside_walls>(), relax_quad<0, 2, beside_walls>();
    relax_quad<2, 0, beside_walls>(), relax_quad<2, 2, beside_walls>();
    relax_quad<0, 1, beside_walls>(), relax_quad<2, 1, beside_walls>();
    relax_quad<1, 0, beside_walls>(), relax_quad<1, 2, beside_walls>();
    relax_quad<1, 1, beside_walls>();
  }

  /// Heights are less than 2, and walls alone have this bit.
  static constexpr std::uint32_t wall_bit = 0x40000000u;

  template <int row, int column, bool beside_walls>
  DESERT_HD void relax_quad() const {
    const int a = at(row, column), b = at(row, column + 1), c = at(row + 1, column),
              d = at(row + 1, column + 1);
    float share[lanes];
    DESERT_SIMD
    for (int n = 0; n < lanes; ++n) share[n] = shares(row, column, n);
    if constexpr (beside_walls)
      for (int n = 0; n < lanes; ++n)
        if ((bits_of(h[a + n]) | bits_of(h[b + n]) | bits_of(h[c + n]) | bits_of(h[d + n])) & wall_bit) {
          relax_straight_pair(a + n, b + n, share[n], n), relax_straight_pair(c + n, d + n, share[n], n);
          relax_straight_pair(a + n, c + n, share[n], n), relax_straight_pair(b + n, d + n, share[n], n);
          share[n] = closed_gap;
        }
    relax_diagonals_and_twist(a, b, c, d, share);
  }

  static constexpr float of_twist = 1.0f / 3.0f;
  static constexpr float negligible = closed_gap;  ///< share where nothing slides
  /// As with_odd_mantissa(), for shares that are less than 1 and not 0.
  DESERT_HD static float odd(float share) { return float_from_bits(bits_of(share) | 1u); }

  /// Of a slide that is less than ½ (the unit is that of heights from 1 to 2).
  DESERT_HD static float whole_units(float slide) { return (slide + 1.5f) - 1.5f; }
  DESERT_HD static float limited(float slide, float most) { return fast_max(fast_min(slide, most), -most); }

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
      const SlidingShares shares_of =
          SlidingShares::of<deep>(quad, (drop_a[n] + drop_b[n]) + (drop_c[n] + drop_d[n]), negligible);
      // Heights are rounded to whole units by each fused operation; odd shares see to it that each unit that
      // leaves one cell enters another.
      const float e_p = odd(w * shares_of.p), e_q = odd(w * shares_of.q), e_t = w * shares_of.t;
      const float flattest = fast_min(fabsf(quad.p), fabsf(quad.q)), twist = of_twist * quad.t;
      const float most = fast_max(e_t * fabsf(twist), fused(-shares_of.t, e_t, e_t) * flattest);
      const float t = whole_units(limited(w * twist, most));
      const float left_a = fused(-e_p, quad.p, at_a), left_b = fused(-e_q, quad.q, at_b);
      if constexpr (deep) {
        const float left_c = fused(e_q, quad.q, at_c), left_d = fused(e_p, quad.p, at_d);
        h_a[n] = left_a - t, h_d[n] = left_d - t;
        h_b[n] = left_b + t, h_c[n] = left_c + t;
        max_moved[n] =
            fast_max(fast_max(max_moved[n], fabsf(t)), fast_max(fabsf(left_a - at_a), fabsf(left_b - at_b)));
      } else {
        QuadSlides slides{at_a - left_a, at_b - left_b, t};
        slides.limit(at_a, at_b, at_c, at_d, quad);
        h_a[n] = (at_a - slides.p) - slides.t, h_d[n] = (at_d + slides.p) - slides.t;
        h_b[n] = (at_b - slides.q) + slides.t, h_c[n] = (at_c + slides.q) + slides.t;
        max_moved[n] =
            fast_max(fast_max(max_moved[n], fabsf(slides.t)), fast_max(fabsf(slides.p), fabsf(slides.q)));
      }
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
