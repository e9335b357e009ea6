// The flux of continuum transport over level ground, past edges, and over what is not bare dry sand.

#include <cmath>
#include <numeric>

#include "test/kernels/sand/continuum_worlds.hpp"

namespace desert_sim {
namespace {

constexpr const char* level =
    "sand: {model: continuum}\nsaltation: {flux: true}\n"
    "shear_stress: {in_phase: 0, in_quadrature: 0}\navalanching: {enabled: false}\n";

std::string windy(double ratio, double degrees) {
  return "wind: {speed: " + std::to_string(test::wind_of(ratio)) +
         ", direction_deg: " + std::to_string(degrees) + "}\n";
}

class ContinuumFlux : public test::OnBackend {};

/// Over a bed that is full of sand, the flux is the saturated one within 1 %, in the wind's direction, at any
/// time step, and the bed stays as it is but for the rounding of what passes.
TEST_P(ContinuumFlux, OverLevelSandIsTheSaturatedOne) {
  for (const double degrees : {0.0, 33.0, 90.0, 215.0, 300.0})
    for (const double seconds : {1.0, 60.0, 900.0}) {
      SCOPED_TRACE(std::to_string(degrees) + " deg, " + std::to_string(seconds) + " s");
      auto s =
          simulation("grid: {width: 48, height: 40}\nterrain: [uniform: {layer: sand, value: 3}]\n" +
                     windy(1.7, degrees) + level + "run: {time_step: " + std::to_string(seconds) + "}\n");
      for (int n = 0; n < 90; ++n) s->step();
      const double q = test::flux_of(1.7), angle = degrees * pi / 180;
      EXPECT_NEAR(test::mean(test::real(*s, Layer::flux_x)), q * std::cos(angle), 0.01 * q);
      EXPECT_NEAR(test::mean(test::real(*s, Layer::flux_y)), q * std::sin(angle), 0.01 * q);
      test::expect_sound(*s, "at the end");
    }
}

/// Laws by name, from the formulas of their sources in shear velocities.
TEST_P(ContinuumFlux, FollowsTheLawThatIsNamed) {
  const double air = 1.225, grain = 2650, d = 0.00025, g = 9.81, packing = 0.6, r = 1.8;
  const double u_t = 0.1 * std::sqrt((grain / air - 1) * g * d), u = r * u_t,
               unit = air / g / (grain * packing);
  const std::pair<const char*, double> laws[] = {
      {"bagnold", 1.8 * unit * u * u * u},
      {"kawamura", 2.78 * unit * (u - u_t) * (u + u_t) * (u + u_t)},
      {"lettau", 4.2 * unit * u * u * (u - u_t)},
      {"quadratic", 7.8 * 0.1 * (0.01 * (r * r - 1)) * d * std::sqrt((grain / air - 1) * g * d) / packing}};
  for (const auto& [name, flux] : laws) {
    auto s = simulation("grid: {width: 32, height: 32}\nterrain: [uniform: {layer: sand, value: 3}]\n" +
                        windy(r, 0) + level + "continuum: {flux_law: " + name + "}\nrun: {time_step: 300}\n");
    for (int n = 0; n < 60; ++n) s->step();
    EXPECT_NEAR(test::mean(test::real(*s, Layer::flux_x)), flux, 0.01 * flux) << name;
  }
}

/// At u_* = 1.8 u_*t, of grains of half a millimetre. The test before has those of a quarter, for which
/// d/D = 1 tells nothing.
TEST(SaturatedFlux, DependsOnTheSizeOfGrainsAsTheSourcesSay) {
  const double air = 1.225, grain = 2650, d = 0.0005, g = 9.81, packing = 0.6, r = 1.8;
  const double u_t = 0.1 * std::sqrt((grain / air - 1) * g * d), u = r * u_t,
               unit = air / g / (grain * packing);
  const std::pair<FluxLaw, double> laws[] = {
      {FluxLaw::bagnold, 1.8 * std::sqrt(2.0) * unit * u * u * u},
      {FluxLaw::kawamura, 2.78 * unit * (u - u_t) * (u + u_t) * (u + u_t)},
      {FluxLaw::lettau, 4.2 * std::sqrt(2.0) * unit * u * u * (u - u_t)},
      {FluxLaw::quadratic,
       7.8 * 0.1 * (0.01 * (r * r - 1)) * d * std::sqrt((grain / air - 1) * g * d) / packing}};
  ContinuumParameters p;
  p.grain_diameter = static_cast<float>(d);
  for (const auto& [law, told] : laws) {
    p.flux_law = law;
    const continuum::SaturatedFlux flux(p, 1.0);
    const double found = flux(static_cast<float>(r * r) * flux.threshold, flux.threshold);
    EXPECT_NEAR(found / told, 1, 1e-4) << flux_law_names[static_cast<int>(law)];
  }
  EXPECT_NEAR(continuum::saturation_length(p), 2.2 * grain / air * d, 1e-4);
}

/// A twentieth of what the ground can hold leaves it half as dry, and doubles the threshold. Tests had ground
/// so wet that no wind lifts anything.
TEST_P(ContinuumFlux, OverMoistSandHasAHigherThreshold) {
  for (const auto& [capacity, cutoff] : {std::pair{"0.3", "0.1"}, {"0.1", "0.3"}}) {
    auto s = simulation(
        "grid: {width: 32, height: 32}\nterrain: [uniform: {layer: sand, value: 3}, "
        "uniform: {layer: moisture, value: 0.015}]\n" +
        windy(1.7, 0) + level + "repose: {moisture_capacity: " + capacity + "}\nrun: {time_step: 300}\n");
    s->apply(command::SetParameters{{std::string("saltation.moisture_cutoff=") + cutoff}});
    for (int n = 0; n < 60; ++n) s->step();
    const double dry = test::flux_of(1.7), told = dry * (1.7 * 1.7 - 2) / (1.7 * 1.7 - 1);
    EXPECT_NEAR(test::mean(test::real(*s, Layer::flux_x)), told, 0.01 * dry) << cutoff;
  }
}

TEST_P(ContinuumFlux, IsNothingBelowTheThreshold) {
  auto s = simulation(
      "grid: {width: 24, height: 24}\nterrain: [noise: {layer: sand, low: 1, high: 1.5, scale: 12}]\n" +
      windy(0.8, 20) + "sand: {model: continuum}\nrun: {time_step: 3600}\n" +
      "shear_stress: {in_phase: 0, in_quadrature: 0}\n");
  const std::vector<Quanta> before = test::quanta(*s, Layer::sand);
  test::run(*s, 24);
  EXPECT_EQ(test::quanta(*s, Layer::sand), before);
}

/// Downwind of an edge from rock to sand, the flux is q_s (1 − e^(−x/L_sat)), to 5 %. The rock is at the
/// level of the sand, and the stress does not answer to what is eroded in the short time.
TEST_P(ContinuumFlux, GrowsPastAnEdgeFromRockToSandOverTheSaturationLength) {
  for (const double degrees : {0.0, 30.0, 180.0, 270.0}) {
    SCOPED_TRACE(degrees);
    const bool along_x = degrees != 270.0;
    const std::string base = std::string("grid: {width: ") + (along_x ? "80, height: 24" : "24, height: 80") +
                             ", boundary: open, cell_size: 0.5}\n" + windy(1.7, degrees) + level +
                             "continuum: {saturation_length: 2}\nrun: {time_step: 10}\n";
    const auto place = [&](int x, int y) { return along_x ? (degrees == 180.0 ? 79 - x : x) : 79 - y; };
    auto s = test::with_sand(
        exec(), base, [&](int x, int y) { return place(x, y) < 20 ? 0 : 1.0; }, true);
    test::run(*s, 3);
    const std::vector<float> flux_x = test::real(*s, Layer::flux_x), flux_y = test::real(*s, Layer::flux_y);
    const double q = test::flux_of(1.7);
    for (int n = 20; n < 60; ++n) {
      const int x = along_x ? (degrees == 180.0 ? 79 - n : n) : 12, y = along_x ? 12 : 79 - n;
      const auto i = static_cast<std::size_t>(y * s->scenario().grid.width + x);
      const double way = (n - 20 + 0.5) * 0.5 / (degrees == 30.0 ? std::cos(pi / 6) : 1);
      const double told = q * (1 - std::exp(-way / 2));
      EXPECT_NEAR(std::hypot(flux_x[i], flux_y[i]), told, 0.05 * (n > 22 ? told : q)) << "cell " << n;
    }
  }
}

DESERT_ON_EACH_BACKEND(ContinuumFlux);

}  // namespace
}  // namespace desert_sim
