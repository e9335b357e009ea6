// Scans of sensors as messages: fields, orders, frames.

#include "src/ros/conversion/sensor_messages.hpp"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>
#include <cmath>
#include <cstring>
#include <limits>

#include "include/desert_sim/client/layer_map.hpp"
#include "test/support/messages.hpp"

namespace {

using namespace desert_sim;

constexpr float none = std::numeric_limits<float>::quiet_NaN();

std_msgs::Header header_in(const char* frame) {
  std_msgs::Header header;
  header.frame_id = frame;
  header.stamp = ros::Time(12, 34);
  return header;
}

template <class T>
T read(const std::vector<std::uint8_t>& data, std::size_t place) {
  T value;
  std::memcpy(&value, data.data() + place, sizeof value);
  return value;
}

TEST(SensorMessages, CloudIsOrganisedByRings) {
  const RangeImage scan{3, 2, {2, none, 4, 5, 6, 7}, {0.1f, 0, 0.3f, 0.4f, 0.5f, 0.6f}};
  const std::vector<beams::Vec3> directions{{1, 0, 0},    {0, 1, 0},     {0, 0, 1},
                                            {0.5f, 0, 0}, {0, 0.5f, -1}, {0, 0, 2}};
  const auto cloud = lidar_cloud(header_in("lidar"), scan, directions);
  EXPECT_EQ(cloud->header.frame_id, "lidar");
  EXPECT_EQ(cloud->header.stamp, ros::Time(12, 34));
  EXPECT_EQ(cloud->height, 2u);
  EXPECT_EQ(cloud->width, 3u);
  EXPECT_EQ(cloud->row_step, 3 * cloud->point_step);
  EXPECT_EQ(cloud->data.size(), 6 * cloud->point_step);
  EXPECT_FALSE(cloud->is_dense);
  ASSERT_EQ(cloud->fields.size(), 5u);
  const char* const names[] = {"x", "y", "z", "intensity", "ring"};
  for (std::size_t n = 0; n < 5; ++n) {
    EXPECT_EQ(cloud->fields[n].name, names[n]);
    EXPECT_EQ(cloud->fields[n].count, 1u);
    EXPECT_EQ(cloud->fields[n].datatype,
              n < 4 ? sensor_msgs::PointField::FLOAT32 : sensor_msgs::PointField::UINT16);
  }
  const auto value = [&](std::size_t point, std::size_t field) {
    return read<float>(cloud->data, point * cloud->point_step + cloud->fields[field].offset);
  };
  EXPECT_EQ(value(0, 0), 2);
  for (const std::size_t field : {0, 1, 2}) EXPECT_TRUE(std::isnan(value(1, field))) << field;
  EXPECT_EQ(value(2, 2), 4);
  EXPECT_EQ(value(4, 0), 0);
  EXPECT_EQ(value(4, 1), 3);
  EXPECT_EQ(value(4, 2), -6);
  EXPECT_EQ(value(4, 3), 0.5f);
  for (std::size_t n = 0; n < 6; ++n)
    EXPECT_EQ(read<std::uint16_t>(cloud->data, n * cloud->point_step + cloud->fields[4].offset), n / 3) << n;
}

/// The surface that a client of the terrain has is the one that beams meet.
TEST(SensorMessages, PointsOfACloudAreOnTheMapOfTheClient) {
  LayerMap::Rectangle changed;
  const LayerMap map(boost::make_shared<const ElevationGrid>(client_test::keyframe_of(
                         [](double x, double y) { return 3 * std::sin(0.4 * x) + 2 * std::cos(0.3 * y); })),
                     nullptr, changed);
  const LayerMap::Info& info = map.info();
  CpuExec exec(1);
  HeightFieldScene scene(exec, {static_cast<int>(info.width), static_cast<int>(info.height), info.cell_size,
                                info.origin_x, info.origin_y});
  scene.update(SceneLayer::elevation, map.values());
  LidarParameters p;
  p.noise = 0;
  p.columns = 128;
  Lidar lidar(exec, p);
  const SensorPose pose = pose_from_angles(120, 50, 8, 5, 10, 30);
  const auto cloud = lidar_cloud(header_in("lidar"), lidar.scan(scene, pose, 0), lidar.directions());
  const Eigen::Matrix3d turn = rotation_of(pose);
  int found = 0;
  for (std::size_t place = 0; place < cloud->data.size(); place += cloud->point_step) {
    const double x = static_cast<double>(read<float>(cloud->data, place)),
                 y = static_cast<double>(read<float>(cloud->data, place + 4)),
                 z = static_cast<double>(read<float>(cloud->data, place + 8));
    if (std::isnan(x)) continue;
    ++found;
    const Eigen::Vector3d hit = pose.position + turn * Eigen::Vector3d(x, y, z);
    const auto height = map.value(hit.x(), hit.y());
    ASSERT_TRUE(height);
    ASSERT_NEAR(hit.z(), *height, 1e-3);
  }
  EXPECT_GT(found, 3000);
}

TEST(SensorMessages, DepthsAreFloatsByRows) {
  const RangeImage picture{2, 3, {1, 2, 3, none, 5, 6}, std::vector<float>(6, 0.0f)};
  const auto image = depth_image(header_in("optical"), picture);
  EXPECT_EQ(image->header.frame_id, "optical");
  EXPECT_EQ(image->encoding, "32FC1");
  EXPECT_EQ(image->width, 2u);
  EXPECT_EQ(image->height, 3u);
  EXPECT_EQ(image->step, 8u);
  ASSERT_EQ(image->data.size(), 24u);
  EXPECT_EQ(read<float>(image->data, 1 * image->step), 3);
  EXPECT_TRUE(std::isnan(read<float>(image->data, 1 * image->step + 4)));
  EXPECT_EQ(read<float>(image->data, 2 * image->step + 4), 6);
}

/// Pixels of the picture, taken back by the camera's matrix and the transforms of the sensors, are on the
/// ground.
TEST(SensorMessages, CameraInfoAndTransformsLeadBackToTheGround) {
  CpuExec exec(1);
  HeightFieldScene scene(exec, {64, 64, 0.5, 0, 0});
  std::vector<float> heights;
  for (int n = 0; n < 64 * 64; ++n)
    heights.push_back(0.1f * static_cast<float>(n % 64));  // rises to the east
  scene.update(SceneLayer::elevation, heights);
  DepthCameraParameters p;
  p.width = 40, p.height = 30;
  p.noise = p.noise_per_square_metre = 0;
  p.far = 50;
  p.x = 0.4, p.y = 0.2, p.z = 1.1;
  p.roll_deg = 3, p.pitch_deg = 40, p.yaw_deg = -20;
  DepthCamera camera(exec, p);
  const SensorPose base = pose_from_angles(10, 12, 3, 1, 2, 60);
  const RangeImage& picture = camera.scan(scene, compose(base, mounting_of(p)), 0);
  const auto info = camera_info(header_in("optical"), camera);
  EXPECT_EQ(info->width, 40u);
  EXPECT_EQ(info->height, 30u);
  EXPECT_EQ(info->distortion_model, "plumb_bob");
  EXPECT_EQ(info->P[0], info->K[0]);
  EXPECT_EQ(info->P[6], info->K[5]);

  const SensorFrames frames;
  const auto transforms = sensor_transforms(frames, {}, p);
  ASSERT_EQ(transforms.size(), 3u);
  EXPECT_EQ(transforms[0].child_frame_id, frames.lidar);
  EXPECT_EQ(transforms[1].header.frame_id, frames.base);
  EXPECT_EQ(transforms[2].header.frame_id, transforms[1].child_frame_id);
  EXPECT_EQ(transforms[2].child_frame_id, frames.camera_optical);
  SensorPose optical = base;
  for (const std::size_t n : {1u, 2u}) {
    const auto& t = transforms[n].transform;
    optical = compose(optical, {{t.translation.x, t.translation.y, t.translation.z},
                                {t.rotation.w, t.rotation.x, t.rotation.y, t.rotation.z}});
  }
  const Eigen::Matrix3d turn = rotation_of(optical);
  int found = 0;
  for (int v = 0; v < 30; ++v)
    for (int u = 0; u < 40; ++u) {
      const double depth = static_cast<double>(picture.distances[static_cast<std::size_t>(v * 40 + u)]);
      if (std::isnan(depth)) continue;
      ++found;
      const double x = (u - info->K[2]) / info->K[0] * depth, y = (v - info->K[5]) / info->K[4] * depth;
      const Eigen::Vector3d place = optical.position + turn * Eigen::Vector3d(x, y, depth);
      ASSERT_NEAR(place.z(), 0.1 * std::min(std::max(place.x() / 0.5 - 0.5, 0.0), 63.0), 1e-4)
          << u << ", " << v;
    }
  EXPECT_GT(found, 900);
}

}  // namespace
