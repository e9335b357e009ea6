// Lidar and depth camera: frames, orders, parameters, threads, and updates of what they see.

#include <fstream>
#include <iterator>

#include "test/support/refusal.hpp"
#include "test/support/scenes.hpp"

namespace desert_sim {
namespace {

using test::KnownScene;
using test::Point;
using test::unknown;

using Rectangle = HeightFieldScene::Rectangle;

// ---- Poses.

TEST(SensorPose, ComposesLikeTransforms) {
  const SensorPose outer = pose_from_angles(1, 2, 3, 10, -20, 135),
                   inner = pose_from_angles(0.5, -1, 2, 5, 60, 7);
  const beams::Vec3 ahead{0.25f, -0.5f, 1};
  const Point in_outer = test::point_at(inner, ahead, 2);
  const Eigen::Vector3d expected =
      outer.position + rotation_of(outer) * Eigen::Vector3d(in_outer.x, in_outer.y, in_outer.z);
  const Point direct = test::point_at(compose(outer, inner), ahead, 2);
  EXPECT_NEAR(direct.x, expected.x(), 1e-12);
  EXPECT_NEAR(direct.y, expected.y(), 1e-12);
  EXPECT_NEAR(direct.z, expected.z(), 1e-12);
}

TEST(SensorPose, HasTheAnglesOfUrdf) {
  const Point yaw = test::point_at(pose_from_angles(0, 0, 0, 0, 0, 90), {1, 0, 0}, 1),
              pitch = test::point_at(pose_from_angles(0, 0, 0, 0, 90, 0), {1, 0, 0}, 1),
              roll = test::point_at(pose_from_angles(0, 0, 0, 90, 0, 0), {0, 1, 0}, 1),
              all = test::point_at(pose_from_angles(0, 0, 0, 90, 0, 90), {0, 0, 1}, 1);
  EXPECT_NEAR(yaw.y, 1, 1e-12);
  EXPECT_NEAR(pitch.z, -1, 1e-12);
  EXPECT_NEAR(roll.z, 1, 1e-12);
  EXPECT_NEAR(all.x, 1, 1e-12) << "roll turns z to -y, and yaw that to x";
}

TEST(SensorPose, IsRefusedIfItIsNone) {
  SensorPose pose{{1, 2, 3}, {0, 0, 0, 0}};
  EXPECT_NE(test::refusal([&] { rotation_of(pose); }).find("quaternion"), std::string::npos);
  pose = {{std::nan(""), 0, 0}};
  EXPECT_NE(test::refusal([&] { rotation_of(pose); }).find("position (nan, 0, 0)"), std::string::npos);
}

// ---- The lidar.

class Sensors : public ::testing::Test {
 protected:
  CpuExec exec_{1};
};

TEST_F(Sensors, LidarHasRingsFromBelowAndColumnsFromTheRight) {
  // A pillar in the north-east of a lidar that looks north.
  const KnownScene pillar(exec_, {100, 100, 1, -50, -50},
                          [](int x, int y) { return x == 60 && y == 70 ? 6.0f : 0.0f; });
  LidarParameters p = test::exact_lidar(3, 4, -30, 10);
  p.first_azimuth_deg = -80;
  p.last_azimuth_deg = 80;
  Lidar lidar(exec_, p);
  const SensorPose pose = pose_from_angles(0.5, 0.5, 2, 0, 0, 90);
  const RangeImage& image = lidar.scan(pillar.scene, pose, 0);
  ASSERT_EQ(image.rows, 3);
  ASSERT_EQ(image.columns, 4);
  for (std::size_t column = 0; column < 4; ++column) {
    EXPECT_NEAR(static_cast<double>(image.distances[column]), 4, 1e-4) << "30 deg down, 2 m above the ground";
    EXPECT_TRUE(std::isnan(image.distances[8 + column])) << "10 deg up";
    const beams::Vec3 d = lidar.directions()[4 + column];
    EXPECT_NEAR(static_cast<double>(std::atan2(d.y, d.x)) * 180 / 3.14159265358979,
                -60 + 40.0 * static_cast<double>(column), 1e-4);
    EXPECT_NEAR(static_cast<double>(d.z), std::sin(-10 * 3.14159265358979 / 180), 1e-6);
  }
  p.rings = 1;
  p.columns = 360;
  p.lowest_deg = p.highest_deg = 0;
  p.first_azimuth_deg = -180;
  p.last_azimuth_deg = 180;
  Lidar around(exec_, p);
  const RangeImage& horizon = around.scan(pillar.scene, pose, 0);
  for (int column = 0; column < 360; ++column) {
    const double bearing = column - 179.5;  // the pillar is 10 m to the right and 20 m ahead
    const bool sees = !std::isnan(horizon.distances[static_cast<std::size_t>(column)]);
    EXPECT_EQ(sees, std::abs(bearing + 26.57) < 1.7) << bearing;
  }
}

TEST_F(Sensors, LidarTakesAnglesOfItsRings) {
  const KnownScene plane(exec_, {100, 100, 1, -50, -50}, [](int, int) { return 0.0f; });
  Lidar lidar(exec_, test::exact_lidar(64, 8, -20, 20), {}, {-90, -30, 45});
  const RangeImage& image = lidar.scan(plane.scene, {{0, 0, 2}}, 0);
  ASSERT_EQ(image.rows, 3);
  EXPECT_NEAR(static_cast<double>(image.distances[0]), 2, 1e-5);
  EXPECT_NEAR(static_cast<double>(image.distances[8]), 4, 1e-5);
  EXPECT_TRUE(std::isnan(image.distances[16]));
  EXPECT_EQ(test::refusal([&] {
              Lidar(exec_, {}, {}, {0, 91});
            }),
            "lidar: ring_angles_deg[1] = 91 is not in [-90, 90] deg");
}

TEST_F(Sensors, MountingIsAPoseInTheRoversFrame) {
  LidarParameters p;
  p.x = 0.2, p.y = -0.1, p.z = 1.5;
  p.pitch_deg = 90;
  const SensorPose pose = compose(pose_from_angles(10, 20, 5, 0, 0, 90), mounting_of(p));
  EXPECT_NEAR(pose.position.x(), 10.1, 1e-12);
  EXPECT_NEAR(pose.position.y(), 20.2, 1e-12);
  EXPECT_NEAR(pose.position.z(), 6.5, 1e-12);
  EXPECT_NEAR(test::point_at(pose, {1, 0, 0}, 1).z, 5.5, 1e-12) << "it looks down";
}

TEST_F(Sensors, ParametersAreRefusedByNameValueAndRange) {
  const auto refused = [&](const auto& change) {
    LidarParameters p;
    change(p);
    return test::refusal([&] { Lidar(exec_, p); });
  };
  EXPECT_EQ(refused([](auto& p) { p.rings = 0; }), "lidar: rings: 0 is not in [1, 256]");
  EXPECT_EQ(refused([](auto& p) { p.range_max = std::nanf(""); }),
            "lidar: range_max: nan is not in [0.001, 10000] m");
  EXPECT_EQ(refused([](auto& p) { p.range_min = 200; }),
            "lidar: range_min: 200 is not below range_max = 100");
  EXPECT_EQ(refused([](auto& p) { p.lowest_deg = 50; }), "lidar: lowest_deg: 50 is above highest_deg = 22.5");
  EXPECT_EQ(refused([](auto& p) { p.first_azimuth_deg = 180; }),
            "lidar: first_azimuth_deg: 180 is not below last_azimuth_deg = 180");
  EXPECT_EQ(refused([](auto& p) { p.last_azimuth_deg = 360; }),
            "lidar: last_azimuth_deg: 360 is more than a turn of 360 deg from first_azimuth_deg = -180");
  SensorMediaParameters media;
  media.dust_returns = 1.5f;
  EXPECT_EQ(test::refusal([&] { Lidar(exec_, {}, media); }),
            "sensor_media: dust_returns: 1.5 is not in [0, 1]");
  DepthCameraParameters camera;
  camera.near = 20;
  EXPECT_EQ(test::refusal([&] { DepthCamera(exec_, camera); }),
            "depth_camera: near: 20 is not below far = 10");
  camera = {};
  camera.fov_deg = 180;
  EXPECT_EQ(test::refusal([&] { DepthCamera(exec_, camera); }),
            "depth_camera: fov_deg: 180 is not in [1, 170] deg");
}

TEST_F(Sensors, ParametersAreReadBySection) {
  LidarParameters lidar;
  DepthCameraParameters camera;
  SensorMediaParameters media;
  const auto read = [&](const char* text) {
    ValidationErrors errors("rover.yaml");
    std::set<std::string> known;
    read_sensor_parameters(YAML::Load(text), errors, lidar, camera, media, known);
    EXPECT_EQ(known, (std::set<std::string>{"lidar", "depth_camera", "sensor_media"}));
    errors.throw_if_any();
  };
  read("{lidar: {rings: 16, seed: 18446744073709551615}, sensor_media: {dust_height: 5}, other: 1}");
  EXPECT_EQ(lidar.rings, 16);
  EXPECT_EQ(lidar.seed, 18446744073709551615u);
  EXPECT_EQ(media.dust_height, 5);
  EXPECT_EQ(camera.width, 320);
  const std::string fault =
      test::refusal([&] { read("{lidar: {range: 5, columns: 0}, depth_camera: {far: near}}"); });
  EXPECT_NE(fault.find("lidar.range: unknown key"), std::string::npos) << fault;
  EXPECT_NE(fault.find("lidar.columns: 0 is not in [1, 8192]"), std::string::npos) << fault;
  EXPECT_NE(fault.find("depth_camera.far: near is not a number"), std::string::npos) << fault;
}

TEST_F(Sensors, PageHasTheTablesOfTheParameters) {
  std::ifstream file(std::string(DESERT_SOURCE_DIR) + "/config/sensor_parameters.md");
  const std::string page((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const std::string tables = describe_sensor_parameters();
  EXPECT_NE(page.find(tables), std::string::npos)
      << "config/sensor_parameters.md is stale; its tables have to be:\n"
      << tables;
}

// ---- The depth camera.

TEST_F(Sensors, CameraMeasuresDepthAlongItsAxis) {
  // A wall across the way at x = 10, up to 3 m high on the left (y > 0), and 1 m on the right.
  const KnownScene wall(exec_, {200, 200, 0.1f, -2, -10},
                        [](int x, int y) { return x < 120 ? 0.0f : (y >= 100 ? 3.0f : 1.0f); });
  DepthCameraParameters p;
  p.width = 81;
  p.height = 61;
  p.noise = p.noise_per_square_metre = 0;
  p.far = 20;
  DepthCamera camera(exec_, p);
  const RangeImage& image = camera.scan(wall.scene, {{0, 0, 1.5}}, 0);
  ASSERT_EQ(image.columns, 81);
  ASSERT_EQ(image.rows, 61);
  const auto depth = [&](int u, int v) {
    return static_cast<double>(image.distances[static_cast<std::size_t>(v * 81 + u)]);
  };
  const double f = camera.focal_length();
  EXPECT_NEAR(f, 40.5 / std::tan(43.5 * 3.14159265358979 / 180), 1e-5);
  for (int u = 1; u < 40; u += 6)
    EXPECT_NEAR(depth(u, 30), 10, 0.06) << "the same depth everywhere on the wall: " << u;
  EXPECT_TRUE(std::isnan(depth(60, 30))) << "on the right it is too low";
  EXPECT_TRUE(std::isnan(depth(20, 5))) << "row 0 is the upper one";
  EXPECT_NEAR(depth(40, 55), 1.5 * f / 25, 1e-3) << "the ground in front";
  EXPECT_NEAR(depth(70, 55), 1.5 * f / 25, 1e-3);
  p.far = 9;
  EXPECT_TRUE(std::isnan(DepthCamera(exec_, p).scan(wall.scene, {{0, 0, 1.5}}, 0).distances[30 * 81 + 20]));
}

TEST_F(Sensors, OpticalFrameLooksAlongItsZAxis) {
  const SensorPose frame = DepthCamera::optical_frame();
  const Point right = test::point_at(frame, {1, 0, 0}, 1), down = test::point_at(frame, {0, 1, 0}, 1),
              ahead = test::point_at(frame, {0, 0, 1}, 1);
  EXPECT_NEAR(right.y, -1, 1e-12);
  EXPECT_NEAR(down.z, -1, 1e-12);
  EXPECT_NEAR(ahead.x, 1, 1e-12);
}

// ---- Threads and updates.

TEST_F(Sensors, ScanIsTheSameOnAnyNumberOfThreads) {
  std::vector<RangeImage> images;
  for (const int threads : {1, 2, 3}) {
    CpuExec exec(threads);
    HeightFieldScene scene(exec, {130, 97, 0.7, 3, 4});
    test::fill_with_all(scene, 3);
    Lidar lidar(exec, test::noisy_lidar());
    images.push_back(lidar.scan(scene, pose_from_angles(50, 40, 7.5, 3, 4, 5), 9));
  }
  EXPECT_GT(test::returns_of(images[0]), 5000);
  for (std::size_t n : {1u, 2u}) {
    EXPECT_TRUE(test::same_bits(images[0].distances, images[n].distances));
    EXPECT_TRUE(test::same_bits(images[0].intensities, images[n].intensities));
  }
}

TEST_F(Sensors, UpdatesOfRectanglesLeaveWhatAWholeUploadDoes) {
  std::mt19937 random(11);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  for (const auto& [width, height] : {std::pair{130, 97}, {64, 64}, {17, 200}, {3, 5}}) {
    const SceneGeometry g{width, height, 0.7, 0, 0};
    HeightFieldScene scene(exec_, g);
    std::vector<std::vector<float>> layers(
        4, std::vector<float>(static_cast<std::size_t>(width) * height, 0.0f));
    scene.update(SceneLayer::elevation, layers[0]);
    for (int n = 0; n < 60; ++n) {
      const std::size_t which = static_cast<std::size_t>(below(4));
      const int x = below(width), y = below(height);
      const Rectangle r{x, y, 1 + below(std::min(width - x, 40)), 1 + below(std::min(height - y, 40))};
      // Ground goes up and down, plants and sand in the air come and go, and some ground becomes unknown.
      const float most = which == 0 ? 3.0f : (below(3) == 0 ? 0.0f : 1.0f);
      std::vector<float> values;
      for (int j = r.y; j < r.y + r.height; ++j)
        for (int i = r.x; i < r.x + r.width; ++i) {
          const float value =
              which == 0 && below(50) == 0 ? unknown : most * static_cast<float>(below(100)) / 100;
          values.push_back(value);
          layers[which][static_cast<std::size_t>(j) * width + i] = value;
        }
      scene.update(static_cast<SceneLayer>(which), r, values);
      if (n % 10 != 9) continue;
      HeightFieldScene fresh(exec_, g);
      for (std::size_t layer = 0; layer < 4; ++layer)
        fresh.update(static_cast<SceneLayer>(layer), layers[layer]);
      Lidar lidar(exec_, test::noisy_lidar());
      const SensorPose pose{{0.5 * width * g.cell_size, 0.5 * height * g.cell_size, 3.5}};
      const std::vector<float> expected = lidar.scan(fresh, pose, 1).distances;
      EXPECT_TRUE(test::same_bits(lidar.scan(scene, pose, 1).distances, expected))
          << width << ", after " << n;
      const auto tops = [](const HeightFieldScene& s) {
        const height_field::Level& last = s.view().levels[s.view().level_count - 1];
        return std::vector<float>(s.view().tops, s.view().tops + last.offset + last.columns * last.rows);
      };
      EXPECT_EQ(tops(scene), tops(fresh)) << "no block of tops is out of date";
    }
  }
}

TEST_F(Sensors, RefusesRectanglesBesideTheGrid) {
  HeightFieldScene scene(exec_, {10, 8, 1, 0, 0});
  EXPECT_EQ(test::refusal([&] {
              scene.update(SceneLayer::elevation, {4, 0, 7, 1}, std::vector<float>(7));
            }),
            "sensors: the rectangle x = 4, y = 0, width = 7, height = 1 exceeds the grid of 10 x 8 cells");
  EXPECT_EQ(test::refusal([&] {
              scene.update(SceneLayer::vegetation, {4, 0, 2, 2}, std::vector<float>(3));
            }),
            "sensors: 3 values for a rectangle of 2 x 2 cells");
  EXPECT_NE(test::refusal([&] {
              scene.update(SceneLayer::elevation, {-1, 0, 2, 2}, std::vector<float>(4));
            }),
            "");
  EXPECT_NE(test::refusal([&] { HeightFieldScene(exec_, {0, 5, 1, 0, 0}); }), "");
  EXPECT_EQ(test::refusal([&] {
              HeightFieldScene(exec_, {5, 5, std::nan(""), 0, 0});
            }),
            "sensors: cell_size = nan is not above 0 and finite");
  EXPECT_NO_THROW(scene.update(SceneLayer::elevation, {10, 8, 0, 0}, {}));
}

TEST_F(Sensors, RefusesASceneOfAnotherBackend) {
  CpuExec other(1);
  HeightFieldScene scene(other, {10, 8, 1, 0, 0});
  Lidar lidar(exec_, test::exact_lidar(1, 1, 0, 0));
  EXPECT_THROW(lidar.scan(scene, {{1, 1, 1}}, 0), Error);
}

}  // namespace
}  // namespace desert_sim
