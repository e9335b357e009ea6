// Elementary functions: their errors, by the C library's long doubles, their symmetries, and their bits.
#include "src/core/elementary.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "src/core/constants.hpp"

namespace desert_sim::elementary {
namespace {

using Function = double (*)(double);
using Reference = long double (*)(long double);

static_assert(std::numeric_limits<long double>::digits >= 64,
              "the reference needs more digits than a double");

constexpr double infinity = std::numeric_limits<double>::infinity(),
                 tiniest = std::numeric_limits<double>::denorm_min(),
                 largest = std::numeric_limits<double>::max();
const double nothing = std::nan("");
constexpr long double pi_long = 3.14159265358979323846264338327950288L;

/// Numbers that do not depend on the C++ library: the standard fixes the bits of the generator, not those of
/// its distributions.
class Numbers {
 public:
  double even(double low, double high) {
    return low + (high - low) * (static_cast<double>(words_() >> 11) * 0x1p-53);
  }
  /// Of either sign, with all powers of two from `low` to `high` as often.
  double of_all_sizes(int low, int high) {
    const int power = low + static_cast<int>(words_() % static_cast<unsigned>(high - low + 1));
    const double size = std::ldexp(even(1, 2), power);
    return words_() % 2 == 0 ? size : -size;
  }

