// Shallow water with momentum against known solutions (Delestre et al. 2013 collect them): Ritter and Stoker,
// a lake at rest, flow over a bump (Goutal & Maurel 1997), Thacker's basin, uniform flow, streams at angles.

#include <algorithm>
#include <cmath>
#include <functional>

#include "src/core/constants.hpp"
#include "test/support/bench_terrain.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

constexpr double gravity = 9.81;

WaterParameters with_momentum() {
  WaterParameters p;
  p.model = WaterModel::shallow_water;
  p.friction = 0;
  return p;
}

/// Of a decreasing or increasing function.
double root_of(double low, double high, const std::function<double(double)>& f) {
  const bool rises = f(high) > f(low);
  for (int n = 0; n < 100; ++n) {
    const double middle = 0.5 * (low + high);
    (f(middle) > 0) == rises ? high = middle : low = middle;
  }
  return 0.5 * (low + high);
}

/// A channel of three rows between walls; its first column is a wall, too, and its last one an open edge.
class Channel {
 public:
  Channel(Exec& exec, int cells, double cell_size, const std::function<double(double)>& bed)
      : terrain_(exec, cells, rows, static_cast<float>(cell_size), false), cells_(cells), l_(cell_size) {
    terrain_.set(Layer::bedrock,
                 [&](int x, int y) { return y == 0 || y == rows - 1 || x == 0 ? 100 : bed(place(x)); });
  }
  double place(int x) const { return (x + 0.5) * l_; }
  void fill(const std::function<double(double)>& depth) {
    terrain_.set(Layer::water,
                 [&](int x, int y) { return y == 0 || y == rows - 1 || x == 0 ? 0 : depth(place(x)); });
  }
  /// Gives the water this flux per metre of width [m²/s].
  void start(double flux) {
    terrain_.set(Layer::water_flux_x,
                 [&](int x, int y) { return y == 0 || y == rows - 1 || x == 0 ? 0 : flux * l_; });
  }
  /// `discharge`: into the first cells, per metre of width [m²/s]; `level`: of the sea beyond the open edge.
  void flow(const WaterParameters& p, float step, double discharge = 0, double level = -1e3) {
    if (discharge > 0)
      for (int y = 1; y < rows - 1; ++y)
        with_backend(terrain_.exec(), [&](auto& e) {
          water_sources::add_spring(e, terrain_.terrain.view(), {0, 0, 0, static_cast<float>(discharge * l_)},
                                    1.5 * l_, (y + 0.5) * l_, step, ticks_, terrain_.ledger());
        });
    ++ticks_;
    terrain_.flow(p, step, 0, static_cast<Quanta>(std::lround(level * (1 << 20))));
  }
  double depth(int x) const { return terrain_.at(Layer::water, x, 2); }
  double flux(int x) const { return terrain_.at(Layer::water_flux_x, x, 2) / l_; }
  int cells() const { return cells_; }

 private:
  static constexpr int rows = 5;
  mutable test::BenchTerrain terrain_;
  int cells_;
  double l_;
  std::uint64_t ticks_ = 0;
};

class ShallowWater : public test::OnBackend {};

/// Ritter's dam break on a dry bed, h = (2 c₀ − x/t)²/(9 g): 4/9 of the depth stands at the dam, and the
/// front runs at 2 c₀.
TEST_P(ShallowWater, ADamBreaksOnDryGroundAsRitterSays) {
  const double h0 = 2, c0 = std::sqrt(gravity * h0), l = 0.25, time = 8;
  const int cells = 800, dam = 400;
  Channel channel(exec(), cells, l, [](double) { return 0; });
  channel.fill([&](double x) { return x < dam * l ? h0 : 0; });
  for (int n = 0; n < 8; ++n) channel.flow(with_momentum(), static_cast<float>(time / 8));
  const auto expected = [&](double x) {
    const double speed = x / time;
    return speed < -c0 ? h0 : speed > 2 * c0 ? 0 : std::pow(2 * c0 - speed, 2) / (9 * gravity);
  };
  const double at_dam = 0.5 * (channel.depth(dam - 1) + channel.depth(dam));
  EXPECT_NEAR(at_dam / h0, 4.0 / 9, 0.02 * 4 / 9);
  double front = 0, expected_front = 0, error = 0;
  for (int x = 1; x < cells; ++x) {
    const double from_dam = channel.place(x) - dam * l;
    if (channel.depth(x) > 0.01 * h0) front = from_dam;
    if (expected(from_dam) > 0.01 * h0) expected_front = from_dam;
    error += std::abs(channel.depth(x) - expected(from_dam)) / (cells * h0);
  }
  EXPECT_NEAR(front / expected_front, 1, 0.03);
  EXPECT_LT(error, 0.004);
}

