// What must not move, does not.

#include "test/support/bench_terrain.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

class StillWorld : public test::OnBackend {
 protected:
  void expect_unmoved(const std::string& yaml, int steps = 5) {
    auto s = simulation(yaml);
    const auto layers = test::persistent_layers(*s);
    std::vector<std::vector<std::uint32_t>> before;
    for (Layer layer : layers) before.push_back(s->terrain().raw_words(layer));
    test::run(*s, steps);
    for (std::size_t n = 0; n < layers.size(); ++n)
      EXPECT_TRUE(before[n] == s->terrain().raw_words(layers[n])) << info(layers[n]).name << " moved";
  }
};

TEST_P(StillWorld, IsUnmovedToTheBitWithoutWind) {
  for (const char* boundary : {"periodic", "open"})
    for (const char* reptation : {"off", "adaptive_repose", "smoothing", "steepest"}) {
      SCOPED_TRACE(std::string(boundary) + ", reptation " + reptation);
      expect_unmoved("grid: {width: 37, height: 23, boundary: " + std::string(boundary) +
                     "}\nterrain: [uniform: {layer: bedrock, value: 100}, uniform: {layer: sand, value: 3}]\n"
                     "wind: {speed: 0}\nsaltation: {influx: 1}\nreptation: {method: '" +
                     std::string(reptation) +
                     "'}\n"
                     "abrasion: {rate: 0.1}\necho_dunes: {enabled: true}\n");
    }
}

TEST_P(StillWorld, GentleSlopesStayWithoutWind) {
  expect_unmoved(
      "grid: {width: 64, height: 64}\nterrain: [noise: {layer: bedrock, low: 0, high: 4, scale: 40}, "
      "uniform: {layer: sand, value: 3}]\nwind: {speed: 0}\navalanching: {quality: converged}\n");
}

TEST_P(StillWorld, GentleSlopesStayWithEveryScheme) {
  for (const char* scheme : avalanche_schemes)
    expect_unmoved(
        "grid: {width: 70, height: 50, boundary: open}\nterrain: [noise: {layer: sand, low: 0, high: 6, "
        "scale: 40}]\n"
        "saltation: {enabled: false}\nreptation: {method: smoothing}\navalanching: {scheme: " +
        std::string(scheme) + "}\n");
}

TEST_P(StillWorld, BareRockStaysUnderWind) {
  expect_unmoved(
      "grid: {width: 40, height: 40}\nterrain: [noise: {layer: bedrock, low: 0, high: 30, scale: 10}]\nwind: "
      "{speed: 9}\n");
}

TEST_P(StillWorld, UniformSandUnderUniformWindStaysUniform) {
  auto s = simulation(
      "grid: {width: 37, height: 41}\nterrain: [uniform: {layer: sand, value: 20}]\nwind: {speed: 5.3, "
      "direction_deg: 34}\n");
  test::run(*s, 10);
  const auto sand = test::quanta(*s, Layer::sand), air = test::quanta(*s, Layer::airborne_sand);
  for (std::size_t i = 0; i < sand.size(); ++i) {
    EXPECT_NEAR(sand[i], sand[0], 4);  // what rounding of four shares leaves
    EXPECT_NEAR(air[i], air[0], 4);
  }
}

TEST_P(StillWorld, NothingIsLiftedBelowTheThreshold) {
  expect_unmoved(
      "grid: {width: 20, height: 20}\nterrain: [uniform: {layer: sand, value: 2}]\nwind: {speed: 4.9}\n"
      "saltation: {threshold_speed: 5}\n");
}

TEST_P(StillWorld, SaturatedSandIsNotLifted) {
  expect_unmoved(
      "grid: {width: 20, height: 20}\nterrain: [uniform: {layer: sand, value: 2}, uniform: {layer: moisture, "
      "value: 0.3}]\n"
      "wind: {speed: 9}\n");
}

TEST_P(StillWorld, SandUnderWaterIsNotLifted) {
  expect_unmoved(
      "grid: {width: 20, height: 20}\nterrain: [uniform: {layer: sand, value: 2}, uniform: {layer: water, "
      "value: 0.001}]\n"
      "wind: {speed: 9}\n");
}

TEST_P(StillWorld, ZeroStepsGiveTheStart) {
  auto s = simulation("grid: {width: 8, height: 8}\nterrain: [uniform: {layer: sand, value: 2}]\n");
  EXPECT_EQ(s->steps(), 0u);
  EXPECT_EQ(s->time(), 0.0);
  for (float v : s->terrain().values(Layer::sand)) EXPECT_EQ(v, 2.0f);
}

DESERT_ON_EACH_BACKEND(StillWorld);

}  // namespace
}  // namespace desert_sim
