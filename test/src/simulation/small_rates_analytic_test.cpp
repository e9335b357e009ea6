// Slow processes move what their rates say, however short the step. Amounts of a step are here down to 5e-4
// quanta. When they were rounded to nearest, or to at least one quantum, each of these tests found nothing
// moved at all, or many times too much; the comments say how much at which step.

#include <cmath>

#include "test/support/bench_terrain.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

constexpr double quantum = 1.0 / 1048576, pi = 3.14159265358979;
constexpr int side = 128;

class SmallRates : public test::OnBackend {
 protected:
  /// Runs `seconds` with steps of each length, from the same start, and expects that `moved` comes to
  /// `metres` over all cells, to 5 %.
  void expect_moved(double metres, double seconds, const std::function<void(test::BenchTerrain&)>& start,
                    const std::function<void(test::BenchTerrain&, float)>& step,
                    const std::function<double(const test::BenchTerrain&)>& moved, int width = side,
                    int height = side, bool periodic = true) {
    for (double dt : {1.0, 0.5, 0.25, 0.1, 0.01}) {
      test::BenchTerrain t(exec(), width, height, 1, periodic);
      start(t);
      const int steps = static_cast<int>(std::lround(seconds / dt));
      for (int n = 0; n < steps; ++n) step(t, static_cast<float>(dt));
      EXPECT_NEAR(moved(t) / metres, 1, 0.05) << "steps of " << dt << " s";
    }
  }
  static std::function<double(const test::BenchTerrain&)> booked(Material material, int side_of_account) {
    return [=](const test::BenchTerrain& t) {
      return static_cast<double>(t.booked(material, side_of_account)) * quantum;
    };
  }
  static constexpr double cells = side * side;

  /// Saltation in which all sand bounces, with a wind of 2 m/s.
  static SaltationParameters bouncing(float lift) {
    SaltationParameters p;
    p.lift = lift;
    p.bounce_on_sand = p.bounce_on_soil = p.bounce_on_rock = 1;
    return p;
  }
};

/// At least one quantum a step was 16 (Δt = 1) to 1600 times (0.01) too much.
TEST_P(SmallRates, OfEvaporation) {
  expect_moved(
      6e-8 * 20 * cells, 20, [](auto& t) { t.set(Layer::water, 0.01); },
      [](auto& t, float dt) { t.evaporate(6e-6f, dt); }, booked(Material::water, 1));
}

/// 0.95 of it at Δt = 1, 1.9 at 0.5, nothing from 0.25 on.
TEST_P(SmallRates, OfDryingSoil) {
  SoilParameters p;
  p.drying = 1e-6f;
  expect_moved(
      1e-6 * 5 * cells, 5, [](auto& t) { t.set(Layer::soil, 1); },
      [&](auto& t, float dt) { t.develop_soil(p, {}, dt); }, booked(Material::soil, 1));
}

/// Nothing.
TEST_P(SmallRates, OfFormingSoil) {
  SoilParameters p;
  p.forming = 1e-7f;
  expect_moved(
      1e-7 * 10 * cells, 10,
      [](auto& t) {
        t.set(Layer::sand, 1).set(Layer::humus, 0.5).set(Layer::vegetation, 1).set(Layer::moisture, 0.3);
      },
      [&](auto& t, float dt) { t.develop_soil(p, {}, dt); }, booked(Material::soil, 0));
}

/// Nothing.
TEST_P(SmallRates, OfAbrasionOfRock) {
  AbrasionParameters a;
  a.rate = 5e-8f;
  const SaltationParameters p = bouncing(0);
  expect_moved(
      5e-8 * 10 * cells, 10,
      [](auto& t) { t.set(Layer::bedrock, 10).set(Layer::airborne_sand, 0.5).set(Layer::wind_x, 2); },
      [&](auto& t, float dt) { t.saltation(p, a, {}, dt); }, booked(Material::bedrock, 1));
}

/// Nothing.
TEST_P(SmallRates, OfLift) {
  const SaltationParameters p = bouncing(1e-7f);
  expect_moved(
      1e-7 * 10 * cells, 10, [](auto& t) { t.set(Layer::sand, 1).set(Layer::wind_x, 2); },
      [&](auto& t, float dt) { t.saltation(p, {}, {}, dt); },
      [](const auto& t) { return static_cast<double>(t.total(Layer::airborne_sand)) * quantum; });
}

/// Nothing: a windward edge of 512 m.
TEST_P(SmallRates, OfInflux) {
  SaltationParameters p = bouncing(0);
  p.influx = 2e-7f;
  expect_moved(
      2e-7 * 50 * 512, 50, [](auto& t) { t.set(Layer::wind_x, 2); },
      [&](auto& t, float dt) { t.saltation(p, {}, {}, dt); }, booked(Material::sand, 0), 8, 512, false);
}