/// Stoker's dam break on a wet bed: the plateau between the wave that runs back and the bore, and the bore.
TEST_P(ShallowWater, ADamBreaksOnWaterAsStokerSays) {
  for (const double ratio : {0.1, 0.5}) {
    const double h0 = 2, h1 = ratio * h0, c0 = std::sqrt(gravity * h0), l = 0.5, time = 8;
    const int cells = 400, dam = 200;
    Channel channel(exec(), cells, l, [](double) { return 0; });
    channel.fill([&](double x) { return x < dam * l ? h0 : h1; });
    for (int n = 0; n < 8; ++n) channel.flow(with_momentum(), static_cast<float>(time / 8));
    const double plateau = root_of(h1, h0, [&](double h) {
      return 2 * (c0 - std::sqrt(gravity * h)) - (h - h1) * std::sqrt(gravity * (h + h1) / (2 * h * h1));
    });
    const double speed = 2 * (c0 - std::sqrt(gravity * plateau)),
                 bore = plateau * speed / (plateau - h1) * time;
    const double ends = (speed - std::sqrt(gravity * plateau)) * time;  // of the wave that runs back
    double found = 0;
    for (int x = 1; x < cells; ++x) {
      const double from_dam = channel.place(x) - dam * l;
      if (channel.depth(x) > 0.5 * (plateau + h1)) found = from_dam + 0.5 * l;
      if (from_dam > ends + 4 && from_dam < bore - 2) {
        ASSERT_NEAR(channel.depth(x) / plateau, 1, 0.02) << "ratio " << ratio << ", " << from_dam << " m";
      }
    }
    EXPECT_NEAR(found / bore, 1, 0.03) << "ratio " << ratio;
  }
}

TEST_P(ShallowWater, ALakeStaysAtRestToTheBit) {
  for (bool periodic : {true, false}) {
    test::BenchTerrain t(exec(), 48, 40, 1, periodic);
    const auto bed = [](int x, int y) {
      const double relief = 3 * std::sin(0.4 * x) * std::cos(0.3 * y) + (x > 20 && x < 28 && y > 15 ? 9 : 0) +
                            (x < 2 || y < 2 || x > 45 || y > 37 ? 9 : 0);  // an open edge is dry
      return std::ldexp(std::round(std::ldexp(relief, 20)), -20);
    };
    t.set(Layer::bedrock, bed);
    t.set(Layer::water, [&](int x, int y) { return std::max(1.5 - bed(x, y), 0.0); });
    const std::vector<Quanta> before = t.quanta(Layer::water);
    for (int n = 0; n < 20; ++n) t.flow(with_momentum(), 1, n);
    EXPECT_EQ(t.quanta(Layer::water), before) << (periodic ? "periodic" : "open");
    EXPECT_EQ(t.booked(Material::water, 1), 0);
  }
}

double bump_height(double x) { return std::max(0.0, 0.2 - 0.05 * (x - 10) * (x - 10)); }

/// Depth with this energy over the bed, q²/(2 g h²) + h = energy, above or below the critical depth.
double depth_of(double energy, double q, bool above) {
  const double critical = std::cbrt(q * q / gravity);
  const auto f = [&](double h) { return q * q / (2 * gravity * h * h) + h - energy; };
  if (f(critical) >= 0) return critical;
  return above ? root_of(critical, energy, f) : root_of(1e-3 * critical, critical, f);
}

