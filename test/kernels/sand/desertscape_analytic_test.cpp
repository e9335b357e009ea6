// Events of desertscape_2019 beside the expected values of saltation's hops.

#include "src/core/error.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

class Desertscape : public test::OnBackend {
 protected:
  /// Sand that leaves an open strip over its lee edge in a time [m³].
  static double leaving(Simulation& s, int steps) {
    const auto out = [&] { return s.state().balance()[static_cast<std::size_t>(Material::sand)]; };
    const auto before = out();
    test::run(s, steps);
    const auto after = out();
    return after.cubic_metres(after.out - before.out);
  }
};

const std::string even_wind =
    "wind: {speed: 4, speedup_law: venturi, speedup: 0, warping: false, projection: false}\n"
    "wind_shadow: {enabled: false}\navalanching: {enabled: false}\n";

/// ε slabs leave a metre of a deep bed at the rate L/ε and go w T/p: the flux is L w T/p, with p = 0.6,
/// whatever the slab, the time step and the reptation of level ground. 6000 slabs and more leave: their
/// scatter is 2 % at most.
TEST_P(Desertscape, FluxOverADeepBedIsThatOfHops) {
  for (const auto& [slab, dt] : {std::pair{0.1, 1.0}, {0.1, 0.05}, {0.02, 0.25}}) {
    auto s = simulation(
        "grid: {width: 96, height: 48, boundary: open}\nterrain: [uniform: {layer: sand, "
        "value: 60}]\n" +
        even_wind + "sand: {model: desertscape_2019}\nsaltation: {lift: 0.3, hop_spread: 0, flux: true}\n" +
        "reptation: {method: off}\ndesertscape_2019: {slab: " + std::to_string(slab) +
        "}\nrun: {time_step: " + std::to_string(dt) + "}\n");
    const double flux = 0.3 * 4 / 0.6, time = 8;
    EXPECT_NEAR(leaving(*s, static_cast<int>(std::lround(time / dt))) / (48 * time), flux, 0.06 * flux)
        << "slab " << slab << ", dt " << dt;
    double mean = 0;
    for (float q : test::real(*s, Layer::flux_x)) mean += static_cast<double>(q) / (96 * 48);
    // The layer is the mean of a last step, of which short ones have few slabs.
    EXPECT_NEAR(mean, flux, (dt < 1 ? 0.15 : 0.06) * flux) << "slab " << slab << ", dt " << dt;
    test::expect_sound(*s, "at the end");
  }
}

/// Sand enters as the parameter says, whether a cell of the edge gets one slab in many steps or many at once.
TEST_P(Desertscape, InfluxIsThatOfTheParameter) {
  for (const double influx : {0.2, 60.0}) {
    auto s = simulation(
        "grid: {width: 64, height: 48, boundary: open}\nterrain: [uniform: {layer: bedrock, "
        "value: 0}]\n" +
        even_wind + "sand: {model: desertscape_2019}\nsaltation: {lift: 0.3, hop_spread: 0, influx: " +
        std::to_string(influx) + "}\nreptation: {method: off}\n");
    test::run(*s, 20);
    const auto sand = s->state().balance()[static_cast<std::size_t>(Material::sand)];
    EXPECT_NEAR(sand.cubic_metres(sand.in) / (48 * 20), influx, 0.06 * influx);
    test::expect_sound(*s, "after 20 s");
  }
}

/// A step is divided into at most 256 parts, in each of which a fourth of the cells gives a slab.
TEST_P(Desertscape, LongerStepsAreRefused) {
  try {
    simulation("sand: {model: desertscape_2019}\nrun: {time_step: 7}\n");
    FAIL() << "no error";
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("run.time_step: 7 s is 280 times desertscape_2019.slab / (4 "
                                         "saltation.lift) = 0.025 s (allowed: at most 256 times, 6.4 s)"),
              std::string::npos)
        << e.what();
  }
}

/// Bounces over bare rock wear ρ k_a |w| T times the sand that bounces. The hops have the share 1 − p twice,
/// as the sand that bounces and as a factor.
TEST_P(Desertscape, BouncesWearRockAsHopsDoPerShareThatBounces) {
  const auto worn = [&](const std::string& model) {
    auto s = simulation(
        "grid: {width: 96, height: 48, boundary: open}\nterrain: [uniform: {layer: bedrock, "
        "value: 50}]\n" +
        even_wind + "saltation: {influx: 0.2, hop_spread: 0, bare_depth: 1}\nsand: {model: " + model +
        "}\nabrasion: {rate: 1.0e-3, cover: 1}\nreptation: {method: off}\n"
        "desertscape_2019: {slab: 0.02}\n");
    const auto rock = [&s] {
      double sum = 0;
      for (float z : s->terrain().values(Layer::bedrock)) sum += static_cast<double>(z);
      return sum;
    };
    test::run(*s, 40);  // until the sand has come to the lee edge
    const double before = rock();
    test::run(*s, 20);
    test::expect_sound(*s, model);
    return before - rock();
  };
  const double by_hops = worn("hops"), by_events = worn("desertscape_2019");
  EXPECT_GT(by_hops, 0.5);
  EXPECT_NEAR(by_events / by_hops, 1 / 0.6, 0.08);
}

