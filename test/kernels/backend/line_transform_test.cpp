// Transforms of lines against the sum that defines them, in double precision.

#include "kernels/backend/line_transform.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "test/support/lines.hpp"

namespace desert_sim {
namespace {

constexpr double pi = 3.14159265358979323846;
using test::Line;

Line transformed(const Line& line, int threads) {
  const LineTransform transform = LineTransform::for_length(static_cast<int>(line.size()));
  return test::transformed(transform, transform.roots(), line, threads);
}

Line some_line(int n) {
  Line line;
  for (int j = 0; j < n; ++j)
    line.push_back(
        {static_cast<float>(std::sin(3.7 * j * j + n)), static_cast<float>(std::cos(1.3 * j * j * j))});
  return line;
}

/// All lengths to 512, and then some: of small factors, of squares of primes, and primes.
std::vector<int> lengths_here() {
  std::vector<int> lengths;
  for (int n = 1; n <= 512; ++n) lengths.push_back(n);
  for (int n : {540, 602, 961, 1021, 1024, 1536, 1922, 2187, 3125, 3888, 4093, 4095, 4096})
    lengths.push_back(n);
  return lengths;
}

TEST(LineTransform, IsTheSumForEveryLength) {
  for (int n : lengths_here()) {
    const Line line = some_line(n), modes = transformed(line, 16);
    double error = 0, size = 0;
    for (int k = 0; k < n; ++k) {
      std::complex<double> sum = 0;
      for (int j = 0; j < n; ++j)
        sum += std::complex<double>(line[j].re, line[j].im) *
               std::polar(1.0, -2 * pi * (static_cast<long>(j) * k % n) / n);
      error += std::norm(sum - std::complex<double>(modes[k].re, modes[k].im));
      size += std::norm(sum);
    }
    EXPECT_LT(std::sqrt(error / size), (has_small_factors(n) ? 3e-7 : 2e-7 * std::log2(2.0 * n))) << n;
  }
}

TEST(LineTransform, SmallFactorsHaveFewStages) {
  int lengths = 0;
  for (int n = 2; n <= 512; ++n)
    if (has_small_factors(n)) {
      const LineTransform t = LineTransform::for_length(n);
      int product = 1;
      for (int s = 0; s < t.count; ++s) product *= t.stages[s].radix;
      EXPECT_EQ(product, n);
      EXPECT_LE(t.count, 6) << n;
      ++lengths;
    }
  EXPECT_EQ(lengths, 67);  // 2^a 3^b 5^c
}

TEST(LineTransform, RootsAreThoseOfTheLibraryRounded) {
  for (int n : {1, 2, 7, 8, 45, 360, 1021, 4096}) {
    const std::vector<Complex> roots = LineTransform::for_length(n).roots();
    for (int j = 0; j < n; ++j) {
      const long double angle = -2 * static_cast<long double>(pi) * j / n;
      EXPECT_NEAR(roots[j].re, std::cos(angle), 3.1e-8) << j << '/' << n;
      EXPECT_NEAR(roots[j].im, std::sin(angle), 3.1e-8) << j << '/' << n;
    }
  }
}

TEST(LineTransform, BackAgainWithPartsExchanged) {
  for (int n : {2, 7, 45, 64, 97, 180, 301, 486, 512}) {
    const Line line = some_line(n);
    Line modes = transformed(line, 16);
    for (Complex& mode : modes) mode = swap_re_im(mode);
    const Line back = transformed(modes, 7);
    for (int j = 0; j < n; ++j) {
      EXPECT_NEAR(back[j].im / n, line[j].re, 1e-6) << n << ' ' << j;
      EXPECT_NEAR(back[j].re / n, line[j].im, 1e-6) << n << ' ' << j;
    }
  }
}

TEST(LineTransform, UniformLinesHaveExactlyOneMode) {
  for (int n : lengths_here()) {
    const Line modes = transformed(Line(static_cast<std::size_t>(n), Complex{1.7f, 0.0f}), 16);
    for (int k = 1; k < n; ++k) {
      ASSERT_EQ(modes[k].re, 0.0f) << n << ' ' << k;
      ASSERT_EQ(modes[k].im, 0.0f) << n << ' ' << k;
    }
  }
}

TEST(LineTransform, LongLinesDoNotSuit) {
  for (int n : {-1, 0, 4097, 4320}) EXPECT_FALSE(LineTransform::supports_length(n)) << n;
  for (int n : {1, 2, 7, 180, 1021, 4096}) EXPECT_TRUE(LineTransform::supports_length(n)) << n;
}

}  // namespace
}  // namespace desert_sim