/// Steady flow over a bump, without a jump: Bernoulli's energy is the same everywhere.
TEST_P(ShallowWater, FlowOverABumpKeepsItsEnergy) {
  struct Regime {
    const char* name;
    double q, level;
    double energy;  ///< 0: critical over the crest
  };
  for (const Regime& r : {Regime{"subcritical", 4.42, 2, 2 + 4.42 * 4.42 / (2 * gravity * 4)},
                          Regime{"transcritical", 1.53, -1e3, 0}}) {
    const double l = 0.1, critical = std::cbrt(r.q * r.q / gravity);
    const double energy = r.energy > 0 ? r.energy : 1.5 * critical + 0.2;
    Channel channel(exec(), 250, l, bump_height);
    channel.fill([&](double x) { return depth_of(energy - bump_height(x), r.q, r.energy > 0 || x < 10); });
    channel.start(r.q);
    WaterParameters p = with_momentum();
    p.sea = r.energy > 0 ? Sea::border : Sea::none;
    for (int n = 0; n < 1500; ++n) channel.flow(p, 0.05f, r.q, r.level);
    for (int x = 20; x < 240; ++x) {
      const double place = channel.place(x);
      const double expected = depth_of(energy - bump_height(place), r.q, r.energy > 0 || place < 10);
      ASSERT_NEAR(channel.depth(x) / expected, 1, 0.02) << r.name << " at " << place << " m";
    }
  }
}

/// With a jump behind the bump: energy is the same on either side of it, and momentum across it.
TEST_P(ShallowWater, AJumpStandsWhereMomentumSays) {
  const double q = 0.18, level = 0.33, l = 0.1, critical = std::cbrt(q * q / gravity);
  const double before = 1.5 * critical + 0.2, after = level + q * q / (2 * gravity * level * level);
  const auto thrust = [&](double h) { return q * q / h + 0.5 * gravity * h * h; };
  const double jump = root_of(10.5, 12, [&](double x) {
    return thrust(depth_of(before - bump_height(x), q, false)) -
           thrust(depth_of(after - bump_height(x), q, true));
  });
  const auto expected = [&](double x) {
    return x < jump ? depth_of(before - bump_height(x), q, x < 10)
                    : depth_of(after - bump_height(x), q, true);
  };
  Channel channel(exec(), 250, l, bump_height);
  channel.fill(expected);
  channel.start(q);
  WaterParameters p = with_momentum();
  p.sea = Sea::border;
  for (int n = 0; n < 3000; ++n) channel.flow(p, 0.05f, q, level);
  const double middle =
      0.5 * (depth_of(before - bump_height(jump), q, false) + depth_of(after - bump_height(jump), q, true));
  double found = 0;
  for (int x = 105; x < 140; ++x)
    if (channel.depth(x) < middle) found = channel.place(x) + 0.5 * l;
  EXPECT_NEAR(found, jump, 2 * l);
  for (int x = 20; x < 240; ++x) {
    if (std::abs(channel.place(x) - jump) < 4 * l) continue;
    ASSERT_NEAR(channel.depth(x) / expected(channel.place(x)), 1, 0.03) << "at " << channel.place(x) << " m";
  }
}

/// Thacker's planar slosh in a basin z = D (r²/a² − 1), whose shore moves: period 2π a/√(2 g D).
TEST_P(ShallowWater, ThePlanarSloshOfABasinKeepsPeriodAndAmplitude) {
  const int cells = 200;
  const double a = 50, d = 2, eta = 0.3 * a, frequency = std::sqrt(2 * gravity * d) / a;
  test::BenchTerrain t(exec(), cells, cells);
  const auto bed = [&](int x, int y) {
    const double dx = x + 0.5 - cells / 2, dy = y + 0.5 - cells / 2;
    return d * ((dx * dx + dy * dy) / (a * a) - 1);
  };
  t.set(Layer::bedrock, bed);
  t.set(Layer::water, [&](int x, int y) {
    const double top = eta * d / (a * a) * (2 * (x + 0.5 - cells / 2) - eta);
    return std::max(top - bed(x, y), 0.0);
  });
  const auto centre = [&] {
    const std::vector<Quanta> w = t.quanta(Layer::water);
    double sum = 0, moment = 0;
    for (int i = 0; i < cells * cells; ++i)
      sum += w[static_cast<std::size_t>(i)],
          moment += w[static_cast<std::size_t>(i)] * (i % cells + 0.5 - cells / 2);
    return moment / sum;
  };
  const double first = centre(), period = 2 * pi / frequency, step = period / 400;
  double largest = 0, at = 0;
  for (int n = 1; n <= 420; ++n) {
    t.flow(with_momentum(), static_cast<float>(step), n * step);
    if (n < 380) continue;
    if (const double now = centre(); now > largest) largest = now, at = n * step;
  }
  EXPECT_NEAR(at / period, 1, 0.01);
  EXPECT_GE(largest / first, 0.97);
}

