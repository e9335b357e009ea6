// Beams on rippled sand meet the surface that maps and wheels have, on both backends to the bit.

#include <algorithm>
#include <cstring>

#include "src/simulation/views/micro_relief.hpp"
#include "src/simulation/views/snapshot_source.hpp"
#include "test/support/scenes.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

constexpr double ripple_height = 0.0467 * (0.013 + 0.02 * 9);  // of ripples in this wind

/// Sand that rises by 5 cm a metre to the east, with plants' heaps in the north.
Snapshot rippled(Exec& exec, const std::string& more = "") {
  const auto world = test::simulate(
      exec,
      "{grid: {width: 32, height: 24, cell_size: 1, boundary: open, origin_x: 100, origin_y: -7}, terrain: "
      "[{ramp: {layer: bedrock, slope_x: 0.05}}, {uniform: {layer: sand, value: 1}}], wind: {speed: 10, "
      "direction_deg: 20, warping: false, projection: false}, micro_relief: {crest_length: 1" +
          more + "}}");
  Snapshot s = *world->views().snapshot(MicroRelief::layers());
  for (std::size_t i = 32 * 16; i < s.layers.at(Layer::vegetation).size(); ++i)
    s.layers.at(Layer::vegetation)[i] = 0.8f;
  return s;
}

/// The same, with live plants on a third of the squares of the lattice of bumps.
Snapshot with_live_plants(Snapshot s) {
  const micro_relief::Lattice squares = s.micro_relief.bump_squares(s.width, s.cell_size, s.periodic_x);
  const auto feet = std::make_shared<PlantFeet>();
  feet->rows = squares.y.count;
  for (int n = 0; n < squares.x.count * squares.y.count; ++n) {
    const auto share = [n](int step) { return static_cast<float>(n * step % 64) / 64; };
    feet->widest.push_back(
        n % 3 ? 0 : micro_relief::Foot::number({0, 0, share(23), share(37)}, 0.2f + share(11)));
  }
  s.feet = feet;
  s.micro_relief.plants_live = true;
  return s;
}

struct Scene {
  Scene(Exec& exec, const Snapshot& s)
      : scene(exec, {s.width, s.height, s.cell_size, s.origin_x, s.origin_y}) {
    scene.update(SceneLayer::elevation, s.layers.at(Layer::elevation));
    scene.set_micro_relief(source_of(s));
  }
  HeightFieldScene scene;
};

double surface(const MicroRelief& micro_relief, double x, double y) {
  return static_cast<double>(micro_relief.elevations({x - 5e-7, y - 5e-7, 1, 1, 1e-6})[0]);
}

class BeamsOnRipples : public test::OnBackend {};

void expect_beams_to_end_on_the_surface(Exec& exec, const Snapshot& s, double highest) {
  const MicroRelief micro_relief(s);
  const Scene known(exec, s);
  Lidar lidar(exec, test::exact_lidar(24, 60, -85, -4), {});
  for (const double y : {2.0, 12.0}) {
    const SensorPose pose{{116, y, 1.6}};
    const RangeImage image = lidar.scan(known.scene, pose, 0);
    int returns = 0, off = 0;
    double largest = 0;
    for (std::size_t n = 0; n < image.distances.size(); ++n) {
      if (std::isnan(image.distances[n])) continue;
      const test::Point p =
          test::point_at(pose, lidar.directions()[n], static_cast<double>(image.distances[n]));
      ++returns;
      off += std::abs(p.z - surface(micro_relief, p.x, p.y)) > 1e-4;
      largest = std::max(largest, std::abs(micro_relief.offset(p.x, p.y)));
    }
    EXPECT_GT(returns, 1000);
    EXPECT_EQ(off, 0);
    EXPECT_GT(largest, highest);
  }
}

TEST_P(BeamsOnRipples, TheyEndOnTheSurfaceOfTheMaps) {
  expect_beams_to_end_on_the_surface(exec(), rippled(exec()), 0.4 * ripple_height);
}

