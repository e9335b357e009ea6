#pragma once
/// Arithmetic of complex numbers, and discrete Fourier transforms of 2 … 6 values in registers, of which the
/// transforms of lines consist (line_transform.hpp). The order of operations is fixed, and what is fused is
/// written as such, so that all machines give the same bits.

#include "kernels/backend/fft.hpp"
#include "kernels/base/macros.hpp"
#include "kernels/base/math.hpp"

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

}  // namespace desert_sim
