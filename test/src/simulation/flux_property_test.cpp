// The layers flux_x and flux_y are of the very sand that moves, and looking at them changes nothing.

#include <cmath>

#include "test/support/world.hpp"

namespace desert_sim {
namespace {

class Flux : public test::OnBackend {
 protected:
  static double sum(const std::vector<float>& values) {
    double total = 0;
    for (float v : values) total += static_cast<double>(v);
    return total;
  }
};

/// First moment of all sand [quanta · cells] along x and y.
std::pair<double, double> moment(const Simulation& s) {
  const int width = s.scenario().grid.width;
  double x = 0, y = 0;
  for (Layer layer : {Layer::sand, Layer::airborne_sand}) {
    const std::vector<Quanta> sand = test::quanta(s, layer);
    for (std::size_t i = 0; i < sand.size(); ++i) {
      x += static_cast<double>(sand[i]) * static_cast<double>(i % static_cast<std::size_t>(width));
      y += static_cast<double>(sand[i]) * static_cast<double>(i / static_cast<std::size_t>(width));
    }
  }
  return {x, y};
}

/// A heap that hops in the middle of a grid whose borders it does not reach: the way of its centre of mass is
/// the sum of the flux. Hops are whole multiples of 2⁻¹⁶ cells, and the shares of the four cells whole
/// quanta.
TEST_P(Flux, IsTheMotionOfTheCentreOfMass) {
  for (const char* run : {"run: {time_step: 1}", "run: {time_step: 0.25}", "run: {time_step: 3}",
                          "saltation: {flux: true, hop_time: 0.4}"}) {
    SCOPED_TRACE(run);
    const std::string saltation =
        std::string(run).find("saltation") == std::string::npos ? "saltation: {flux: true}\n" : "";
    auto s =
        simulation("grid: {width: 96, height: 64, cell_size: 2}\n" + saltation +
                   "terrain: [cone: {layer: sand, shape: gaussian, x: 80, y: 60, height: 4, radius: 8}]\n"
                   "reptation: {strength: 0}\navalanching: {enabled: false}\n"
                   "wind: {speed: 5, direction_deg: 25}\n" +
                   run + "\n");
    const double cell = s->scenario().grid.cell_size, quantum = s->terrain().scale().quantum(),
                 step = static_cast<double>(s->scenario().run.time_step);
    for (int n = 0; n < 3; ++n) {
      const auto before = moment(*s);
      s->step();
      const auto after = moment(*s);
      const double way_x = (after.first - before.first) * quantum * cell,  // [m · m] over all cells
          way_y = (after.second - before.second) * quantum * cell;
      const double flux_x = sum(test::real(*s, Layer::flux_x)) * step,
                   flux_y = sum(test::real(*s, Layer::flux_y)) * step;
      EXPECT_GT(flux_x, 1);
      EXPECT_NEAR(flux_x, way_x, 2e-3 * std::abs(way_x)) << "step " << n;
      EXPECT_NEAR(flux_y, way_y, 2e-3 * std::abs(way_x)) << "step " << n;
    }
  }
}

/// Over a flat bed it comes to ε T |w| / p, whatever the time step.
TEST_P(Flux, OfAFlatBedIsThatOfTheEquations) {
  for (double step : {0.25, 1.0, 4.0}) {
    auto s = simulation(
        "grid: {width: 8, height: 8}\nterrain: [uniform: {layer: sand, value: 50}]\n"
        "wind: {speed: 6, warping: false, projection: false}\nsaltation: {flux: true}\n"
        "wind_shadow: {enabled: false}\nreptation: {strength: 0}\nrun: {time_step: " +
        std::to_string(step) + "}\n");
    while (s->time() < 40) s->step();
    const std::vector<float> x = test::real(*s, Layer::flux_x), y = test::real(*s, Layer::flux_y),
                             wind = test::real(*s, Layer::wind_x);
    for (std::size_t i = 0; i < x.size(); ++i) {
      ASSERT_NEAR(wind[i], 6, 0.1) << "the sand in the air is missing from the bed's height";
      ASSERT_NEAR(x[i], wind[i] / 0.6, 1e-3) << step;
      ASSERT_NEAR(y[i], 0, 1e-3) << step;
    }
  }
}

TEST_P(Flux, LookingAtItChangesNothing) {
  const std::string text =
      "grid: {width: 24, height: 20}\nterrain: [noise: {layer: sand, low: 0, high: 3}]\n"
      "wind: {speed: 6}\n";
  auto plain = simulation(text), measured = simulation(text + "saltation: {flux: true}\n");
  test::run(*plain, 9);
  test::run(*measured, 9);
  EXPECT_EQ(plain->state().hash(), measured->state().hash());
  EXPECT_EQ(test::real(*plain, Layer::flux_x), std::vector<float>(24 * 20));
  measured->apply(command::SetParameters{{"saltation.flux=false"}});
  EXPECT_FALSE(measured->terrain().has(Layer::flux_x));
}

DESERT_ON_EACH_BACKEND(Flux);

}  // namespace
}  // namespace desert_sim
