#pragma once
/// Where a ray meets ripples and bumps (kernels/micro_relief/relief.hpp) on the bilinear ground of a patch.
///
/// The height of the ray above the bilinear ground is a quadratic g(s), and micro-relief adds o(s) to the
/// ground, which lies between −`low` and `high`. From where g first comes down to `high`, the ray goes on in
/// steps so short that it cannot pass through a slope of the micro-relief of up to 22°,
///
///   Δs = max((g − o)/(steepest descent of g + 0.4 · horizontal way per s), 2 mm of way)
///
/// until g − o changes its sign, and the last step is halved down to 0.1 mm at most. A ray through the tip of
/// a crest, for less than 2 mm of its way, may miss it.

#include <cmath>

#include "kernels/micro_relief/window.hpp"
#include "kernels/rover/ray.hpp"

namespace desert_sim::ray_march {

/// The smallest s in [0, end] at which c0 + c1 s + c2 s² is not above 0; `never` if there is none, and if a
/// coefficient is NaN.
DESERT_HD float first_below_zero(float c0, float c1, float c2, float end) {
  if (c0 <= 0.0f) return 0.0f;
  const float discriminant = c1 * c1 - 4.0f * c2 * c0;
  if (!(discriminant >= 0.0f) || (c1 >= 0.0f && c2 >= 0.0f)) return never;
  // These forms lose no digits where c2 is small; with c2 = 0 the first is the root of the linear equation.
  const float root = sqrtf(discriminant);
  const float s = c1 < 0.0f ? 2.0f * c0 / (root - c1) : (c1 + root) / (-2.0f * c2);
  return s <= end ? s : never;
}

/// A ray within a patch: its height above the bilinear ground, c0 + c1 s + c2 s², and its place (a, b).
struct PartOverPatch {
  int p, q;
  float a, b, du, dv;
  float c0, c1, c2;
  float metres;  ///< of way for each s
};

/// Ground that is bilinear and no more.
struct PlainGround {
  static constexpr bool has_micro_relief = false;
  float high = 0;
  DESERT_HD float first_below(const PartOverPatch& r, float end) const {
    return first_below_zero(r.c0, r.c1, r.c2, end);
  }
};

struct RippledGround {
  static constexpr bool has_micro_relief = true;
  micro_relief::Relief relief;
  micro_relief::KnownSquares known;  ///< of those in which most beams end
  double cell_size;                  ///< [m]
  float high;                        ///< what micro-relief adds at most [m]

  RippledGround(const micro_relief::Relief& r, const micro_relief::KnownSquares& squares, double cell)
      : relief(r),
        known(squares),
        cell_size(cell),
        high(0.5f * r.ripples.size.steepness * r.ripples.size.longest +
             1.25f * (1.0f + r.bumps.lee) * r.bumps.height) {}

  /// At the place (a, b) of a patch, which has cell (p − 1, q − 1) in its south-west corner.
  DESERT_HD float offset(int p, int q, float a, float b) const {
    return known.offset(relief, (p - 0.5 + double{a}) * cell_size, (q - 0.5 + double{b}) * cell_size);
  }
  DESERT_HD float above(const PartOverPatch& r, float s) const {
    return r.c0 + (r.c1 + r.c2 * s) * s - offset(r.p, r.q, r.a + s * r.du, r.b + s * r.dv);
  }
  DESERT_HD float first_below(const PartOverPatch& r, float end) const {
    constexpr float steepest = 0.4f, shortest_way = 0.002f;
    float s = first_below_zero(r.c0 - high, r.c1, r.c2, end);
    if (!(s < never)) return never;
    float gap = above(r, s);
    if (gap <= 0.0f) return s;
    const float horizontal = hypotenuse(r.du, r.dv) * static_cast<float>(cell_size);
    const float approach = fabsf(r.c1) + 2.0f * fabsf(r.c2) * end + steepest * horizontal;
    while (s < end) {
      const float next = minimum(s + maximum(gap / approach, shortest_way / r.metres), end);
      const float then = above(r, next);
      if (!(then > 0.0f)) return crossing(r, s, next);
      s = next;
      gap = then;
    }
    return never;
  }
  /// Rise of the micro-relief per cell along x and y.
  struct Slope {
    float u, v;
  };
  DESERT_HD Slope slope(int p, int q, float a, float b) const {
    const float half = 0.002f / static_cast<float>(cell_size), per = 0.5f / half;
    return {(offset(p, q, a + half, b) - offset(p, q, a - half, b)) * per,
            (offset(p, q, a, b + half) - offset(p, q, a, b - half)) * per};
  }

 private:
  DESERT_HD float crossing(const PartOverPatch& r, float before, float after) const {
    for (int halving = 0; halving < 16 && (after - before) * r.metres > 1e-4f; ++halving) {
      const float middle = 0.5f * (before + after);
      if (above(r, middle) > 0.0f)
        before = middle;
      else
        after = middle;
    }
    return after;
  }
};

}  // namespace desert_sim::ray_march
