/// The two-dimensional transforms of the CPU against the sum that defines them, and against FFTW, in double
/// precision.
#include "kernels/backend/fft.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <cstring>
#include <vector>

#include "kernels/backend/exec.hpp"

namespace desert_sim {
namespace {

using Values = std::vector<Complex>;
constexpr double turn = 6.28318530717958647693;

Values some_values(int width, int height, bool mirrored) {
  Values values;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int row = mirrored && 2 * y >= height ? height - 1 - y : y;
      values.push_back({static_cast<float>(std::sin(3.7 * x * x + 1.9 * row * x + row)),
                        static_cast<float>(std::cos(1.3 * row * row * x - 0.4 * x))});
    }
  return values;
}

/// Σ over all values of value · e^(sign 2πi (k·x)), row by row and then column by column.
Values sum(const Values& values, int width, int height, int sign) {
  using Wide = std::complex<double>;
  std::vector<Wide> rows(values.size());
  Values result(values.size());
  for (int y = 0; y < height; ++y)
    for (int k = 0; k < width; ++k)
      for (int x = 0; x < width; ++x) {
        const Complex v = values[y * width + x];
        rows[y * width + k] += Wide(v.re, v.im) * std::polar(1.0, sign * turn * (x * k % width) / width);
      }
  for (int k = 0; k < height; ++k)
    for (int x = 0; x < width; ++x) {
      Wide total = 0;
      for (int y = 0; y < height; ++y)
        total += rows[y * width + x] * std::polar(1.0, sign * turn * (y * k % height) / height);
      result[k * width + x] = {static_cast<float>(total.real()), static_cast<float>(total.imag())};
    }
  return result;
}

/// Largest difference in the first rows, over the root mean square of what is expected.
double error(const Values& values, const Values& expected, int width, int rows) {
  double largest = 0, squares = 0;
  for (int n = 0; n < width * rows; ++n) {
    largest = std::max({largest, std::fabs(static_cast<double>(values[n].re) - expected[n].re),
                        std::fabs(static_cast<double>(values[n].im) - expected[n].im)});
    squares += static_cast<double>(expected[n].re) * expected[n].re;
  }
  return largest / std::sqrt(squares / (width * rows));
}

struct Size {
  int width, height;
};
// Fewer and more than a block of lines, short and long, with large prime factors, a single row and column.
constexpr Size sizes[] = {{8, 6},   {45, 50}, {128, 36}, {20, 160}, {14, 30},
                          {30, 14}, {97, 82}, {301, 22}, {1, 34},   {26, 2}};

TEST(Fft, IsTheSumThatDefinesIt) {
  for (const FftMethod method : {FftMethod::rows_first, FftMethod::columns_first, FftMethod::library})
    for (const Size& s : sizes) {
      SCOPED_TRACE(testing::Message() << s.width << " x " << s.height);
      CpuExec exec(2);
      const auto fft = exec.make_fft(s.width, s.height, 1, method);
      EXPECT_EQ(fft->rows_given(), s.height);
      const Values given = some_values(s.width, s.height, false);
      Values values = given;
      fft->forward(values.data());
      EXPECT_LT(error(values, sum(given, s.width, s.height, -1), s.width, s.height), 1e-5);
      values = given;
      fft->inverse(values.data());
      EXPECT_LT(error(values, sum(given, s.width, s.height, +1), s.width, s.height), 1e-5);
    }
}

/// Root mean square of the difference, over that of what is expected.
TEST(Fft, OfThreeHundredAndSixtySquaredIsAsExactAsFloatsAllow) {
  constexpr int n = 360;
  const Values given = some_values(n, n, false), expected = sum(given, n, n, -1);
  const auto error_of = [&](FftMethod method) {
    CpuExec exec(2);
    Values values = given;
    exec.make_fft(n, n, 1, method)->forward(values.data());
    double difference = 0, size = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double re = expected[i].re, im = expected[i].im;
      difference += std::norm(std::complex<double>(values[i].re - re, values[i].im - im));
      size += re * re + im * im;
    }
    return std::sqrt(difference / size);
  };
  const double by_lines = error_of(FftMethod::rows_first), by_library = error_of(FftMethod::library);
  std::printf("relative error, rms: by lines %.2g, by FFTW %.2g\n", by_lines, by_library);
  EXPECT_LT(by_lines, 3e-7);
  EXPECT_GT(by_lines, 1e-8) << "the reference must be more exact than what it judges";
}

TEST(Fft, TheMethodOfStatesDependsOnTheLengthsAlone) {
  constexpr FftMethod lines = FftMethod::columns_first;
  for (int n : {1, 97, 1021, 4096}) EXPECT_EQ(method_of_states(n, 4096, lines), lines) << n;
  EXPECT_EQ(method_of_states(4097, 64, lines), FftMethod::library);
  EXPECT_EQ(method_of_states(64, 5000, lines), FftMethod::library);
}

TEST(Fft, OfMirroredRowsReadsAndWritesHalf) {
  for (const Size& s : sizes) {
    if (s.height < 4) continue;
    CpuExec exec(2);
    const auto fft = exec.make_fft(s.width, s.height, 1, FftMethod::mirrored_rows_first);
    const Values given = some_values(s.width, s.height, true);
    Values values = given;
    for (std::size_t n = static_cast<std::size_t>(fft->rows_given()) * s.width; n < values.size(); ++n)
      values[n] = {std::nanf(""), std::nanf("")};
    fft->forward(values.data());
    const Values modes = sum(given, s.width, s.height, -1);
    EXPECT_LT(error(values, modes, s.width, s.height), 1e-5) << s.width;
    fft->inverse(values.data());
    const float scale = 1.0f / static_cast<float>(s.width * s.height);
    for (Complex& v : values) v = {v.re * scale, v.im * scale};
    EXPECT_LT(error(values, given, s.width, s.height / 2), 1e-5) << s.width;
  }
}

TEST(Fft, HasTheSameBitsOnAnyNumberOfThreads) {
  constexpr int width = 320, height = 150, fields = 2;
  Values given = some_values(width, height, false), more = some_values(height, width, false);
  given.insert(given.end(), more.begin(), more.end());
  std::vector<Values> results;
  for (int threads : {1, 2, 5}) {
    CpuExec exec(threads);
    const auto fft = exec.make_fft(width, height, fields, FftMethod::rows_first);
    results.push_back(given);
    fft->forward(results.back().data());
  }
  for (std::size_t n = 1; n < results.size(); ++n)
    EXPECT_EQ(std::memcmp(results[0].data(), results[n].data(), sizeof(Complex) * given.size()), 0) << n;
}

TEST(Fft, OfUniformGroundHasOneMode) {
  CpuExec exec(1);
  Values values(96 * 80, Complex{1.7f, 0.0f});
  exec.make_fft(96, 80, 1, FftMethod::rows_first)->forward(values.data());
  for (std::size_t n = 1; n < values.size(); ++n) {
    ASSERT_EQ(values[n].re, 0.0f) << n;
    ASSERT_EQ(values[n].im, 0.0f) << n;
  }
}

}  // namespace
}  // namespace desert_sim