 private:
  std::mt19937_64 words_{5};
};

std::vector<double> even_numbers(double low, double high, int count = 40000) {
  Numbers numbers;
  std::vector<double> all;
  for (int n = 0; n < count; ++n) all.push_back(numbers.even(low, high));
  return all;
}
std::vector<double> all_sizes(int low, int high, int count = 40000) {
  Numbers numbers;
  std::vector<double> all;
  for (int n = 0; n < count; ++n) all.push_back(numbers.of_all_sizes(low, high));
  return all;
}

double error_in_ulp(double found, long double expected) {
  int power = 0;
  (void)std::frexp(static_cast<double>(expected), &power);
  const double ulp = std::ldexp(1, std::max(power - 53, -1074));
  return static_cast<double>(std::abs(found - expected)) / ulp;
}

/// The largest error over the arguments [ulp].
double worst(Function f, Reference reference, const std::vector<double>& arguments) {
  double most = 0;
  for (double x : arguments) {
    const double error = error_in_ulp(f(x), reference(x));
    EXPECT_FALSE(std::isnan(error)) << x;
    most = std::max(most, error);
  }
  return most;
}

std::uint64_t bits(double x) {
  std::uint64_t word = 0;
  std::memcpy(&word, &x, sizeof word);
  return word;
}
bool same(double a, double b) { return bits(a) == bits(b); }

TEST(Elementary, ExponentialsAreAccurate) {
  for (const auto& x : {even_numbers(-700, 709), even_numbers(-2, 2), all_sizes(-60, 3)}) {
    EXPECT_LT(worst(exp, std::exp, x), 0.7);
    EXPECT_LT(worst(expm1, std::expm1, x), 1);
  }
  // Numbers below 2^−1022 are rounded twice.
  EXPECT_LE(worst(exp, std::exp, even_numbers(-745, -708)), 1);
  EXPECT_LT(worst(expm1, std::expm1, all_sizes(-1074, -50)), 1);
}

TEST(Elementary, LogarithmsAreAccurate) {
  std::vector<double> positive;
  for (double x : all_sizes(-1074, 1023)) positive.push_back(std::abs(x));
  for (const auto& x : {positive, even_numbers(0.4, 2.5), even_numbers(0.999, 1.001)})
    EXPECT_LT(worst(log, std::log, x), 0.9);
}

TEST(Elementary, SinesAndTangentsAreAccurate) {
  std::vector<double> near_quarters;
  for (double n = 1; n < 1e6; n += 37) near_quarters.push_back(n * (0.5 * pi));
  for (const auto& x :
       {even_numbers(-1, 1), even_numbers(-100, 100), even_numbers(-2e6, 2e6), even_numbers(-1e10, 1e10),
        even_numbers(-0x1p45, 0x1p45), all_sizes(-1074, 0), near_quarters}) {
    EXPECT_LT(worst(sin, std::sin, x), 0.9);
    EXPECT_LT(worst(cos, std::cos, x), 0.9);
    EXPECT_LT(worst(tan, std::tan, x), 1);
  }
}

TEST(Elementary, ArctangentsAreAccurate) {
  const Reference in_degrees = [](long double x) { return std::atan(x) * 180 / pi_long; };
  for (const auto& x : {even_numbers(-4, 4), all_sizes(-1000, 1000)}) {
    EXPECT_LT(worst(atan, std::atan, x), 0.55);
    EXPECT_LT(worst(atan_deg, in_degrees, x), 0.55);
  }
  Numbers numbers;
  for (int n = 0; n < 100000; ++n) {
    const int size = n % 4 == 0 ? 1020 : 10;
    const double x = numbers.of_all_sizes(-size, size), y = numbers.of_all_sizes(-size, size);
    const long double angle = std::atan2(static_cast<long double>(y), static_cast<long double>(x));
    ASSERT_LT(error_in_ulp(atan2(y, x), angle), 0.55) << y << " " << x;
  }
}

TEST(Elementary, DirectionsAndLengthsAreAccurate) {
  const Function cosine = [](double x) { return direction_deg(x).x; },
                 sine = [](double x) { return direction_deg(x).y; };
  const Reference exact_sine = [](long double x) { return std::sin(x * pi_long / 180); },
                  exact_cosine = [](long double x) { return std::sin((90 - std::abs(x)) * pi_long / 180); },
                  exact_tangent = [](long double x) { return std::tan(x * pi_long / 180); };
  EXPECT_LT(worst(sine, exact_sine, even_numbers(-90, 90)), 0.9);
  EXPECT_LT(worst(cosine, exact_cosine, even_numbers(-90, 90)), 0.9);
  EXPECT_LT(worst(tan_deg, exact_tangent, even_numbers(-60, 60)), 1);
  Numbers numbers;
  for (int n = 0; n < 100000; ++n) {
    const double x = numbers.of_all_sizes(-8, 8), y = numbers.of_all_sizes(-8, 8), z = numbers.even(-9, 9);
    const long double square = static_cast<long double>(x) * x + static_cast<long double>(y) * y;
    ASSERT_LT(error_in_ulp(hypot(x, y), std::sqrt(square)), 1.25);
    ASSERT_LT(error_in_ulp(hypot(x, y, z), std::sqrt(square + static_cast<long double>(z) * z)), 1.5);
  }
}

TEST(Elementary, FunctionsOfOneNumberAreDefinedAtTheirEnds) {
  for (const Function odd :
       {Function{expm1}, Function{sin}, Function{tan}, Function{atan}, Function{tan_deg}})
    for (double x : {0.0, -0.0}) EXPECT_TRUE(same(odd(x), x));
  for (const Function odd : {Function{expm1}, Function{sin}, Function{tan}, Function{atan}})
    for (double x : {tiniest, -tiniest, 0x1p-1030, 0x1p-1000}) EXPECT_TRUE(same(odd(x), x)) << x;
  for (const Function any : {Function{exp}, Function{expm1}, Function{log}, Function{sin}, Function{cos},
                             Function{tan}, Function{atan}, Function{tan_deg}})
    EXPECT_TRUE(std::isnan(any(nothing)));
  for (const Function periodic : {Function{sin}, Function{cos}, Function{tan}, Function{tan_deg}})
    for (double x : {infinity, -infinity}) EXPECT_TRUE(std::isnan(periodic(x)));
  EXPECT_TRUE(std::isnan(sin(0x1.1p45)) && std::isnan(cos(-0x1.1p45)) && std::isnan(tan(0x1.1p45)) &&
              std::isnan(direction(0x1.1p45).x));
  for (double x : {0.0, -0.0, tiniest, -tiniest, 1e-300}) EXPECT_EQ(exp(x), 1);
  for (double x : {-746.0, -1e4, -largest, -infinity}) EXPECT_TRUE(same(exp(x), 0)) << x;
  EXPECT_EQ(exp(-745.1), tiniest);
  for (double x : {710.0, 747.0, largest, infinity}) {
    EXPECT_EQ(exp(x), infinity) << x;
    EXPECT_EQ(expm1(x), infinity) << x;
  }
  for (double x : {-41.0, -800.0, -infinity}) EXPECT_EQ(expm1(x), -1) << x;
  EXPECT_TRUE(same(log(1), 0));
  for (double x : {0.0, -0.0}) EXPECT_EQ(log(x), -infinity);
  for (double x : {-tiniest, -1.0, -infinity}) EXPECT_TRUE(std::isnan(log(x)));
  EXPECT_EQ(log(infinity), infinity);
  for (double x : {0.0, -0.0, tiniest, 1e-9})
    EXPECT_TRUE(cos(x) == 1 && direction(x).x == 1 && same(direction(x).y, x));
}

TEST(Elementary, AnglesOfVectorsAreExactOnTheAxes) {
  for (double x : {tiniest, 1.0, 1e300, infinity}) {
    for (double zero : {0.0, -0.0}) {
      EXPECT_TRUE(same(atan2(zero, x), zero));
      EXPECT_TRUE(same(atan2(zero, -x), std::copysign(pi, zero)));
      EXPECT_EQ(atan2(x, zero), 0.5 * pi);
      EXPECT_EQ(atan2_deg(-x, zero), -90);
      EXPECT_EQ(atan2_deg(zero, -x), std::copysign(180, zero));
    }
    EXPECT_EQ(atan2_deg(x, x), 45);
    EXPECT_EQ(atan2_deg(x, -x), 135);
    EXPECT_EQ(atan2_deg(-x, -x), -135);
    EXPECT_EQ(atan_deg(-x), -atan2_deg(x, 1));
  }
  EXPECT_EQ(atan2(0.0, -0.0), pi);
  EXPECT_EQ(atan2(infinity, 5), 0.5 * pi);
  EXPECT_EQ(atan2(5, infinity), 0);
  EXPECT_EQ(atan2(5, -infinity), pi);
  EXPECT_TRUE(std::isnan(atan2(nothing, 1)) && std::isnan(atan2(infinity, nothing)));
  EXPECT_EQ(atan_deg(infinity), 90);
}

TEST(Elementary, DirectionsAreTheSameInAllOctants) {
  for (int turns : {-3, 0, 1, 1000000}) {
    const double whole = 360.0 * turns;
    constexpr double cosines[] = {1, 0, -1, 0};
    for (int q = 0; q < 4; ++q) {
      const auto [x, y] = direction_deg(whole + 90.0 * q);
      EXPECT_EQ(x, cosines[q]);
      EXPECT_EQ(y, cosines[(q + 3) % 4]);
      const auto [u, v] = direction_deg(whole + 90.0 * q + 45.0);
      EXPECT_EQ(std::abs(u), std::sqrt(0.5));
      EXPECT_EQ(std::abs(v), std::sqrt(0.5));
    }
  }
  EXPECT_EQ(direction_deg(30).y, 0.5);
  for (double eighths = 1; eighths < 360; eighths += 7) {  // all these angles are exact
    const double a = eighths / 8;
    const auto [x, y] = direction_deg(a);
    const auto is = [](const UnitVector& v, double cosine, double sine) {
      return v.x == cosine && v.y == sine;
    };
    EXPECT_TRUE(is(direction_deg(-a), x, -y) && is(direction_deg(90 - a), y, x) &&
                is(direction_deg(90 + a), -y, x) && is(direction_deg(180 - a), -x, y) &&
                is(direction_deg(a - 180), -x, -y) && is(direction_deg(270 - a), -y, -x) &&
                is(direction_deg(a - 90), y, -x) && is(direction_deg(a + 720), x, y))
        << a;
    EXPECT_EQ(tan_deg(-a), -tan_deg(a));
    EXPECT_EQ(tan_deg(a - 180), tan_deg(a));
  }
  EXPECT_TRUE(std::isnan(direction_deg(infinity).x) && std::isnan(direction_deg(nothing).y));
  EXPECT_EQ(tan_deg(45), 1);
  EXPECT_EQ(tan_deg(-225), -1);
  EXPECT_EQ(tan_deg(90), infinity);
  EXPECT_EQ(tan_deg(-90), -infinity);
}

TEST(Elementary, FunctionsAreOddOrEven) {
  for (double x : even_numbers(-50, 50, 5000)) {
    EXPECT_EQ(sin(-x), -sin(x));
    EXPECT_EQ(cos(-x), cos(x));
    EXPECT_TRUE(same(direction(x).x, cos(x)) && same(direction(x).y, sin(x)));
    EXPECT_EQ(tan(-x), -tan(x));
    EXPECT_EQ(atan(-x), -atan(x));
    EXPECT_EQ(hypot(x, 3), hypot(3, -x));
  }
}

/// Where one polynomial ends and the next begins, a larger argument gives no smaller value.
void expect_rise(Function f, std::vector<double> seams) {
  for (double seam : seams) {
    double x = seam * (seam > 0 ? 1 - 0x1p-43 : 1 + 0x1p-43), value = f(x);
    for (int n = 0; n < 2000; ++n) {
      const double next = std::nextafter(x, infinity), higher = f(next);
      ASSERT_GE(higher, value) << next;
      x = next;
      value = higher;
    }
  }
}

TEST(Elementary, FunctionsRiseAcrossSeams) {
  const double half_ln2 = 0.5 * std::log(2.0);
  expect_rise(exp, {half_ln2, -half_ln2, 3 * half_ln2, 401 * half_ln2, -401 * half_ln2});
  expect_rise(expm1, {half_ln2, -half_ln2, 3 * half_ln2, 401 * half_ln2, 0x1p-54, -40});
  expect_rise(log, {std::sqrt(0.5), std::sqrt(2.0), 1, 1024 * std::sqrt(0.5)});
  expect_rise(sin, {0.25 * pi, -0.25 * pi, 2.25 * pi, 0x1p-27});
  expect_rise(tan, {0.25 * pi, -0.25 * pi, 1.25 * pi, 0x1p-27});
  expect_rise(atan, {0.125, -0.125, 0.375, 0.625, 0.875, 1, -1, 8.0 / 7, 8.0 / 5, 8.0 / 3, 8});
  expect_rise(tan_deg, {45, -45});
}

/// FNV-1a over all bits of the values.
struct Hash {
  std::uint64_t value = 0xcbf29ce484222325u;
  void add(double x) {
    for (int byte = 0; byte < 64; byte += 8) value = (value ^ (bits(x) >> byte & 0xff)) * 0x100000001b3u;
  }
};
std::uint64_t hash_of(Function f, const std::vector<double>& arguments) {
  Hash hash;
  for (double x : arguments) hash.add(f(x));
  return hash.value;
}

TEST(Elementary, BitsAreThoseOfEveryMachine) {
  const std::vector<double> wide = even_numbers(-700, 700, 5000), near = all_sizes(-60, 2, 5000);
  std::vector<double> positive;
  for (double x : all_sizes(-1022, 1023, 5000)) positive.push_back(std::abs(x));
  EXPECT_EQ(hash_of(exp, wide), 0xcd0635642ca30142u);
  EXPECT_EQ(hash_of(exp, near), 0xdc68d02041f302f4u);
  EXPECT_EQ(hash_of(expm1, near), 0xdfec05f65c31368eu);
  EXPECT_EQ(hash_of(log, positive), 0x4f9951e3c8206707u);
  EXPECT_EQ(hash_of(sin, wide), 0xce0bc3aad929c3ffu);
  EXPECT_EQ(hash_of(cos, wide), 0x31e9656e051e7e8cu);
  EXPECT_EQ(hash_of(tan, wide), 0xcaefb1065f84585au);
  EXPECT_EQ(hash_of(tan_deg, wide), 0x09519943af19314du);
  EXPECT_EQ(hash_of(atan, near), 0x5f06273cfdf786d7u);
  EXPECT_EQ(hash_of(atan_deg, near), 0x323307f7f36c7e0fu);
  Hash directions, angles, lengths;
  for (double x : wide) {
    const auto [cosine, sine] = direction_deg(x);
    directions.add(cosine);
    directions.add(sine);
    angles.add(atan2(sine, x));
    angles.add(atan2_deg(x, cosine));
    lengths.add(hypot(x, sine));
    lengths.add(hypot(x, sine, cosine));
  }
  EXPECT_EQ(directions.value, 0xf6a415f89b275f4du);
  EXPECT_EQ(angles.value, 0x1977310c33af50b5u);
  EXPECT_EQ(lengths.value, 0x212774e4b17fb02au);
}

}  // namespace
}  // namespace desert_sim::elementary
