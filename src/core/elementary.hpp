#pragma once
/// Elementary functions of `double` with the same bits on every machine, for what enters the state of a run.
/// Those of C libraries differ from one another, and from one processor to another, by units in the last
/// place (ulp). These use only +, −, ×, ÷, √, fused multiply-add and exact functions (floor, rint, remainder,
/// frexp, ldexp), which IEEE 754 rounds alike everywhere. For floats, on host and device, there is
/// kernels/base/math.hpp.
///
/// Arguments are first reduced, with constants in two or three parts; polynomials are Taylor's. Sums and
/// quotients that would cancel or add up roundings are unevaluated sums of two numbers (Dekker 1971, Numer.
/// Math. 18, 224). All errors are below 1 ulp, unless said otherwise. Functions keep the sign of 0, and pass
/// NaN on.

#include <cmath>
#include <cstddef>
#include <limits>

namespace desert_sim::elementary {

/// high + low, where low is at most about one ulp of high, unless said otherwise.
struct DoubleDouble {
  double high, low;
  double rounded() const { return high + low; }
};

namespace internal {

constexpr double infinite = std::numeric_limits<double>::infinity(),
                 undefined = std::numeric_limits<double>::quiet_NaN();
constexpr DoubleDouble quarter_turn{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54},
    half_turn{0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53},
    degree{0x1.1df46a2529d39p-6, 0x1.5c1d8becdd291p-62},
    degrees_per_radian{0x1.ca5dc1a63c1f8p+5, -0x1.1e7ab456405f9p-49};

/// a + b exactly.
inline DoubleDouble sum(double a, double b) {
  const double s = a + b, part = s - a;
  return {s, (a - (s - part)) + (b - part)};
}
/// a b exactly, unless it is below 1e-290.
inline DoubleDouble product(double a, double b) {
  const double p = a * b;
  return {p, std::fma(a, b, -p)};
}
inline DoubleDouble product(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble p = product(a.high, b.high);
  return {p.high, p.low + (a.high * b.low + a.low * b.high)};
}
inline DoubleDouble difference(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble s = sum(a.high, -b.high);
  return {s.high, s.low + (a.low - b.low)};
}
/// The lower parts may be some percent of the higher ones.
inline DoubleDouble quotient(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble over = sum(a.high, a.low), under = sum(b.high, b.low);
  const double q = over.high / under.high, rest = std::fma(-q, under.high, over.high);
  return {q, (rest + over.low - q * under.low) / under.high};
}

/// Σ coefficients[n] xⁿ, by Horner's rule.
template <std::size_t count>
double polynomial(double x, const double (&coefficients)[count]) {
  double p = coefficients[count - 1];
  for (std::size_t n = count - 1; n-- > 0;) p = p * x + coefficients[n];
  return p;
}

/// e^x = 2^power (1 + rest), where rest is from √½ − 1 to √2 − 1, and its lower part at most a fifth.
struct ReducedExponential {
  int power;
  DoubleDouble rest;
};
/// For |x| ≤ 746.
inline ReducedExponential reduced_exponential(double x) {
  constexpr double ln2 = 0x1.62e42feep-1, ln2_rest = 0x1.a39ef35793c76p-33, per_ln2 = 0x1.71547652b82fep+0;
  constexpr double taylor[] = {1.0 / 2,          1.0 / 6,        1.0 / 24,        1.0 / 120,
                               1.0 / 720,        1.0 / 5040,     1.0 / 40320,     1.0 / 362880,
                               1.0 / 3628800,    1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800,
                               1.0 / 87178291200};
  const double n = std::rint(x * per_ln2);
  const DoubleDouble r = sum(x - n * ln2, -(n * ln2_rest));  // the first product has 43 bits
  return {static_cast<int>(n),
          {r.high, r.low + r.high * r.low + r.high * r.high * polynomial(r.high, taylor)}};
}

/// An angle as quarter turns, modulo 4, and a rest of at most an eighth of a turn [rad].
struct ReducedAngle {
  int quarters;
  DoubleDouble rest;
};
/// Beyond it, neighbouring numbers are more than 0.4 degrees apart.
constexpr double largest_angle = 0x1p45;  // [rad]
inline ReducedAngle reduced_angle(double x) {
  constexpr double per_quarter_turn = 0x1.45f306dc9c883p-1, third_part = -0x1.f1976b7ed8fbcp-110;
  const double n = std::rint(x * per_quarter_turn);
  const double first = std::fma(-n, quarter_turn.high, x);  // exact: no bit of it is below 2^−53
  const DoubleDouble second = product(n, quarter_turn.low), near = sum(first, -second.high);
  return {static_cast<int>(n - 4 * std::floor(n / 4)),
          sum(near.high, near.low - second.low - n * third_part)};
}
/// An angle from 0 to 180 degrees, exactly symmetric about 45, 90 and 135.
inline ReducedAngle reduced_degrees(double angle_deg) {
  const int quarters = (angle_deg > 45 ? 1 : 0) + (angle_deg > 135 ? 1 : 0);
  return {quarters, product({angle_deg - 90 * quarters, 0}, degree)};
}

/// The sine within an eighth of a turn; its lower part is at most a fifth.
inline DoubleDouble sine_of_rest(const DoubleDouble& r) {
  constexpr double taylor[] = {
      -1.0 / 6,        1.0 / 120,        -1.0 / 5040,          1.0 / 362880,
      -1.0 / 39916800, 1.0 / 6227020800, -1.0 / 1307674368000, 1.0 / 355687428096000};
  const double square = r.high * r.high;
  return {r.high, r.high * square * polynomial(square, taylor) + r.low * (1 - 0.5 * square)};
}
/// The cosine within an eighth of a turn.
inline DoubleDouble cosine_of_rest(const DoubleDouble& r) {
  constexpr double taylor[] = {1.0 / 24,        -1.0 / 720,         1.0 / 40320,         -1.0 / 3628800,
                               1.0 / 479001600, -1.0 / 87178291200, 1.0 / 20922789888000};
  const DoubleDouble square = product(r.high, r.high), near = sum(1, -0.5 * square.high);
  return {near.high, near.low + (square.high * square.high * polynomial(square.high, taylor) -
                                 (0.5 * square.low + r.high * r.low))};
}
inline DoubleDouble sine(const ReducedAngle& a) {
  const DoubleDouble s = a.quarters % 2 == 0 ? sine_of_rest(a.rest) : cosine_of_rest(a.rest);
  return a.quarters < 2 ? s : DoubleDouble{-s.high, -s.low};
}
inline DoubleDouble cosine(const ReducedAngle& a) { return sine({(a.quarters + 1) % 4, a.rest}); }

/// arctan(a/b) for 0 ≤ a ≤ b and b from 1e-250 to 1e300:
///
///   arctan(a/b) = arctan c + arctan((a − c b)/(b + c a)),   c = 0, ¼, ½, ¾ or 1, nearest to a/b
inline DoubleDouble arctangent_of_ratio(double a, double b) {
  constexpr DoubleDouble of_fourths[] = {{0, 0},
                                         {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
                                         {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
                                         {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
                                         {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}};
  constexpr double taylor[] = {1.0 / 3,   -1.0 / 5, 1.0 / 7,   -1.0 / 9, 1.0 / 11,
                               -1.0 / 13, 1.0 / 15, -1.0 / 17, 1.0 / 19};
  if (a < 0x1p-60 * b) return {a / b, 0};
  const int fourths = static_cast<int>(std::rint(4 * (a / b)));
  const double c = 0.25 * fourths;
  const DoubleDouble t = quotient(difference({a, 0}, product(c, b)), difference({b, 0}, product(-c, a)));
  const double square = t.high * t.high;
  const DoubleDouble table = of_fourths[fourths], near = sum(table.high, t.high);
  return {near.high,
          near.low + (table.low + (t.low * (1 - square) - t.high * square * polynomial(square, taylor)))};
}

/// The angle of a vector from the x axis, −π … π; what IEEE 754 says of zeros and infinities.
inline DoubleDouble angle_of(double y, double x) {
  double a = std::abs(y), b = std::abs(x);
  if (std::isnan(a) || std::isnan(b)) return {undefined, undefined};
  if (std::isinf(a) || std::isinf(b)) {
    a = std::isinf(a) ? 1 : 0;
    b = std::isinf(b) ? 1 : 0;
  }
  if (a == 0 && b == 0) b = 1;
  const bool steep = a > b;
  const double longer = steep ? a : b,
               scale = longer > 0x1p900 ? 0x1p-100 : (longer < 0x1p-800 ? 0x1p200 : 1);
  DoubleDouble angle =
      steep ? arctangent_of_ratio(b * scale, a * scale) : arctangent_of_ratio(a * scale, b * scale);
  if (steep) angle = difference(quarter_turn, angle);
  if (std::signbit(x)) angle = difference(half_turn, angle);
  return std::signbit(y) ? DoubleDouble{-angle.high, -angle.low} : angle;
}

}  // namespace internal

/// e^x.
inline double exp(double x) {
  if (!(std::abs(x) <= 746)) return x < 0 ? 0 : x * internal::infinite;
  const internal::ReducedExponential e = internal::reduced_exponential(x);
  const DoubleDouble near = internal::sum(1, e.rest.high);
  return std::ldexp(near.high + (near.low + e.rest.low), e.power);
}

/// e^x − 1, also where x is so small that e^x rounds to 1.
inline double expm1(double x) {
  if (std::abs(x) < 0x1p-54) return x;
  if (x < -40) return -1;
  if (!(x <= 746)) return x * internal::infinite;
  const internal::ReducedExponential e = internal::reduced_exponential(x);
  const DoubleDouble whole = internal::sum(1, -std::ldexp(1, -e.power)),
                     near = internal::sum(whole.high, e.rest.high);
  return std::ldexp(near.high + (near.low + (whole.low + e.rest.low)), e.power);
}

/// The natural logarithm:
///
///   ln(2^n (1 + f)) = n ln 2 + f − (f²/2 − s (f²/2 + 2 s²/3 + 2 s⁴/5 + …)),   s = f/(2 + f)
///
/// with √½ ≤ 1 + f < √2.
inline double log(double x) {
  constexpr double root_of_half = 0x1.6a09e667f3bcdp-1;
  constexpr double ln2 = 0x1.62e42feep-1, ln2_rest = 0x1.a39ef35793c76p-33;
  constexpr double taylor[] = {2.0 / 3,  2.0 / 5,  2.0 / 7,  2.0 / 9,  2.0 / 11,
                               2.0 / 13, 2.0 / 15, 2.0 / 17, 2.0 / 19, 2.0 / 21};
  if (!(x > 0)) return x == 0 ? -internal::infinite : internal::undefined;
  if (std::isinf(x)) return x;
  int n = 0;
  double m = std::frexp(x, &n);
  if (m < root_of_half) m *= 2, --n;
  const double f = m - 1, s = f / (2 + f), square = s * s, half_square = 0.5 * f * f;
  const double rest = s * (half_square + square * internal::polynomial(square, taylor)) + n * ln2_rest;
  return n * ln2 - ((half_square - rest) - f);
}

/// A unit vector.
struct UnitVector {
  double x, y;
};
/// Sine, cosine, both as {cos, sin}, and tangent of angles in radians; NaN for |x| > 2⁴⁵ ≈ 3.5e13.
inline double sin(double x) {
  if (!(std::abs(x) <= internal::largest_angle)) return internal::undefined;
  return std::abs(x) < 0x1p-27 ? x : internal::sine(internal::reduced_angle(x)).rounded();
}
inline double cos(double x) {
  if (!(std::abs(x) <= internal::largest_angle)) return internal::undefined;
  return internal::cosine(internal::reduced_angle(x)).rounded();
}
inline UnitVector direction(double x) {
  if (!(std::abs(x) <= internal::largest_angle)) return {internal::undefined, internal::undefined};
  if (std::abs(x) < 0x1p-27) return {1, x};
  const internal::ReducedAngle a = internal::reduced_angle(x);
  return {internal::cosine(a).rounded(), internal::sine(a).rounded()};
}
inline double tan(double x) {
  if (!(std::abs(x) <= internal::largest_angle)) return internal::undefined;
  if (std::abs(x) < 0x1p-27) return x;
  const internal::ReducedAngle a = internal::reduced_angle(x);
  return internal::quotient(internal::sine(a), internal::cosine(a)).rounded();
}

/// {cos, sin} of an angle in degrees, of any size: exact at multiples of 90, and the same in all octants but
/// for signs and order.
inline UnitVector direction_deg(double angle_deg) {
  const double within = std::remainder(angle_deg, 360);
  const internal::ReducedAngle a = internal::reduced_degrees(std::abs(within));
  return {internal::cosine(a).rounded() + 0.0, std::copysign(internal::sine(a).rounded(), within)};
}
/// The tangent of an angle in degrees, of any size: exactly 1 at 45, ±∞ at odd multiples of 90.
inline double tan_deg(double angle_deg) {
  const double within = std::remainder(angle_deg, 360);
  const internal::ReducedAngle a = internal::reduced_degrees(std::abs(within));
  if (a.rest.high == 0) return std::copysign(a.quarters == 1 ? internal::infinite : 0, within);
  const double tangent = internal::quotient(internal::sine(a), internal::cosine(a)).rounded();
  return within < 0 ? -tangent : tangent;
}

/// The angle of the vector (x, y) from the x axis, −π … π, in radians and in degrees.
inline double atan2(double y, double x) { return internal::angle_of(y, x).rounded(); }
inline double atan2_deg(double y, double x) {
  return internal::product(internal::angle_of(y, x), internal::degrees_per_radian).rounded();
}
inline double atan(double x) { return atan2(x, 1); }
inline double atan_deg(double x) { return atan2_deg(x, 1); }

/// The length of a vector whose components are 0 or from 1e-150 to 1e150. Errors are below 1.25 ulp in the
/// plane, and below 1.5 ulp in space.
inline double hypot(double x, double y) { return std::sqrt(x * x + y * y); }
inline double hypot(double x, double y, double z) { return std::sqrt(x * x + y * y + z * z); }

}  // namespace desert_sim::elementary