/// Slabs bounce over an obstacle and never rest there; what is above one after 64 bounces flies on later.
TEST_P(Desertscape, NothingRestsOnObstacles) {
  auto s = simulation(
      "grid: {width: 40, height: 30}\nterrain:\n  - uniform: {layer: sand, value: 2}\n"
      "  - uniform: {layer: airborne_sand, value: 0.3}\n"
      "  - column: {layer: obstacle, shape: cylinder, x: 20, y: 15, size_x: 9, size_y: 9, height: 1}\n"
      "run: {time_step: 0.02}\nwind: {speed: 0.05, projection: false}\nsand: {model: "
      "desertscape_2019}\nsaltation: {"
      "hop_spread: 0}\n");
  const std::vector<float> solid = test::real(*s, Layer::obstacle);
  const std::vector<Quanta> before = test::quanta(*s, Layer::sand);
  s->step();
  test::expect_sound(*s, "after a step");
  const std::vector<Quanta> sand = test::quanta(*s, Layer::sand),
                            air = test::quanta(*s, Layer::airborne_sand);
  int obstacles = 0;
  for (std::size_t i = 0; i < solid.size(); ++i) {
    if (solid[i] <= 0) continue;
    obstacles += air[i] > 0;
    EXPECT_LE(sand[i], before[i]) << "cell " << i;
  }
  EXPECT_GT(obstacles, 30) << "sand in the air";
}

/// Slabs that come down start creep from a bump, of `slab` an impact, no more than half of the bump, and none
/// under plants. The same dice without creep tell what came down.
TEST_P(Desertscape, ImpactsLetABumpCreep) {
  const auto bump = [&](const std::string& more) {
    auto s = simulation(
        "grid: {width: 24, height: 24}\nterrain:\n  - uniform: {layer: sand, value: 2}\n"
        "  - column: {layer: sand, merge: add, shape: cylinder, x: 12.5, y: 12.5, size_x: 0.5, size_y: 0.5, "
        "height: 0.4}\n"
        "  - uniform: {layer: airborne_sand, value: 0.3}\n" +
        more);
    s->step();
    test::expect_sound(*s, more);
    return static_cast<double>(test::quanta(*s, Layer::sand)[12 * 24 + 12]) * s->terrain().scale().quantum();
  };
  const std::string falling =
      "wind: {speed: 2, projection: false}\nsand: {model: desertscape_2019}\nsaltation: {lift: 0}\n";
  const double without = bump(falling + "reptation: {method: off}\n");
  ASSERT_GT(without, 2.45) << "slabs have come down on it";
  const double by_little = without - bump(falling + "reptation: {slab: 0.01}\n"),
               by_much = without - bump(falling + "reptation: {slab: 1}\n");
  EXPECT_GE(by_little, 0.009);
  EXPECT_LE(by_little, 0.1);
  EXPECT_GT(by_much, 2 * by_little);
  EXPECT_LT(by_much, 0.5 * (without - 2));
  EXPECT_NEAR(bump("  - uniform: {layer: vegetation, value: 1}\n" + falling + "reptation: {slab: 0.01}\n"),
              bump("  - uniform: {layer: vegetation, value: 1}\n" + falling + "reptation: {method: off}\n"),
              1e-9);
}

/// Sand that another model left in the air comes down.
TEST_P(Desertscape, SandInTheAirFliesOn) {
  auto s = simulation(
      "grid: {width: 32, height: 32}\nterrain: [uniform: {layer: sand, value: 1}, uniform: {layer: "
      "airborne_sand, value: 0.5}]\nwind: {speed: 5}\nsand: {model: desertscape_2019}\nsaltation: {lift: "
      "0}\n");
  s->step();
  for (Quanta q : test::quanta(*s, Layer::airborne_sand)) ASSERT_EQ(q, 0);
  test::expect_sound(*s, "after a step");
}

DESERT_ON_EACH_BACKEND(Desertscape);

}  // namespace
}  // namespace desert_sim
