// The transforms that warp the wind against closed forms: Gaussian hills, coarse grids, mirrored edges.

#include <algorithm>
#include <array>
#include <complex>

#include "test/kernels/wind/wind_field.hpp"

namespace desert_sim {
namespace {

/// Wind (speed, 0) over ground of slope g, at one radius: lerp(u, k_R g⊥, |g|) at the speed of u.
std::array<double, 2> turned(double speed, double gx, double gy, double deflection) {
  const double slope = std::hypot(gx, gy), sign = gy <= 0 ? 1 : -1;  // u · (−gy, gx) ≥ 0
  const double x = (1 - slope) * speed + slope * deflection * sign * -gy, y = slope * deflection * sign * gx;
  return {x * speed / std::hypot(x, y), y * speed / std::hypot(x, y)};
}

TEST_P(WindField, GaussianHillIsSmoothedToItsClosedForm) {
  // A exp(−r²/2s²) ⊗ Gauss(σ): peak A s²/(s² + σ²), width √(s² + σ²). Its slope is seen in how it turns the
  // wind, beside the hill's axis: to either side of that the wind turns the other way, and the coarse grid
  // blurs it.
  constexpr int n = 512;
  const double s = 15, radius = 40, sigma = 0.5 * radius, height = 20, speed = 5, deflection = 5;
  test::BenchTerrain t(exec(), n, n);
  t.set(Layer::bedrock, [&](int x, int y) {
    const double dx = x - n / 2, dy = y - n / 2;
    return height * std::exp(-0.5 * (dx * dx + dy * dy) / (s * s));
  });
  const double wide = std::sqrt(s * s + sigma * sigma), peak = height * s * s / (wide * wide);
  for (int coarsening : {1, 4}) {
    WindParameters p = with(true, false, coarsening);
    p.speedup = 0;
    p.radii = ShortList{{static_cast<float>(radius), 0, 0, 0}, 1};
    p.weights = ShortList{{1, 0, 0, 0}, 1};
    p.deflections = ShortList{{static_cast<float>(deflection), 0, 0, 0}, 1};
    t.blow(p, {static_cast<float>(speed), 0});
    for (int dy : {-30, -12, 12, 30})
      for (int dx : {-60, -25, -6, 6, 25, 60}) {
        const double slope = -peak / (wide * wide) * std::exp(-0.5 * (dx * dx + dy * dy) / (wide * wide));
        const auto [u, v] = turned(speed, slope * dx, slope * dy, deflection);
        const int x = n / 2 + dx, y = n / 2 + dy;
        EXPECT_NEAR(t.at(Layer::wind_x, x, y), u, 0.005 * speed)
            << "coarsening " << coarsening << ", at " << dx << ", " << dy;
        EXPECT_NEAR(t.at(Layer::wind_y, x, y), v, 0.005 * speed)
            << "coarsening " << coarsening << ", at " << dx << ", " << dy;
      }
  }
}

/// A wave of the ground is averaged onto the coarse grid, multiplied by the transfer function, and
/// interpolated back: what is left of it is the Gaussian's e^(−½σ²k²), whatever the coarsening. The
/// tolerances of the test below let a transfer function pass that does not undo the averaging and the
/// interpolation.
TEST_P(WindField, TransferUndoesTheCoarsening) {
  constexpr int cells = 192, mode = 16;
  const double k = 2 * pi * mode / cells, sigma = 3;
  for (const int coarsening : {1, 2, 4}) {
    WindParameters p = with(true, false, coarsening);
    p.radii = ShortList{{static_cast<float>(2 * sigma), 0, 0, 0}, 1};
    const wind::Workspace work = wind::make_workspace(exec(), Grid{cells, cells, 1}, p);
    const int coarse = work.coarse.width;
    ASSERT_EQ(coarse, cells / coarsening);
    std::vector<double> means;
    for (int n = 0; n < coarse; ++n)
      means.push_back(wind::box_mean(static_cast<float>(n * coarsening),
                                     static_cast<float>((n + 1) * coarsening), cells,
                                     [k](int i) { return static_cast<float>(std::cos(k * (i + 0.5))); }));
    std::complex<double> left = 0;
    for (int x = 0; x < cells; ++x) {
      const wind::AxisInterpolation at = work.coarse.interpolation_x(x);
      const auto mean = [&](int n) { return static_cast<float>(means[static_cast<std::size_t>(n)]); };
      const double value = at(mean(at.before), mean(at.nearest), mean(at.after));
      left += value * std::polar(2.0 / cells, -k * (x + 0.5));
    }
    const double transfer = work.along_x[0].download()[mode].smooth * static_cast<double>(coarse);
    // The transfer function takes the interpolation for a continuous one, which costs 1.2 % at this
    // wavelength of 12 cells; without undoing anything 12 % are missing at a coarsening of 2, and 43 % at 4.
    EXPECT_NEAR(left.real() * transfer / std::exp(-0.5 * sigma * sigma * k * k), 1, 0.015) << coarsening;
  }
}

/// The grid of the transforms is coarsened to about a quarter of the smallest σ. Against full resolution the
/// wind differs by at most 2 % of its speed anywhere, 0.5 % rms, on terrain with features down to the hop
/// length.
TEST_P(WindField, CoarseTransformsAreCloseToFullResolution) {
  for (bool periodic : {true, false}) {
    constexpr int width = 384, height = 256;
    test::BenchTerrain t(exec(), width, height, 1, periodic);
    t.set(Layer::bedrock,
          [&](int x, int y) { return hills(x, y, width, height) + ((x / 8 + y / 8) % 2 ? 1.0 : 0.0); });
    t.blow(with(true, false, 1), {5, 2});
    const std::vector<float> u = t.terrain.values(Layer::wind_x), v = t.terrain.values(Layer::wind_y);
    t.blow(with(true, false, 0), {5, 2});
    const std::vector<float> cu = t.terrain.values(Layer::wind_x), cv = t.terrain.values(Layer::wind_y);
    double square = 0, worst = 0;
    for (std::size_t i = 0; i < u.size(); ++i) {
      const double error = std::hypot(cu[i] - u[i], cv[i] - v[i]) / std::hypot(u[i], v[i]);
      worst = std::max(worst, error);
      square += error * error / static_cast<double>(u.size());
    }
    EXPECT_LT(worst, 0.02) << (periodic ? "periodic" : "open");
    EXPECT_LT(std::sqrt(square), 0.005) << (periodic ? "periodic" : "open");
  }
}

/// Between coarse cells whose winds differ in direction, linear interpolation gives a shorter vector. The
/// tolerances above let a wind pass that is not stretched again.
TEST_P(WindField, CoarseWindKeepsItsSpeedWhereItTurns) {
  constexpr int n = 128;
  test::BenchTerrain t(exec(), n, n);
  t.set(Layer::bedrock, [](int x, int y) { return hills(x, y, n, n); });
  WindParameters p = with(true, false, 4);
  p.speedup = 0;
  p.gradient_scale = 0.6f;
  p.radii = ShortList{{16, 8, 0, 0}, 2};
  t.blow(p, {5, 2});
  const std::vector<float> u = t.terrain.values(Layer::wind_x), v = t.terrain.values(Layer::wind_y);
  double turned = 0, worst = 0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    turned = std::max(turned, std::abs(std::atan2(v[i], u[i]) - std::atan2(2.0, 5.0)));
    worst = std::max(worst, std::abs(std::hypot(u[i], v[i]) / std::hypot(5.0, 2.0) - 1));
  }
  EXPECT_GT(turned, 0.5) << "the wind goes straight on";
  EXPECT_LT(worst, 0.001);
}

TEST_P(WindField, OppositeEdgesOfAnOpenGridDoNotFeelEachOther) {
  constexpr int n = 512;
  const auto hill_at_the_west = [](int x, int y) {
    const double dx = x - 12.0, dy = y - n / 2.0;
    return 30 * std::exp(-0.5 * (dx * dx + dy * dy) / 200);
  };
  WindParameters p = with(true, false, 0);
  p.speedup = 0;
  p.radii = ShortList{{60, 30, 0, 0}, 2};
  double turned[2];
  for (bool periodic : {false, true}) {
    test::BenchTerrain t(exec(), n, n, 1, periodic);
    t.set(Layer::bedrock, hill_at_the_west);
    t.blow(p, {5, 1});
    double most = 0;
    for (int y = 0; y < n; ++y) most = std::max(most, std::abs(t.at(Layer::wind_y, n - 2, y) - 1));
    turned[periodic] = most;
    if (!periodic) {
      EXPECT_NE(t.at(Layer::wind_y, 30, n / 2 + 10), 1) << "the hill itself turns the wind";
    }
  }
  EXPECT_LT(turned[0], 1e-4) << "the east edge feels the hill at the west one";
  EXPECT_GT(turned[1], 1e-2) << "on a torus it does";
}

TEST_P(WindField, OpenEdgesAreMirrored) {
  // Mirrored about its edge, a terrain and the even periodic one of twice its size have the same wind.
  constexpr int n = 64;
  const auto h = [](int x, int y) {
    return 6 * std::cos(pi * (x + 0.5) / n) * std::cos(pi * 2 * (y + 0.5) / n) +
           4 * std::cos(pi * 3 * (x + 0.5) / n);
  };
  test::BenchTerrain open(exec(), n, n, 1, false), twice(exec(), 2 * n, 2 * n, 1, true);
  open.set(Layer::bedrock, h);
  twice.set(Layer::bedrock,
            [&](int x, int y) { return h(x < n ? x : 2 * n - 1 - x, y < n ? y : 2 * n - 1 - y); });
  WindParameters p = with(true, false, 1);
  p.radii = ShortList{{16, 8, 0, 0}, 2};
  const Quanta reference = -20 * (1 << 20);
  open.blow(p, {4, 1}, reference);
  twice.blow(p, {4, 1}, reference);
  const std::vector<float> u = open.terrain.values(Layer::wind_x), uu = twice.terrain.values(Layer::wind_x);
  double worst = 0;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x)
      worst = std::max(worst, std::abs(static_cast<double>(u[static_cast<std::size_t>(y * n + x)]) -
                                       uu[static_cast<std::size_t>(y * 2 * n + x)]));
  EXPECT_LT(worst, 2e-4);
}

}  // namespace
}  // namespace desert_sim