/// Uniform flow with Chézy's and Manning's drag, S = c_f Fr² and q = h^(5/3) √S/n, whose inflow swings by a
/// tenth: it settles at its depth and does not break into pulses, as virtual pipes do from Fr 2/3 on.
TEST_P(ShallowWater, UniformFlowHasItsDepthAndNoPulses) {
  for (const double froude : {0.3, 0.7, 1.0, 1.4})
    for (const bool manning : {false, true}) {
      const double q = 0.2, drag = 0.01, n = 0.03, h = std::cbrt(std::pow(q / froude, 2) / gravity);
      const double slope = manning ? std::pow(q * n / std::pow(h, 5.0 / 3), 2) : drag * froude * froude;
      Channel channel(exec(), 200, 1, [&](double x) { return 20 - slope * x; });
      channel.fill([&](double) { return h; });
      channel.start(q);
      WaterParameters p = with_momentum();
      p.sea = froude < 1 ? Sea::border
                         : Sea::none;  // at the depth of the flow, which it would not have by itself
      p.drag = manning ? 0 : static_cast<float>(drag);
      p.manning = manning ? static_cast<float>(n) : 0;
      const auto run = [&](double seconds, double swing) {
        for (double t = 0; t < seconds; t += 0.5)
          channel.flow(p, 0.5f, q * (1 + swing * std::sin(2 * pi * t / 7.3)), 20 - slope * 199.5 + h);
      };
      run(200, 0.1);
      double least = 1e9, most = 0;
      for (int x = 60; x < 120; ++x)
        least = std::min(least, channel.depth(x)), most = std::max(most, channel.depth(x));
      EXPECT_GT(least, 0.85 * h) << "Fr " << froude << ", Manning " << manning;
      EXPECT_LT(most, 1.15 * h) << "Fr " << froude << ", Manning " << manning;
      run(250, 0);
      double sum = 0;
      for (int x = 60; x < 120; ++x) sum += channel.depth(x) / 60;
      EXPECT_NEAR(sum / h, 1, 0.01) << "Fr " << froude << ", Manning " << manning;
    }
}

/// A stream in a valley z = 20 − S s + k n² has the section that uniform flow has, Q = ∫ h^(5/3) √S/n dn with
/// h = h₀ − k n², at each angle to the grid. Across the diagonal it is 1.1 % too large here, in a
/// stream of 38 cells: 3.0 % where drag goes by the upstream depth.
TEST_P(ShallowWater, AStreamHasItsSectionAtEachAngle) {
  const double slope = 0.02, manning = 0.03, curvature = 0.0005, discharge = 6;
  const auto discharge_of = [&](double h0) {
    double sum = 0;
    const double half = std::sqrt(h0 / curvature), part = half / 1000;
    for (double n = 0.5 * part; n < half; n += part)
      sum += 2 * part * std::pow(h0 - curvature * n * n, 5.0 / 3) * std::sqrt(slope) / manning;
    return sum;
  };
  const double h0 = root_of(0.01, 2, [&](double h) { return discharge_of(h) - discharge; });
  const double expected = 4.0 / 3 * h0 * std::sqrt(h0 / curvature);
  for (const double degrees : {0.0, 20.0, 45.0, 90.0}) {
    const int cells = 128;
    const double angle = degrees * pi / 180, c = std::cos(angle), s = std::sin(angle), middle = cells / 2;
    test::BenchTerrain t(exec(), cells, cells, 1, false);
    const auto along = [&](double x, double y) { return (x - middle) * c + (y - middle) * s; };
    const auto across = [&](double x, double y) { return (y - middle) * c - (x - middle) * s; };
    t.set(Layer::bedrock, [&](int x, int y) {
      const double n = across(x + 0.5, y + 0.5), far = along(x + 0.5, y + 0.5);
      return 20 - slope * far + curvature * n * n + (far < -58 ? 3 : 0);
    });
    t.terrain.allocate(Layer::water);
    WaterParameters p = with_momentum();
    p.manning = static_cast<float>(manning);
    for (std::uint64_t n = 0; n < 200; ++n) {
      with_backend(exec(), [&](auto& e) {
        water_sources::add_spring(e, t.terrain.view(), {0, 0, 3, static_cast<float>(discharge)},
                                  middle - 53 * c, middle - 53 * s, 1, n, t.ledger());
      });
      t.flow(p, 1, 0);
    }
    const std::vector<Quanta> w = t.quanta(Layer::water);
    double section = 0;  // the water of a reach over its length
    for (int i = 0; i < cells * cells; ++i)
      if (const double far = along(i % cells + 0.5, i / cells + 0.5); far > -10 && far < 40)
        section += w[static_cast<std::size_t>(i)] * std::ldexp(1.0, -20) / 50;
    EXPECT_NEAR(section / expected, 1, 0.02) << degrees << " degrees";
  }
}