TEST_P(BeamsOnRipples, TheyEndOnHeapsAtLivePlants) {
  const Snapshot s = rippled(exec());
  expect_beams_to_end_on_the_surface(exec(), with_live_plants(s), 0.07);
  Scene known(exec(), with_live_plants(s));
  Lidar lidar(exec(), test::exact_lidar(12, 60, -60, -5), {});
  const SensorPose pose{{116, 4, 1.6}};
  const std::vector<float> first = lidar.scan(known.scene, pose, 0).distances;
  Snapshot moved = with_live_plants(s);
  PlantFeet feet = *moved.feet;
  std::rotate(feet.widest.begin(), feet.widest.begin() + 1, feet.widest.end());
  moved.feet = std::make_shared<const PlantFeet>(feet);
  known.scene.set_micro_relief(source_of(moved));
  const std::vector<float> second = lidar.scan(known.scene, pose, 0).distances;
  EXPECT_NE(second, first) << "heaps move with their plants";
  known.scene.set_micro_relief(source_of(with_live_plants(s)));
  EXPECT_EQ(0, std::memcmp(lidar.scan(known.scene, pose, 0).distances.data(), first.data(),
                           first.size() * sizeof(float)));
}

TEST_P(BeamsOnRipples, NoBeamPassesThroughACrest) {
  const Snapshot s = rippled(exec());
  const MicroRelief micro_relief(s);
  const Scene known(exec(), s);
  Lidar lidar(exec(), test::exact_lidar(6, 40, -12, -3), {});
  const SensorPose pose{{116, 12, 1.2}};
  const RangeImage image = lidar.scan(known.scene, pose, 0);
  int through = 0;
  for (std::size_t n = 0; n < image.distances.size(); ++n) {
    if (std::isnan(image.distances[n])) continue;
    const double end = static_cast<double>(image.distances[n]);
    for (double t = std::max(0.0, end - 0.4); t < end - 1e-3; t += 0.004) {
      const test::Point p = test::point_at(pose, lidar.directions()[n], t);
      through += p.z < surface(micro_relief, p.x, p.y) - 2e-4;
    }
  }
  EXPECT_EQ(through, 0);
}

TEST_P(BeamsOnRipples, WithoutMicroReliefTheGroundIsBilinear) {
  const Snapshot s = rippled(exec()), flat = rippled(exec(), ", ripples: false, bumps: false");
  Scene known(exec(), s), none(exec(), flat);
  Lidar lidar(exec(), test::exact_lidar(12, 60, -60, -5), {});
  const SensorPose pose{{116, 12, 1.6}};
  const std::vector<float> rippled_ranges = lidar.scan(known.scene, pose, 0).distances;
  known.scene.clear_micro_relief();
  const std::vector<float> bilinear = lidar.scan(known.scene, pose, 0).distances,
                           without = lidar.scan(none.scene, pose, 0).distances;
  EXPECT_NE(rippled_ranges, bilinear);
  for (std::size_t n = 0; n < bilinear.size(); ++n)
    if (!std::isnan(bilinear[n])) {
      ASSERT_NEAR(without[n], bilinear[n], 3e-3) << n;
    }
}

TEST_P(BeamsOnRipples, AnotherGridIsRefused) {
  const Snapshot s = rippled(exec());
  HeightFieldScene other(exec(), {16, 24, 1, 100, -7});
  EXPECT_THROW(other.set_micro_relief(source_of(s)), ConfigError);
}

DESERT_ON_EACH_BACKEND(BeamsOnRipples);

class RippledParity : public test::OnBoth {};

TEST_F(RippledParity, ScansHaveTheSameBits) {
  for (const Snapshot& s : {rippled(cpu()), with_live_plants(rippled(cpu()))}) {
    const Scene here(cpu(), s), there(cuda(), s);
    LidarParameters p = test::exact_lidar(32, 400, -60, -2);
    Lidar first(cpu(), p, {}), second(cuda(), p, {});
    const RangeImage a = first.scan(here.scene, {{116, 12, 1.6}}, 0),
                     b = second.scan(there.scene, {{116, 12, 1.6}}, 0);
    for (std::size_t n = 0; n < a.distances.size(); ++n) {
      ASSERT_EQ(bits_of(a.distances[n]), bits_of(b.distances[n])) << n;
      ASSERT_EQ(bits_of(a.intensities[n]), bits_of(b.intensities[n])) << n;
    }
  }
}

}  // namespace
}  // namespace desert_sim
