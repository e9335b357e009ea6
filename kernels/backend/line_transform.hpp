#pragma once
/// Discrete Fourier transforms of lines, butterfly by butterfly: on a GPU by a team of threads in shared
/// memory, as part of a kernel (where transforms are small, the launches of cuFFT take longer than their
/// work); on a CPU many lines beside each other as vectors (fft_cpu.cpp). All give the same bits.
///
///   X(k) = Σ_j x(j) e^(−2πi jk/n),   n without prime factors other than 2, 3 and 5
///
/// This is Stockham's autosort FFT with mixed radices. A stage of radix r has n/r butterflies, and reads what
/// the previous stage has written. Butterfly b of a stage is
///
///   k = b mod p,   p = `product_before`, the product of the radices of the previous stages
///   v(q) = in[b + q n/r] · e^(−2πi q k/(p·r)),   q = 0 … r − 1
///   out[(b − k) r + k + q·p] = DFT_r(v)(q)
///
/// The inverse without the factor 1/n is the same transform with real and imaginary parts exchanged before
/// and after it.

#include <type_traits>
#include <vector>

#include "kernels/backend/fft.hpp"
#include "kernels/backend/for_each.hpp"
#include "kernels/base/macros.hpp"
#include "kernels/base/math.hpp"
#include "src/core/elementary.hpp"

namespace desert_sim {

DESERT_HD Complex operator+(Complex a, Complex b) { return {a.re + b.re, a.im + b.im}; }
DESERT_HD Complex operator-(Complex a, Complex b) { return {a.re - b.re, a.im - b.im}; }
DESERT_HD Complex operator*(Complex a, Complex b) {
  return {fused(a.re, b.re, -(a.im * b.im)), fused(a.re, b.im, a.im * b.re)};
}
/// a + s·b
DESERT_HD Complex plus_times(Complex a, float s, Complex b) {
  return {fused(s, b.re, a.re), fused(s, b.im, a.im)};
}
/// a − i s·b
DESERT_HD Complex minus_i_times(Complex a, float s, Complex b) {
  return {fused(s, b.im, a.re), fused(-s, b.re, a.im)};
}
DESERT_HD Complex swap_re_im(Complex a) { return {a.im, a.re}; }

/// Transforms of 2 … 6 values in registers, in place. Of equal values every mode but the first is exactly 0.
DESERT_HD void small_dft(Complex (&v)[2]) {
  const Complex sum = v[0] + v[1];
  v[1] = v[0] - v[1];
  v[0] = sum;
}
DESERT_HD void small_dft(Complex (&v)[3]) {
  constexpr float sin_60 = 0.866025404f;
  const Complex sum = v[1] + v[2], difference = v[1] - v[2], middle = plus_times(v[0], -0.5f, sum);
  v[0] = v[0] + sum;
  v[1] = minus_i_times(middle, sin_60, difference);
  v[2] = minus_i_times(middle, -sin_60, difference);
}
DESERT_HD void small_dft(Complex (&v)[4]) {
  const Complex even = v[0] + v[2], odd = v[1] + v[3], across = v[0] - v[2], aslant = v[1] - v[3];
  v[0] = even + odd;
  v[1] = {across.re + aslant.im, across.im - aslant.re};
  v[2] = even - odd;
  v[3] = {across.re - aslant.im, across.im + aslant.re};
}
DESERT_HD void small_dft(Complex (&v)[5]) {
  constexpr float sin_72 = 0.951056516f, sin_144 = 0.587785252f, quarter_root_5 = 0.559016994f;
  const Complex near = v[1] + v[4], far = v[2] + v[3], near_gap = v[1] - v[4], far_gap = v[2] - v[3];
  const Complex sum = near + far, middle = plus_times(v[0], -0.25f, sum), spread = near - far;
  const Complex first = plus_times(middle, quarter_root_5, spread);
  const Complex second = plus_times(middle, -quarter_root_5, spread);
  v[0] = v[0] + sum;
  v[1] = minus_i_times(minus_i_times(first, sin_72, near_gap), sin_144, far_gap);
  v[4] = minus_i_times(minus_i_times(first, -sin_72, near_gap), -sin_144, far_gap);
  v[2] = minus_i_times(minus_i_times(second, sin_144, near_gap), -sin_72, far_gap);
  v[3] = minus_i_times(minus_i_times(second, -sin_144, near_gap), sin_72, far_gap);
}
/// The Good–Thomas prime-factor algorithm: two transforms of three values, without twiddle factors.
DESERT_HD void small_dft(Complex (&v)[6]) {
  Complex a[3] = {v[0], v[2], v[4]}, b[3] = {v[3], v[5], v[1]};
  small_dft(a);
  small_dft(b);
  v[0] = a[0] + b[0];
  v[1] = a[1] - b[1];
  v[2] = a[2] + b[2];
  v[3] = a[0] - b[0];
  v[4] = a[1] + b[1];
  v[5] = a[2] - b[2];
}

/// Whether n ≥ 1 has no prime factors other than 2, 3 and 5.
inline bool has_small_factors(int n) {
  for (int factor : {2, 3, 5})
    while (n % factor == 0) n /= factor;
  return n == 1;
}

struct LineTransform {
  static constexpr int longest = 4096, max_stages = 7;  // 3⁷ has seven