/// A sheet of water whose bed falls by many times its depth from cell to cell has Manning's speed, too.
/// Pushed by its own depth only, as over a step, 2 mm on a slope of 0.05 had a fifth of it.
TEST_P(ShallowWater, ASheetOnASlopeFeelsTheWholeSlope) {
  const double manning = 0.03;
  for (const auto& [slope, depth] : {std::pair{0.05, 0.002}, {0.3, 0.01}}) {
    test::BenchTerrain t(exec(), 512, 3);  // on a torus, away from the ramp's cliff
    t.set(Layer::bedrock, [slope = slope](int x, int) { return slope * (512 - x); });
    t.set(Layer::water, depth);
    WaterParameters p = with_momentum();
    p.manning = static_cast<float>(manning);
    for (int n = 0; n < 20; ++n) t.flow(p, 1, n);
    const double expected = std::pow(depth, 2.0 / 3) * std::sqrt(slope) / manning;
    for (int x = 300; x < 320; ++x)
      EXPECT_NEAR(t.at(Layer::water_velocity_x, x, 1) / expected, 1, 0.02) << "slope " << slope;
  }
}

/// Flow along an axis carries a wave of the velocity across it, v = V sin k (x − u t), and no depth changes:
/// an exact solution. On its way of half a wave upwind differences leave e^(−π² l/L) of it, 0.86 with 64
/// cells; of one that stays where it is, −1 would be found. In other tests water moves along the slope only.
TEST_P(ShallowWater, AStreamCarriesVelocityAcrossItAlong) {
  constexpr int cells = 64;
  const double depth = 1, speed = 1, across = 0.2, k = 2 * pi / cells;
  for (const bool along_x : {true, false}) {
    test::BenchTerrain t(exec(), along_x ? cells : 4, along_x ? 4 : cells);
    const auto wave = [&](double place) { return std::sin(k * (place + 0.5)); };
    t.set(Layer::water, depth);
    t.set(along_x ? Layer::water_flux_x : Layer::water_flux_y, depth * speed);
    const Layer flux_across = along_x ? Layer::water_flux_y : Layer::water_flux_x;
    t.set(flux_across, [&](int x, int y) { return depth * across * wave(along_x ? x : y); });
    for (int n = 0; n < cells / 2; ++n) t.flow(with_momentum(), 1, n);
    double left = 0;
    for (int n = 0; n < cells; ++n) {
      const double flux = t.at(flux_across, along_x ? n : 2, along_x ? 2 : n);
      left += flux / (depth * across) * wave(n - speed * cells / 2) * 2 / cells;
    }
    EXPECT_GT(left, 0.8) << (along_x ? "along x" : "along y");
    EXPECT_LT(left, 1) << (along_x ? "along x" : "along y");
  }
}

/// By e^(−c t), whatever the depth; all other tests here are without friction.
TEST_P(ShallowWater, FrictionSlowsFlowByItsRate) {
  for (const double depth : {0.05, 0.5}) {
    test::BenchTerrain t(exec(), 8, 8);
    t.set(Layer::water, depth).set(Layer::water_flux_x, depth).set(Layer::water_flux_y, -0.5 * depth);
    WaterParameters p = with_momentum();
    p.friction = 0.1f;
    for (int n = 0; n < 10; ++n) t.flow(p, 1, n);
    for (const auto& [flux, before] : {std::pair{Layer::water_flux_x, 1.0}, {Layer::water_flux_y, -0.5}})
      EXPECT_NEAR(t.at(flux, 4, 4) / depth / before, std::exp(-1.0), 0.01) << "depth " << depth;
  }
}

DESERT_ON_EACH_BACKEND(ShallowWater);

}  // namespace
}  // namespace desert_sim
