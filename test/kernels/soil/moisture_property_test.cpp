// What water does to ground that nothing else moves.

#include <algorithm>

#include "test/support/bench_terrain.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

class WetGround : public test::OnBackend {};

/// A cone of soil of 39°, which stands while it is dry and slides when it is saturated. It stood, to the bit,
/// unless abrasion, hydraulic erosion or the drying of soil was on as well.
TEST_P(WetGround, SaturatedSoilSlides) {
  const auto height = [&](const char* moisture, int steps) {
    auto s = simulation(
        "grid: {width: 40, height: 40}\nwind: {speed: 0}\nmoisture: {enabled: true, diffusion: 0}\n"
        "terrain: [cone: {layer: soil, x: 20, y: 20, radius: 10, height: 8}, uniform: {layer: moisture, "
        "value: " +
        std::string(moisture) + "}]\n");
    test::run(*s, steps);
    test::expect_sound(*s, "after sliding");
    const std::vector<Quanta> soil = test::quanta(*s, Layer::soil);
    return *std::max_element(soil.begin(), soil.end());
  };
  const Quanta before = height("0", 0);
  EXPECT_EQ(height("0", 30), before);
  EXPECT_LT(height("0.3", 30), before / 10 * 6);
}

/// Sediment that came over an obstacle stayed in the water for ever, and in the air when that had dried up.
TEST_P(WetGround, SedimentSettlesOnObstaclesWhichDoNotDissolve) {
  for (double water : {0.0, 1.0}) {
    test::BenchTerrain t(exec(), 4, 4);
    t.set(Layer::bedrock, 5).set(Layer::soil, 1).set(Layer::obstacle, 1).set(Layer::water, water);
    t.set(Layer::suspended_sediment, 0.1);
    const std::vector<Quanta> bedrock = t.quanta(Layer::bedrock), soil = t.quanta(Layer::soil);
    const long long sediment = t.total(Layer::suspended_sediment);
    HydraulicErosionParameters p;
    for (int n = 0; n < 100; ++n) t.erode(p);
    EXPECT_LT(t.total(Layer::suspended_sediment), sediment / 1000) << water << " m of water";
    EXPECT_EQ(t.total(Layer::suspended_sediment) + t.total(Layer::sand), sediment);
    t.set(Layer::water_velocity_x, 3).set(Layer::sand, 0);
    for (int n = 0; n < 10; ++n) t.erode(p);
    EXPECT_EQ(t.quanta(Layer::bedrock), bedrock);
    EXPECT_EQ(t.quanta(Layer::soil), soil);
  }
}

DESERT_ON_EACH_BACKEND(WetGround);

}  // namespace
}  // namespace desert_sim
