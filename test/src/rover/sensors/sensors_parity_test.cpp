// Scans of lidars and depth cameras on both backends: the same bits.

#include "test/support/scenes.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

class SensorsParity : public test::OnBoth {
 protected:
  /// What a backend makes of a terrain that changes, in the order of the scans.
  template <class Sensor, class Parameters>
  std::vector<RangeImage> scans(Exec& exec, const Parameters& parameters) {
    HeightFieldScene scene(exec, {211, 130, 0.7, 5e5, 4e6});
    Sensor sensor(exec, parameters);
    std::vector<RangeImage> images;
    const auto look = [&](double x, double y, double z, double yaw_deg) {
      images.push_back(
          sensor.scan(scene, pose_from_angles(5e5 + x, 4e6 + y, z, 2, 10, yaw_deg), images.size()));
    };
    scene.update(SceneLayer::elevation, test::values_of(scene.geometry(), test::rough_ground));
    look(70, 40, 8, 0);
    test::fill_with_all(scene, 4);
    for (int n = 0; n < 12; ++n) look(20 + 9 * n, 70 - 3 * n, 7.5, 40 * n);
    look(-20, 40, 6, 0);
    scene.update(SceneLayer::elevation, {60, 40, 51, 37}, std::vector<float>(51 * 37, 6.5f));
    scene.update(SceneLayer::vegetation, {50, 30, 20, 20}, std::vector<float>(400, 0.9f));
    scene.update(SceneLayer::airborne_sand, {0, 0, 211, 60}, std::vector<float>(211 * 60, 0.0f));
    for (int n = 0; n < 6; ++n) look(30 + 9 * n, 40, 8, 60 * n);
    return images;
  }
  template <class Sensor, class Parameters>
  void expect_same(const Parameters& parameters) {
    const auto on_cpu = scans<Sensor>(cpu(), parameters), on_gpu = scans<Sensor>(cuda(), parameters);
    ASSERT_EQ(on_cpu.size(), on_gpu.size());
    int returns = 0;
    for (std::size_t n = 0; n < on_cpu.size(); ++n) {
      EXPECT_TRUE(test::same_bits(on_cpu[n].distances, on_gpu[n].distances)) << "scan " << n;
      EXPECT_TRUE(test::same_bits(on_cpu[n].intensities, on_gpu[n].intensities)) << "scan " << n;
      returns += test::returns_of(on_cpu[n]);
    }
    EXPECT_GT(returns, 50000);
  }
};

TEST_F(SensorsParity, OfTheLidar) { expect_same<Lidar>(test::noisy_lidar()); }

TEST_F(SensorsParity, OfTheDepthCamera) {
  DepthCameraParameters p;
  p.far = 60;
  p.dropout = 0.02f;
  expect_same<DepthCamera>(p);
}

}  // namespace
}  // namespace desert_sim
