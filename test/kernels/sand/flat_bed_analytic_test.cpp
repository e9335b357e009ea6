// A flat deep bed under a uniform wind: after n steps h = h0 − ε(1 − p)/p·[1 − (1 − p)^n], airborne → ε(1 −
// p)/p, flux → ε|w|Δt/p.

#include "test/support/world.hpp"

namespace desert_sim {
namespace {

class FlatBed : public test::OnBackend {};

TEST_P(FlatBed, FallsByTheGeometricSeriesAndFillsTheAir) {
  for (const auto& [lift, bounce] : {std::pair{1.0, 0.4}, {0.7, 0.25}, {2.0, 0.6}}) {
    auto s = simulation(
        "grid: {width: 64, height: 48}\nterrain: [uniform: {layer: sand, value: 50}]\n"
        "wind: {speed: 5.3, direction_deg: 17, speedup: 0}\nsaltation: {lift: " +
        std::to_string(lift) + ", bounce_on_sand: " + std::to_string(bounce) + "}\n");
    const double p = 1 - bounce;
    const auto mean_of = [&](Layer layer) {
      double sum = 0;
      for (Quanta q : test::quanta(*s, layer)) sum += q * s->terrain().scale().quantum();
      return sum / (64 * 48);
    };
    for (int n = 1; n <= 25; ++n) {
      s->step();
      const double air = lift * (1 - p) / p * (1 - std::pow(1 - p, n));
      EXPECT_NEAR(mean_of(Layer::airborne_sand), air, 1e-6) << "step " << n;
      EXPECT_NEAR(mean_of(Layer::sand), 50 - air, 1e-6) << "step " << n;
      // A cell: up to three quanta that the four shares leave, a step.
      for (float v : s->terrain().values(Layer::sand)) ASSERT_NEAR(v, 50 - air, 2e-5) << "step " << n;
      for (float v : s->terrain().values(Layer::airborne_sand)) ASSERT_NEAR(v, air, 2e-5) << "step " << n;
    }
  }
}

/// Flux over the lee edge of an open bed, per metre of edge and second, whatever the time step. When hops
/// took a whole step it was proportional to the step: 20 times too small at 0.05 s.
TEST_P(FlatBed, FluxIsLiftTimesWindOverTheShareThatStays) {
  for (const double dt : {2.0, 1.0, 0.5, 0.25, 0.05}) {
    auto s = simulation(
        "grid: {width: 160, height: 16, boundary: open}\nterrain: [uniform: {layer: sand, value: 200}]\n"
        "wind: {speed: 4, direction_deg: 0, speedup: 0, warping: false, projection: false}\nwind_shadow: "
        "{enabled: false}\n"
        "avalanching: {enabled: false}\nrun: {time_step: " +
        std::to_string(dt) + "}\n");
    test::run(*s, static_cast<int>(30 / dt));
    const auto before = s->state().balance()[static_cast<std::size_t>(Material::sand)];
    s->step();
    const auto after = s->state().balance()[static_cast<std::size_t>(Material::sand)];
    const double volume = after.cubic_metres(after.out - before.out);
    // The air carries ε T/p, of which the share Δt/T leaves over a strip of w T; T = 1 s.
    EXPECT_NEAR(volume / (16 * dt), 4 / 0.6, 1e-4 / dt) << "dt " << dt;
  }
}

/// After n steps of which each lets the share φ = Δt/T hop, the air holds ε T (1 − p)/p · [1 − (1 − φ p)^n].
/// When hops took a whole step it held φ times as much: half at Δt = ½ T.
TEST_P(FlatBed, AirborneSandDoesNotDependOnTheTimeStep) {
  for (const double hop_time : {1.0, 0.4})
    for (const double share : {1.0, 0.5, 0.25, 0.05}) {
      auto s = simulation(
          "grid: {width: 24, height: 16}\nterrain: [uniform: {layer: sand, value: 50}]\n"
          "wind: {speed: 5.3, direction_deg: 17, speedup: 0}\nsaltation: {lift: 0.7, hop_time: " +
          std::to_string(hop_time) + "}\nrun: {time_step: " + std::to_string(share * hop_time) + "}\n");
      const double p = 0.6, full = 0.7 * hop_time * (1 - p) / p;
      for (int n = 1; n <= 40; ++n) {
        s->step();
        const double air = full * (1 - std::pow(1 - share * p, n));
        // A share leaves up to half a quantum over, a step, which waits for at most 1/φ steps.
        for (float v : s->terrain().values(Layer::airborne_sand))
          ASSERT_NEAR(v, air, 2e-5) << "share " << share << ", step " << n;
      }
    }
}

TEST_P(FlatBed, SettlesToItsDepthLessWhatIsInTheAirAndKeepsMassExactly) {
  auto s = simulation(
      "grid: {width: 33, height: 65}\nterrain: [uniform: {layer: sand, value: 10}]\nwind: {speed: 7, "
      "direction_deg: -100}\n");
  test::run(*s, 60);
  test::expect_sound(*s, "after 60 steps");
  for (float v : s->terrain().values(Layer::sand)) ASSERT_NEAR(v, 10 - 2.0 / 3, 1e-5);
}

/// On rock with no sand on the ground the air empties by (1 − p) a step where nothing is lifted.
TEST_P(FlatBed, AirEmptiesGeometricallyOverSandThatIsNotLifted) {
  auto s = simulation(
      "grid: {width: 20, height: 20}\nterrain: [uniform: {layer: sand, value: 5}, uniform: {layer: "
      "airborne_sand, value: 1}]\n"
      "wind: {speed: 5}\nsaltation: {lift: 0}\n");
  for (int n = 1; n <= 12; ++n) {
    s->step();
    double mean = 0;
    for (float v : s->terrain().values(Layer::airborne_sand)) {
      mean += v / 400;
      // In thinner air single cells differ: a few quanta land in one of four cells, by dice.
      if (n <= 9) {
        ASSERT_NEAR(v, std::pow(0.4, n), 5e-6);
      }
    }
    ASSERT_NEAR(mean, std::pow(0.4, n), 1e-6);
  }
}

DESERT_ON_EACH_BACKEND(FlatBed);

}  // namespace
}  // namespace desert_sim
