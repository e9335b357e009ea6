#pragma once
/// Lines that are transformed beside each other on a CPU, as the lanes of vectors (line_transform.hpp).

#include <algorithm>
#include <cstddef>
#include <vector>

#include "kernels/backend/line_transform.hpp"

namespace desert_sim {

/// Lines that are transformed beside each other, as the lanes of vectors.
constexpr int lanes = 16;

/// Where value i of a lane begins. A butterfly's values are a power of two apart: without the gaps, all of
/// them would compete for a few places of the cache.
DESERT_HD int place(int i) { return (i + (i >> 5)) * lanes; }

/// Value i of a lane, as real and imaginary parts in memory of their own.
struct Lane {
  float *re, *im;
  DESERT_HD Complex get(int i) const { return {re[place(i)], im[place(i)]}; }
  DESERT_HD void set(int i, Complex value) const {
    re[place(i)] = value.re;
    im[place(i)] = value.im;
  }
  DESERT_HD Lane beside(int n) const { return {re + n, im + n}; }
};

/// `lanes` lines of up to `longest` values, and room for those of the next stage.
class LineBlock {
 public:
  explicit LineBlock(int longest) : half_(static_cast<std::size_t>(place(longest + 8))), memory_(4 * half_) {}

  DESERT_HD Lane lane(int n, bool next = false) {
    float* const re = memory_.data() + (next != swapped_ ? 2 * half_ : 0) + n;
    return {re, re + half_};
  }
  /// Values `half` … 2 half − 1 of each line become the mirror image of its first half.
  DESERT_HD void mirror(int half) {
    const Lane lines = lane(0);
    for (int i = 0; i < half; ++i)
      for (float* const part : {lines.re, lines.im})
        std::copy_n(part + place(i), lanes, part + place(2 * half - 1 - i));
  }
  DESERT_HD void transform(const LineTransform& transform, const Complex* roots) {
    for (int s = 0; s < transform.count; ++s) {
      const LineTransform::Stage& stage = transform.stages[s];
      const Lane in = lane(0), out = lane(0, true);
      if (!stage.in_registers()) {
        transform_by_pairs(transform, stage, roots, in, out);
        swapped_ = !swapped_;
        continue;
      }
      transform.with_radix(stage, [&](auto radix, auto turned) DESERT_INLINE {
        for (int b = 0; b < transform.length / radix; ++b) {
          const LineTransform::Butterfly<radix> butterfly(transform, stage, b, roots);
#pragma omp simd
          for (int n = 0; n < lanes; ++n) run<turned>(butterfly, in.beside(n), out.beside(n));
        }
      });
      swapped_ = !swapped_;
    }
  }

 private:
  /// A function of its own, because what is declared in a loop over lanes is not kept in registers.
  template <bool turned, int radix>
  DESERT_HD static void run(const LineTransform::Butterfly<radix>& butterfly, Lane in, Lane out) {
    Complex v[radix];
    unrolled<radix>([&](auto q) DESERT_INLINE { v[q] = in.get(butterfly.from + q * butterfly.from_stride); });
    butterfly.template run<turned>(v);
    unrolled<radix>([&](auto q) DESERT_INLINE { out.set(butterfly.to + q * butterfly.to_stride, v[q]); });
  }

  /// A stage of a large prime radix.
  DESERT_HD static void transform_by_pairs(const LineTransform& transform, const LineTransform::Stage& stage,
                                           const Complex* roots, Lane in, Lane out) {
    for (int b = 0; b < transform.length / stage.radix; ++b) {
      const LineTransform::PrimeButterfly butterfly(transform, stage, b);
      for (int q = 1; q <= butterfly.pairs(); ++q) {
#pragma omp simd
        for (int n = 0; n < lanes; ++n) butterfly.fold(q, roots, in.beside(n));
      }
      for (int m = 0; m <= butterfly.pairs(); ++m) sum_pairs(butterfly, m, roots, in, out);
    }
  }
  /// The modes m and radix − m: all lanes add pair after pair, in the order of PrimeButterfly::modes().
  DESERT_HD static void sum_pairs(const LineTransform::PrimeButterfly& butterfly, int m, const Complex* roots,
                                  Lane in, Lane out) {
    Complex even[lanes] = {}, odd[lanes] = {};
    for (int q = 1, angle = m; q <= butterfly.pairs(); ++q, angle = butterfly.next_angle(angle, m)) {
#pragma omp simd
      for (int n = 0; n < lanes; ++n) butterfly.add_pair(q, angle, roots, in.beside(n), even[n], odd[n]);
    }
#pragma omp simd
    for (int n = 0; n < lanes; ++n) butterfly.set_modes(m, in.beside(n), out.beside(n), even[n], odd[n]);
  }

  std::size_t half_;
  std::vector<float> memory_;
  bool swapped_ = false;
};

}  // namespace desert_sim
