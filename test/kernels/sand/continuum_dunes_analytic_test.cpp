// Dunes in real units: what a step of an hour and one of minutes make of them, what shelters, holds and wets
// the sand, and that none of it is lost.

#include <algorithm>
#include <cmath>

#include "test/kernels/sand/continuum_worlds.hpp"

namespace desert_sim {
namespace {

const std::string heap =
    "grid: {width: 120, height: 80}\n"
    "terrain: [cone: {layer: sand, shape: gaussian, x: 40, y: 40, radius: 8, height: 4}]\n"
    "wind: {speed: 9}\nsand: {model: continuum}\n";

/// Centre of the sand, in the air and on the ground, along x [m], and the height of its top.
std::pair<double, double> place_and_height(const Simulation& s) {
  double all = 0, moment = 0, top = 0;
  for (Layer layer : {Layer::sand, Layer::airborne_sand}) {
    const std::vector<Quanta> sand = test::quanta(s, layer);
    for (std::size_t i = 0; i < sand.size(); ++i) {
      all += sand[i];
      moment += static_cast<double>(sand[i]) *
                static_cast<double>(i % static_cast<std::size_t>(s.terrain().grid().width));
      top = std::max(top, static_cast<double>(sand[i]) * s.terrain().scale().quantum());
    }
  }
  return {moment / all * static_cast<double>(s.terrain().grid().cell_size), top};
}

class ContinuumDunes : public test::OnBackend {
 protected:
  std::unique_ptr<Simulation> after(const std::string& yaml, double time_step, double seconds) {
    auto s = simulation(yaml + "run: {time_step: " + std::to_string(time_step) + "}\n");
    test::run(*s, static_cast<int>(std::lround(seconds / time_step)));
    test::expect_sound(*s, "at the end");
    return s;
  }
};

/// The order of the scheme is one: steps from ten minutes to four hours, which are divided by themselves,
/// lead a dune as far within 5 %.
TEST_P(ContinuumDunes, MoveAsFarAtAnyTimeStep) {
  constexpr double days = 6, day = 86400;
  const auto reference = place_and_height(*after(heap, 600, days * day));
  EXPECT_GT(reference.first - 40, 1.5) << "m in six days";
  for (const double step : {1800.0, 3600.0, 14400.0}) {
    const auto seen = place_and_height(*after(heap, step, days * day));
    EXPECT_NEAR(seen.first - 40, reference.first - 40, 0.05 * (reference.first - 40)) << step;
    EXPECT_NEAR(seen.second, reference.second, 0.03 * reference.second) << step;
  }
}

TEST_P(ContinuumDunes, DivideStepsThatAreTooLongForTheWind) {
  const auto parts = [&](double speed, double step) {
    const std::string yaml =
        "grid: {width: 40, height: 24}\nsand: {model: continuum}\nwind: {speed: " + std::to_string(speed) +
        "}\nrun: {time_step: " + std::to_string(step) + "}\n";
    return simulation(yaml)->pipeline().parts();
  };
  EXPECT_EQ(parts(9, 600), 1);
  EXPECT_GT(parts(9, 36000), 4);
  EXPECT_GT(parts(15, 36000), 2 * parts(9, 36000));
  EXPECT_EQ(parts(3, 86400), 1) << "the wind carries nothing";
}

/// What blows out over open edges, and in as influx, is booked; the ledger has no residual.
TEST_P(ContinuumDunes, OverOpenEdgesNothingIsLost) {
  for (const double degrees : {0.0, 40.0, 135.0, 250.0}) {
    auto s = after(
        "grid: {width: 40, height: 32, boundary: open}\nterrain: [uniform: {layer: sand, value: 1}]\n"
        "wind: {speed: 10, direction_deg: " +
            std::to_string(degrees) + "}\nsand: {model: continuum}\nsaltation: {influx: 5.0e-6}\n",
        1800, 30 * 1800);
    const MaterialBalance sand = s->state().balance()[static_cast<std::size_t>(Material::sand)];
    EXPECT_GT(sand.in, 0);
    EXPECT_GT(sand.out, sand.in) << "the edges are worn";
  }
}

/// Into the windward corner came the influx of both edges: it rose by 0.2 m, where the edges were worn.
TEST_P(ContinuumDunes, InfluxIntoACornerIsThatOfItsEdges) {
  auto s = after(
      "grid: {width: 40, height: 40, boundary: open}\nterrain: [uniform: {layer: sand, value: 5}]\n"
      "wind: {speed: 9, direction_deg: 45}\nsand: {model: continuum}\nsaltation: {influx: 1.0e-5}\n",
      600, 200 * 600);
  const std::vector<float> sand = s->terrain().values(Layer::sand);
  const double corner = sand[0], along_x = sand[8], along_y = sand[8 * 40];
  EXPECT_NEAR(corner, along_x, 0.05);
  EXPECT_NEAR(corner, along_y, 0.05);
}

/// Under the bubble behind a step of rock there is no stress, downwind of it there is.
TEST_P(ContinuumDunes, TheFlowSeparatesBehindAStep) {
  auto s = simulation(
      "grid: {width: 120, height: 20, boundary: open}\n"
      "terrain: [column: {layer: bedrock, x: 30, y: 10, size_x: 20, size_y: 400, height: 4}]\n"
      "wind: {speed: 9}\nsand: {model: continuum}\nshear_stress: {in_phase: 0, in_quadrature: 0}\n");
  s->pipeline().refresh_derived();
  const std::vector<float> wind = test::real(*s, Layer::wind_x);
  const auto at = [&](int x) { return static_cast<double>(wind[static_cast<std::size_t>(10 * 120 + x)]); };
  EXPECT_NEAR(at(10), 9, 1e-5);
  EXPECT_NEAR(at(30), 9, 1e-5) << "on the step";
  EXPECT_EQ(at(45), 0) << "5 m behind it";
  EXPECT_EQ(at(52), 0) << "12 m behind it";
  EXPECT_EQ(at(57), 0) << "4 m / tan 14 deg = 16 m behind it, where a line without a bend would end";
  EXPECT_NEAR(at(66), 9, 1e-5) << "6.5 times its height behind it";
}

/// By the wind behind a step of rock of 4 m that ends at x = 40: a longer bend makes the bubble longer, and
/// so does what counts as the lee.
TEST_P(ContinuumDunes, TheBubbleIsAsLongAsItsBendAndLeeMakeIt) {
  const auto calm_until = [&](const char* beyond, const char* setting) {
    auto s = simulation(
        "grid: {width: 160, height: 8, boundary: open}\n"
        "terrain: [column: {layer: bedrock, x: 20, y: 4, size_x: 40, size_y: 400, height: 4}" +
        std::string(beyond) +
        "]\nwind: {speed: 9}\nsand: {model: continuum}\nshear_stress: {in_phase: 0, in_quadrature: 0, " +
        setting + "}\n");
    s->pipeline().refresh_derived();
    const std::vector<float> wind = test::real(*s, Layer::wind_x);
    int x = 42;
    while (x < 159 && wind[static_cast<std::size_t>(4 * 160 + x)] == 0) ++x;
    return x - 40;
  };
  EXPECT_NEAR(calm_until("", "bend_length: 0.1"), 16, 1.5) << "4 m / tan 14 deg";
  EXPECT_NEAR(calm_until("", "bend_length: 4"), 22, 1.5);
  EXPECT_NEAR(calm_until("", "bend_length: 8"), 28, 1.5);
  const char* ramp = ", ramp: {layer: bedrock, merge: add, slope_x: -0.1}";
  EXPECT_GT(calm_until(ramp, "lee_slope: 0.05"), calm_until(ramp, "lee_slope: 0.2") + 3);
}

TEST_P(ContinuumDunes, BubblesOverASeamAreCutAtTheirLongest) {
  for (const auto& [longest, calm] : {std::pair{"120", true}, {"1", false}}) {
    auto s = simulation(
        "grid: {width: 120, height: 8}\n"
        "terrain: [column: {layer: bedrock, x: 108, y: 4, size_x: 20, size_y: 400, height: 4}]\n"
        "wind: {speed: 9}\nsand: {model: continuum}\nshear_stress: {in_phase: 0, in_quadrature: 0, "
        "longest_bubble: " +
        std::string(longest) + "}\n");
    s->pipeline().refresh_derived();
    EXPECT_EQ(test::real(*s, Layer::wind_x)[4 * 120 + 5] == 0, calm) << longest;
  }
}

/// The largest stress is before the crest, and a ridge across the wind speeds it up.
TEST_P(ContinuumDunes, TheStressIsLargestBeforeTheCrest) {
  auto s = test::with_sand(
      exec(), "grid: {width: 96, height: 8, cell_size: 1}\nwind: {speed: 9}\nsand: {model: continuum}\n",
      [](int x, int) { return 2 + std::cos(2 * pi * (x + 0.5) / 48); });
  s->pipeline().refresh_derived();
  const std::vector<float> wind = test::real(*s, Layer::wind_x);
  const auto highest = std::max_element(wind.begin() + 24, wind.begin() + 72);
  const auto before = 48 - (highest - wind.begin());  // the crest is at 47.5
  EXPECT_NEAR(static_cast<double>(before), 48 * std::atan(2 / 3.5) / (2 * pi), 1.5);
  EXPECT_GT(*highest, 9.5F);
}

/// Sand that is wet, overgrown, under water or under an obstacle stays; between plants it gathers.
TEST_P(ContinuumDunes, SparesWhatHoldsTheSand) {
  const std::string bed =
      "grid: {width: 48, height: 24}\nwind: {speed: 9}\nsand: {model: continuum}\nsaltation: {flux: true}\n"
      "shear_stress: {in_phase: 0, in_quadrature: 0}\n"
      "terrain: [uniform: {layer: sand, value: 2}";
  for (const char* held :
       {", uniform: {layer: moisture, value: 0.2}]\n", ", uniform: {layer: vegetation, value: 0.9}]\n",
        ", uniform: {layer: water, value: 0.5}]\n"}) {
    auto s = after(bed + held, 600, 12000);
    EXPECT_EQ(test::mean(test::real(*s, Layer::flux_x)), 0) << held;
  }
  auto plants = after(bed +
                          ", column: {layer: vegetation, merge: replace, x: 24, y: 12, size_x: 6, size_y: "
                          "100, height: 0.5}]\n",
                      600, 60000);
  const std::vector<float> sand = plants->terrain().values(Layer::sand);
  const auto at = [&](int x) { return sand[static_cast<std::size_t>(12 * 48 + x)]; };
  EXPECT_GT(at(21), 2.05F) << "at the edge of the plants";
  EXPECT_LT(at(29), 1.95F) << "behind them";
}

/// An obstacle neither takes nor gives: what comes goes on, and lies behind it.
TEST_P(ContinuumDunes, SandPassesObstacles) {
  auto s = after(
      "grid: {width: 48, height: 24}\nterrain: [uniform: {layer: sand, value: 2}, "
      "obstacle: {shape: box, x: 24, y: 12, size_x: 4, size_y: 4, height: 0.0}]\n"
      "wind: {speed: 9}\nsand: {model: continuum}\nshear_stress: {in_phase: 0, in_quadrature: 0}\n",
      600, 6000);
  const std::vector<float> sand = s->terrain().values(Layer::sand),
                           obstacle = s->terrain().values(Layer::obstacle);
  int solid = 0;
  for (std::size_t i = 0; i < sand.size(); ++i)
    if (obstacle[i] > 0) {
      ++solid;
      EXPECT_EQ(sand[i], 2.0F);
    }
  EXPECT_EQ(solid, 16);
}

/// Sand that passes over rock wears it, in proportion to the flux and to the time.
TEST_P(ContinuumDunes, SandThatPassesWearsRock) {
  const auto worn = [&](double influx, double seconds) {
    auto s = after(
        "grid: {width: 24, height: 24, boundary: open}\nwind: {speed: 9}\nabrasion: {rate: 0.001}\n"
        "sand: {model: continuum}\nsaltation: {influx: " +
            std::to_string(influx) +
            "}\n"
            "shear_stress: {in_phase: 0, in_quadrature: 0}\nterrain: [uniform: {layer: bedrock, value: 5}]\n",
        60, seconds);
    return static_cast<double>(s->state().balance()[static_cast<std::size_t>(Material::bedrock)].out);
  };
  const double once = worn(2e-6, 6000);
  EXPECT_NEAR(once, 24 * 24 * 2e-6 * 0.001 * 6000 * 1048576, 0.05 * once);
  EXPECT_NEAR(worn(4e-6, 6000), 2 * once, 0.05 * once);
  EXPECT_NEAR(worn(2e-6, 12000), 2 * once, 0.05 * once);
}

DESERT_ON_EACH_BACKEND(ContinuumDunes);

}  // namespace
}  // namespace desert_sim