  struct Stage {
    int radix, product_before;
    int twiddle_stride;  ///< of the twiddle factors in the table of roots, length / (product_before · radix)
    float share;         ///< 1 / product_before
  };

  int length = 0, count = 0;
  Stage stages[max_stages] = {};

  /// Whether `n` is no longer than `longest` and has_small_factors().
  static bool supports_length(int n) { return n >= 2 && n <= longest && has_small_factors(n); }
  /// The transform of lines of `n` values, where supports_length(n) must hold.
  static LineTransform for_length(int n) {
    LineTransform t;
    t.length = n;
    while (!t.find_radices(n, ++t.count)) {
    }
    int product_before = 1;
    for (int i = 0; i < t.count; product_before *= t.stages[i++].radix) {
      Stage& stage = t.stages[i];
      stage.product_before = product_before;
      stage.twiddle_stride = n / (product_before * stage.radix);
      stage.share = 1.0f / static_cast<float>(product_before);
    }
    return t;
  }

  /// The roots of unity e^(−2πi j/n), j = 0 … n − 1, which butterflies() needs.
  std::vector<Complex> roots() const {
    std::vector<Complex> table(static_cast<std::size_t>(length));
    for (int j = 0; j < length; ++j) {
      const elementary::UnitVector root = elementary::direction_deg(-360.0 * j / length);
      table[static_cast<std::size_t>(j)] = {static_cast<float>(root.x), static_cast<float>(root.y)};
    }
    return table;
  }

  /// Where butterfly b of a stage, 0 ≤ b < length/radix, finds its values, and where it leaves them.
  template <int radix>
  struct Butterfly {
    int from, from_stride, to, to_stride;
    Complex twiddles[radix];  ///< of its values; the first is 1

    DESERT_HD Butterfly(const LineTransform& t, const Stage& stage, int b, const Complex* roots)
        : from(b), from_stride(t.length / radix), to_stride(stage.product_before) {
      const int before =
          static_cast<int>((static_cast<float>(b) + 0.5f) * stage.share) * stage.product_before;
      const int k = b - before;
      to = before * radix + k;
      unrolled<radix>([&](auto q) DESERT_INLINE { twiddles[q] = roots[q * k * stage.twiddle_stride]; });
    }
    /// `turned`: whether twiddles are not all 1 (in all stages but the first).
    template <bool turned>
    DESERT_HD void run(Complex (&v)[radix]) const {
      if constexpr (turned)
        unrolled<radix - 1>([&](auto q) DESERT_INLINE { v[q + 1] = v[q + 1] * twiddles[q + 1]; });
      small_dft(v);
    }
  };
  /// The butterflies first, first + step, first + 2 step … of a stage.
  DESERT_HD void butterflies(const Stage& stage, int first, int step, const Complex* roots, const Complex* in,
                             Complex* out) const {
    with_radix(stage, [&](auto radix, auto turned) {
      for (int b = first; b < length / radix; b += step) {
        const Butterfly<radix> butterfly(*this, stage, b, roots);
        Complex v[radix];
        unrolled<radix>([&](auto q) { v[q] = in[butterfly.from + q * butterfly.from_stride]; });
        butterfly.template run<turned>(v);
        unrolled<radix>([&](auto q) { out[butterfly.to + q * butterfly.to_stride] = v[q]; });
      }
    });
  }
  /// Calls body(radix, turned) with the stage's radix, and whether it has twiddle factors, as constants.
  template <class Body>
  DESERT_HD static void with_radix(const Stage& stage, const Body& body) {
    if (stage.product_before > 1)
      with_radix(stage.radix, std::true_type(), body);
    else
      with_radix(stage.radix, std::false_type(), body);
  }

 private:
  /// Order of preference. Five comes first, because the first stage writes with a stride of its radix, and an
  /// odd stride avoids bank conflicts in shared memory.
  static constexpr int radices[] = {5, 3, 6, 4, 2};

  template <class Turned, class Body>
  DESERT_HD static void with_radix(int radix, Turned turned, const Body& body) {
    switch (radix) {
      case 2:
        return body(std::integral_constant<int, 2>(), turned);
      case 3:
        return body(std::integral_constant<int, 3>(), turned);
      case 4:
        return body(std::integral_constant<int, 4>(), turned);
      case 5:
        return body(std::integral_constant<int, 5>(), turned);
      default:
        return body(std::integral_constant<int, 6>(), turned);
    }
  }

  /// Finds radices whose product is n for the last `left` of `count` stages; false if there are none.
  bool find_radices(int n, int left) {
    if (left == 0) return n == 1;
    for (int radix : radices) {
      stages[count - left].radix = radix;
      if (n % radix == 0 && find_radices(n / radix, left - 1)) return true;
    }
    return false;
  }
};

}  // namespace desert_sim
