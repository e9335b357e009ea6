#pragma once
/// Discrete Fourier transforms of lines, butterfly by butterfly: on a GPU by a team of threads in shared
/// memory (fft_cuda.cu, or as part of a kernel: where transforms are small, launches take longer than their
/// work); on a CPU many lines beside each other as vectors (line_block.hpp). All give the same bits.
///
///   X(k) = Σ_j x(j) e^(−2πi jk/n),   1 ≤ n ≤ `longest_line`
///
/// This is Stockham's autosort FFT with mixed radices. A stage of radix r has n/r butterflies, and reads what
/// the previous stage has written. Butterfly b of a stage is
///
///   k = b mod p,   p = `product_before`, the product of the radices of the previous stages
///   v(q) = in[b + q n/r] · e^(−2πi q k/(p·r)),   q = 0 … r − 1
///   out[(b − k) r + k + q·p] = DFT_r(v)(q)
///
/// Radices are 2 … 6, and the prime factors of n above 5. Of the latter the values do not fit into registers,
/// and a butterfly has two passes over the pairs q, r − q:
///
///   s(q) = (v(q) − v(0)) + (v(r−q) − v(0)),   d(q) = v(q) − v(r−q)   in place, q = 1 … (r−1)/2
///   DFT_r(v)(m), DFT_r(v)(r−m) = Σ_q s(q) cos(2πqm/r) ∓ i Σ_q d(q) sin(2πqm/r),   m = 1 … (r−1)/2
///   DFT_r(v)(0) = r v(0) + Σ_q s(q)
///
/// They take r/2 operations a value: long lines are faster where their lengths have small factors.
///
/// Of equal values every mode but the first is exactly 0. The relative error is below 2e-7 log2(2n) rms, of
/// lengths with small factors below 3e-7.
///
/// The inverse without the factor 1/n is the same transform with real and imaginary parts exchanged before
/// and after it.

#include <type_traits>
#include <vector>

#include "kernels/backend/for_each.hpp"
#include "kernels/backend/small_dft.hpp"
#include "src/core/elementary.hpp"

namespace desert_sim {

/// Whether n ≥ 1 has no prime factors other than 2, 3 and 5.
inline bool has_small_factors(int n) {
  for (int factor : {2, 3, 5})
    while (n % factor == 0) n /= factor;
  return n == 1;
}

struct LineTransform {
  static constexpr int max_stages = 7;  // 3⁷ has seven
  static constexpr int largest_radix_in_registers = 6;

  struct Stage {
    int radix, product_before;
    int twiddle_stride;  ///< of the twiddle factors in the table of roots, length / (product_before · radix)
    float share;         ///< 1 / product_before

    DESERT_HD bool in_registers() const { return radix <= largest_radix_in_registers; }
  };

  int length = 0, count = 0;
  Stage stages[max_stages] = {};

  static bool supports_length(int n) { return n >= 1 && n <= longest_line; }
  /// The transform of lines of `n` values, where supports_length(n) must hold.
  static LineTransform for_length(int n) {
    LineTransform t;
    t.length = n;
    int left = n;
    for (int prime = n; prime > largest_radix_in_registers; --prime)
      for (; left % prime == 0 && is_prime(prime); left /= prime) t.stages[t.count++].radix = prime;
    const int primes = t.count;
    while (!t.find_radices(left, primes, t.count)) ++t.count;
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
  /// One of the butterflies of a stage whose radix is a prime above 5, where a line is asked with get(i) and
  /// set(i, value).
  struct PrimeButterfly {
    int radix, from, from_stride, to, to_stride, turn;  ///< `turn`: of the twiddle factor of value 1
    int mode_stride;                                    ///< of e^(−2πi/radix) in the table of roots

    DESERT_HD PrimeButterfly(const LineTransform& t, const Stage& stage, int b)
        : radix(stage.radix),
          from(b),
          from_stride(t.length / stage.radix),
          to_stride(stage.product_before),
          mode_stride(from_stride) {
      const int k = b % stage.product_before;
      to = (b - k) * radix + k;
      turn = k * stage.twiddle_stride;
    }
    DESERT_HD int pairs() const { return (radix - 1) / 2; }
    /// The first pass, of the pair of values q and radix − q, q = 1 … pairs().
    template <class Line>
    DESERT_HD void fold(int q, const Complex* roots, const Line& line) const {
      const int near = from + q * from_stride, far = from + (radix - q) * from_stride;
      const Complex first = line.get(from), v = line.get(near) * roots[q * turn],
                    w = line.get(far) * roots[(radix - q) * turn];
      line.set(near, (v - first) + (w - first));
      line.set(far, v - w);
    }
    /// What the pair q adds to the modes m and radix − m, `angle` = q · m mod radix.
    template <class Line>
    DESERT_HD void add_pair(int q, int angle, const Complex* roots, const Line& line, Complex& even,
                            Complex& odd) const {
      const Complex s = line.get(from + q * from_stride), d = line.get(from + (radix - q) * from_stride),
                    w = roots[angle * mode_stride];
      even = plus_times(even, w.re, s);
      odd = minus_i_times(odd, -w.im, d);
    }
    /// The second pass: modes m and radix − m, m = 1 … pairs(), and of m = 0 the first one.
    template <class Line>
    DESERT_HD void modes(int m, const Complex* roots, const Line& in, const Line& out) const {
      Complex even{0, 0}, odd{0, 0};
      for (int q = 1, angle = m; q <= pairs(); ++q, angle = next_angle(angle, m))
        add_pair(q, angle, roots, in, even, odd);
      set_modes(m, in, out, even, odd);
    }
    DESERT_HD int next_angle(int angle, int m) const {
      return angle + m >= radix ? angle + m - radix : angle + m;
    }
    template <class Line>
    DESERT_HD void set_modes(int m, const Line& in, const Line& out, Complex even, Complex odd) const {
      if (m == 0) return out.set(to, plus_times(even, static_cast<float>(radix), in.get(from)));
      out.set(to + m * to_stride, even + odd);
      out.set(to + (radix - m) * to_stride, even - odd);
    }
  };
  /// The butterflies first, first + step, first + 2 step … of a stage whose radix is no larger than 6.
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

  /// Finds radices whose product is n for the stages first … end − 1; false if there are none.
  bool find_radices(int n, int first, int end) {
    if (first == end) return n == 1;
    for (int radix : radices) {
      stages[first].radix = radix;
      if (n % radix == 0 && find_radices(n / radix, first + 1, end)) return true;
    }
    return false;
  }
  static bool is_prime(int n) {
    for (int factor = 2; factor * factor <= n; ++factor)
      if (n % factor == 0) return false;
    return n > 1;
  }
};

}  // namespace desert_sim