/// At least one quantum a step was 32 (Δt = 1) to 3200 times (0.01) too much.
TEST_P(SmallRates, OfSeepage) {
  MoistureParameters p;
  p.seepage_sand = 1e-7f;
  p.diffusion = p.evaporation = 0;
  expect_moved(
      3e-8 * 20 * cells, 20, [](auto& t) { t.set(Layer::sand, 2).set(Layer::water, 1); },
      [&](auto& t, float dt) { t.soak(p, 0.3f, dt); }, booked(Material::moisture, 0));
}

/// At least one quantum a step was 16 to 1600 times too much.
TEST_P(SmallRates, OfDryingGround) {
  MoistureParameters p;
  p.diffusion = 0;
  p.evaporation = 6e-6f;
  expect_moved(
      6e-8 * 20 * cells, 20, [](auto& t) { t.set(Layer::sand, 2).set(Layer::moisture, 0.1); },
      [&](auto& t, float dt) { t.soak(p, 0.3f, dt); }, booked(Material::moisture, 1));
}

/// Nothing.
TEST_P(SmallRates, OfDissolvingAndSettling) {
  HydraulicErosionParameters p;
  p.capacity = 2;
  p.deep = 1e4f;
  p.sand = p.deposit = 1e-6f;  // of a capacity of 0.1 m
  const auto erode = [&](auto& t, float dt) { t.erode(p, dt); };
  const auto flowing = [](auto& t, double speed, double sediment) {
    t.set(Layer::sand, 1).set(Layer::water, 1).set(Layer::suspended_sediment, sediment);
    t.terrain.allocate(Layer::water_velocity_x);
    t.set(Layer::water_velocity_x, speed);
  };
  expect_moved(
      1e-7 * 10 * cells, 10, [&](auto& t) { flowing(t, 1, 0); }, erode, booked(Material::sediment, 0));
  expect_moved(
      1e-7 * 10 * cells, 10, [&](auto& t) { flowing(t, 0, 0.1); }, erode, booked(Material::sediment, 1));
}

/// The part of a wave of mode 4 along x that is left [m], where it was 1e-4 m high.
double wave(const test::BenchTerrain& t, Layer layer) {
  const std::vector<Quanta> values = t.quanta(layer);
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    sum += values[i] * std::cos(2 * pi * 4 * static_cast<double>(i % side) / side);
  return sum * quantum * 2 / (side * side);
}
double height_of_wave(int x) { return 1e-4 * std::cos(2 * pi * 4 * x / side); }

/// Flows of less than a quantum through a face were cut off: nothing from Δt = 0.1 on.
TEST_P(SmallRates, OfMoistureThatSpreads) {
  MoistureParameters p;
  p.diffusion = 2;
  p.evaporation = p.seepage_sand = p.seepage_soil = 0;
  const double left = std::exp(-p.diffusion * 10 * 2 * (1 - std::cos(2 * pi * 4 / side)));
  expect_moved(
      1e-4 * left, 10,
      [](auto& t) {
        t.set(Layer::sand, 2).set(Layer::moisture, [](int x, int) { return 0.1 + height_of_wave(x); });
      },
      [&](auto& t, float dt) { t.soak(p, 0.3f, dt); },
      [](const auto& t) { return wave(t, Layer::moisture); });
}

/// Likewise what creeps from a cell to its neighbour: nothing from Δt = 0.1 on.
TEST_P(SmallRates, OfSmoothing) {
  ReptationParameters p;
  p.method = ReptationMethod::smoothing;
  p.strength = 1;
  constexpr double impacts = 2, wind = 2;
  const double towards_each = p.strength * impacts * wind / 8 * (1 - std::cos(2 * pi * 4 / side));
  const double left = std::exp(-10 * towards_each * (2 + 4 / std::sqrt(2.0)));
  expect_moved(
      1e-4 * left, 10,
      [](auto& t) {
        t.set(Layer::sand, [](int x, int) { return 1 + height_of_wave(x); }).set(Layer::wind_x, wind);
        t.set_strength([](int, int) { return impacts; });
      },
      [&](auto& t, float dt) { t.reptation(p, {}, dt); }, [](const auto& t) { return wave(t, Layer::sand); });
}

/// A single quantum a cell hops as far as the wind carries it: 5.3 cells, not 5, and half a cell, not none.
TEST_P(SmallRates, OfAirborneSandHopAsFarAsMuchSand) {
  for (double speed : {5.3, 0.4, -0.4, 1.75}) {
    test::BenchTerrain t(exec(), 64, 4096);
    t.set_quanta(Layer::airborne_sand, [](int x, int) { return x == 32 ? 1 : 0; }).set(Layer::wind_x, speed);
    t.saltation(bouncing(0));
    const std::vector<Quanta> air = t.quanta(Layer::airborne_sand);
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < air.size(); ++i) {
      sum += air[i] * (static_cast<double>(i % 64) - 32);
      count += air[i];
    }
    EXPECT_EQ(count, 4096);
    EXPECT_NEAR(sum / count, speed, 0.04);
  }
}

DESERT_ON_EACH_BACKEND(SmallRates);

}  // namespace
}  // namespace desert_sim
