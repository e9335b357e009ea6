// The projection of the wind: it removes the divergence, and nothing else.

#include <algorithm>
#include <complex>
#include <numeric>

#include "test/kernels/wind/wind_field.hpp"

namespace desert_sim {
namespace {

using Field = std::vector<std::complex<double>>;

/// One axis of a plain double-precision transform.
void transform_rows(Field& f, int width, int height) {
  std::vector<std::complex<double>> root(static_cast<std::size_t>(width)), row(root);
  for (int i = 0; i < width; ++i) root[static_cast<std::size_t>(i)] = std::polar(1.0, -2 * pi * i / width);
  for (int y = 0; y < height; ++y) {
    std::complex<double>* v = &f[static_cast<std::size_t>(y) * width];
    for (int k = 0; k < width; ++k) {
      std::complex<double> sum = 0;
      for (int x = 0; x < width; ++x)
        sum += v[x] * root[static_cast<std::size_t>(static_cast<long>(k) * x % width)];
      row[static_cast<std::size_t>(k)] = sum;
    }
    std::copy(row.begin(), row.end(), v);
  }
}

Field transposed(const Field& f, int width, int height) {
  Field t(f.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      t[static_cast<std::size_t>(x) * height + y] = f[static_cast<std::size_t>(y) * width + x];
  return t;
}

Field spectrum(const std::vector<float>& values, int width, int height) {
  Field f(values.begin(), values.end());
  transform_rows(f, width, height);
  f = transposed(f, width, height);
  transform_rows(f, height, width);
  return transposed(f, height, width);
}

/// rms of the divergence over rms of all gradients, |k·û| over |k||û|, by all modes but the mean and the
/// Nyquist rows.
double relative_divergence(const std::vector<float>& u, const std::vector<float>& v, int width, int height) {
  const Field fu = spectrum(u, width, height), fv = spectrum(v, width, height);
  double divergence = 0, size = 0;
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      if (2 * i == width || 2 * j == height) continue;
      const double kx = 2 * pi * (2 * i > width ? i - width : i) / width,
                   ky = 2 * pi * (2 * j > height ? j - height : j) / height;
      const std::size_t n = static_cast<std::size_t>(j) * width + i;
      divergence += std::norm(kx * fu[n] + ky * fv[n]);
      size += (kx * kx + ky * ky) * (std::norm(fu[n]) + std::norm(fv[n]));
    }
  return std::sqrt(divergence / size);
}

double mean(const std::vector<float>& v) {
  return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
}

TEST_P(WindField, ProjectionRemovesDivergenceAndKeepsTheMean) {
  for (const auto& [width, height, cell] : {std::tuple{128, 128, 1.0}, {128, 512, 2.0}, {96, 135, 1.0}}) {
    SCOPED_TRACE(std::to_string(width) + " x " + std::to_string(height));
    test::BenchTerrain t(exec(), width, height, cell);
    // Rough ground and a strong speed-up: divergence at all wavenumbers, well above what float32 can hold.
    t.set(Layer::bedrock, [w = width, h = height](int x, int y) {
      return hills(x, y, w, h) + 20 * random_unit(1, Purpose::terrain_noise, static_cast<std::uint32_t>(x),
                                                  static_cast<std::uint32_t>(y));
    });
    WindParameters plain = with(true, false, 1), projected = with(true, true, 1);
    plain.speedup = projected.speedup = 0.05f;
    t.blow(plain, {5, 2});
    const double before =
        relative_divergence(t.terrain.values(Layer::wind_x), t.terrain.values(Layer::wind_y), width, height);
    const double mean_x = mean(t.terrain.values(Layer::wind_x)),
                 mean_y = mean(t.terrain.values(Layer::wind_y));
    t.blow(projected, {5, 2});
    const std::vector<float> u = t.terrain.values(Layer::wind_x), v = t.terrain.values(Layer::wind_y);
    EXPECT_GT(before, 0.1) << "there is nothing to remove";
    EXPECT_LE(relative_divergence(u, v, width, height), 5e-6);
    EXPECT_NEAR(mean(u), mean_x, 1e-5);
    EXPECT_NEAR(mean(v), mean_y, 1e-5);
  }
}

TEST_P(WindField, ProjectionLeavesADivergenceFreeWindAlone) {
  // Speed-up along a ridge that the wind follows: u(y), no divergence. Its modes have both parts.
  test::BenchTerrain t(exec(), 64, 80);
  t.set(Layer::bedrock, [](int, int y) { return 10 * (1 + std::sin(2 * pi * 2 * y / 80.0 + 0.7)); });
  t.blow(with(false, false, 1), {6, 0});
  const std::vector<float> before = t.terrain.values(Layer::wind_x);
  t.blow(with(false, true, 1), {6, 0});
  const std::vector<float> after = t.terrain.values(Layer::wind_x);
  for (std::size_t i = 0; i < before.size(); ++i) ASSERT_NEAR(after[i], before[i], 3e-6);
  for (float v : t.terrain.values(Layer::wind_y)) ASSERT_NEAR(v, 0, 3e-6);
}

TEST_P(WindField, ProjectionTakesAPureGradientAway) {
  // Speed-up across ridges: u(x) is all divergence; what is left is its mean.
  test::BenchTerrain t(exec(), 64, 48);
  t.set(Layer::bedrock, [](int x, int) { return 10 * (1 + std::sin(2 * pi * 3 * x / 64.0)); });
  t.blow(with(false, true, 1), {6, 0});
  for (float u : t.terrain.values(Layer::wind_x)) ASSERT_NEAR(u, 6 * (1 + 0.005 * 10), 1e-5);
}

DESERT_ON_EACH_BACKEND(WindField);

}  // namespace
}  // namespace desert_sim
