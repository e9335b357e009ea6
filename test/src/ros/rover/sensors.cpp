// The sensors of a rover as topics: what is published when, what of, and that nothing is done for nobody.

#include "src/ros/rover/sensors.hpp"

#include <gtest/gtest.h>
#include <ros/ros.h>

#include <boost/make_shared.hpp>
#include <cmath>
#include <cstring>
#include <functional>

#include "include/desert_sim/testing/node_process.hpp"
#include "src/core/error.hpp"
#include "test/support/messages.hpp"

namespace desert_sim {
namespace {

/// Serves the subscribers until the condition holds.
bool spin_until(const std::function<bool()>& condition) {
  return test::wait_until(
      [&] {
        ros::spinOnce();
        return condition();
      },
      60);
}

/// Cells of 2 m with the corner at (10, -20).
std::shared_ptr<const LayerMap> map_of(const std::function<double(double, double)>& height,
                                       LayerMap::Rectangle& changed, const LayerMap* before = nullptr) {
  return std::make_shared<LayerMap>(boost::make_shared<const ElevationGrid>(client_test::keyframe_of(height)),
                                    before, changed);
}

geometry_msgs::Pose pose_at(double x, double y, double z) {
  geometry_msgs::Pose pose;
  pose.position.x = x;
  pose.position.y = y;
  pose.position.z = z;
  pose.orientation.w = 1;
  return pose;
}

SensorSetup setup_of(bool lockstep) {
  SensorSetup setup;
  setup.lockstep = lockstep;
  setup.lidar.rings = 2;
  setup.lidar.columns = 4;
  setup.lidar.lowest_deg = -90;
  setup.lidar.highest_deg = -30;
  setup.lidar.rate = 5;
  setup.lidar.noise = 0;
  setup.lidar.z = 1.5;
  setup.depth_camera.width = 8;
  setup.depth_camera.height = 6;
  return setup;
}

class SensorTopics : public ::testing::Test {
 protected:
  void make(bool lockstep) {
    sensors_ = std::make_unique<SensorPublisher>(node_, setup_of(lockstep), SensorFrames());
  }
  void subscribe_points() {
    points_ = node_.subscribe<sensor_msgs::PointCloud2>(
        "lidar/points", 100, [this](const sensor_msgs::PointCloud2ConstPtr& m) { clouds_.push_back(m); });
    ASSERT_TRUE(spin_until([this] { return sensors_->has_subscribers(); }));
  }
  void send_pose(double seconds, double z = 2) { sensors_->on_pose(ros::Time(seconds), pose_at(100, 30, z)); }
  /// Sends a pose, and waits for its cloud, which comes after those of all poses before.
  void send_pose_and_wait(double seconds) {
    send_pose(seconds);
    ASSERT_TRUE(
        spin_until([&] { return !clouds_.empty() && clouds_.back()->header.stamp == ros::Time(seconds); }));
  }
  void tell_terrain(double height) {
    LayerMap::Rectangle changed;
    map_ = map_of([=](double, double) { return height; }, changed, map_.get());
    sensors_->on_terrain(map_, changed);
  }
  float first_range(std::size_t n) const {
    float z;
    std::memcpy(&z, clouds_[n]->data.data() + 8, sizeof z);
    return -z;
  }

  ros::NodeHandle node_{"rover"};
  std::unique_ptr<SensorPublisher> sensors_;
  std::shared_ptr<const LayerMap> map_;
  ros::Subscriber points_, images_, infos_;
  std::vector<sensor_msgs::PointCloud2ConstPtr> clouds_;
};

TEST_F(SensorTopics, NothingIsDoneWithoutSubscribers) {
  make(false);
  tell_terrain(0);
  for (int n = 0; n < 100; ++n) send_pose(0.1 * n);
  subscribe_points();
  send_pose_and_wait(1000);
  const SensorPublisher::Statistics s = sensors_->statistics();
  EXPECT_EQ(s.scans, 1u) << "of the last pose";
  EXPECT_EQ(s.skipped, 0u);
  EXPECT_EQ(s.pictures, 0u);
  EXPECT_EQ(s.uploads, 1u);
}

TEST_F(SensorTopics, ScansComeAtTheirRateInLockstep) {
  make(true);
  tell_terrain(0);
  subscribe_points();
  for (int n = 0; n < 100; ++n) send_pose(5000 + 0.02 * n);
  send_pose_and_wait(6000);
  ASSERT_EQ(clouds_.size(), 11u) << "2 s at 5 Hz, and the last pose";
  for (std::size_t n = 0; n < 10; ++n) {
    EXPECT_NEAR(clouds_[n]->header.stamp.toSec(), 5000 + 0.2 * static_cast<double>(n), 1e-6);
    EXPECT_EQ(clouds_[n]->header.frame_id, "lidar");
    EXPECT_NEAR(first_range(n), 3.5, 1e-4) << "straight down from the mounting, 1.5 m over the base";
  }
  EXPECT_EQ(sensors_->statistics().pictures, 0u) << "nobody subscribes to the camera";
}

TEST_F(SensorTopics, TerrainChangesAreSeen) {
  make(true);
  tell_terrain(0);
  subscribe_points();
  send_pose_and_wait(5999);
  EXPECT_NEAR(first_range(0), 3.5, 1e-4);
  const std::uint64_t before = sensors_->statistics().uploads;
  tell_terrain(1);
  tell_terrain(1.25);
  send_pose_and_wait(6000);
  EXPECT_NEAR(first_range(1), 2.25, 1e-4);
  EXPECT_EQ(sensors_->statistics().uploads, before + 1) << "both changes in one";
  send_pose_and_wait(6001);
  EXPECT_EQ(sensors_->statistics().uploads, before + 1) << "nothing has changed";
}

TEST_F(SensorTopics, AThreadOfTheirOwnMeasures) {
  make(false);
  tell_terrain(0);
  subscribe_points();
  const auto made_or_skipped = [this] {
    const SensorPublisher::Statistics s = sensors_->statistics();
    return s.scans + s.skipped;
  };
  send_pose_and_wait(7000);
  EXPECT_EQ(clouds_.size(), 1u);
  EXPECT_NEAR(first_range(0), 3.5, 1e-4);
  for (int n = 1; n < 1000; ++n) send_pose(7000 + n);
  send_pose_and_wait(8000);  // the newest pose is never left out
  EXPECT_TRUE(spin_until([&] { return made_or_skipped() == 1001; })) << made_or_skipped();
}

TEST_F(SensorTopics, PicturesComeWithTheirCamera) {
  make(true);
  tell_terrain(0);
  sensor_msgs::ImageConstPtr image;
  sensor_msgs::CameraInfoConstPtr info;
  images_ = node_.subscribe<sensor_msgs::Image>("depth_camera/image_rect", 10,
                                                [&](const sensor_msgs::ImageConstPtr& m) { image = m; });
  infos_ = node_.subscribe<sensor_msgs::CameraInfo>(
      "depth_camera/camera_info", 10, [&](const sensor_msgs::CameraInfoConstPtr& m) { info = m; });
  double seconds = 9000;
  ASSERT_TRUE(spin_until([&] {
    send_pose(++seconds);  // the publisher knows both subscribers after a while
    return image && info && image->header.stamp == info->header.stamp;
  }));
  EXPECT_EQ(image->header.frame_id, "depth_camera_optical");
  EXPECT_EQ(info->header.frame_id, "depth_camera_optical");
  EXPECT_EQ(image->width, info->width);
  EXPECT_EQ(sensors_->statistics().scans, 0u) << "nobody subscribes to the lidar";
}

TEST_F(SensorTopics, WhatIsNoPoseIsRefused) {
  make(false);
  geometry_msgs::Pose pose = pose_at(1, 2, 3);
  pose.orientation.w = 0;
  EXPECT_THROW(sensors_->on_pose(ros::Time(1), pose), ConfigError);
  EXPECT_THROW(sensors_->on_pose(ros::Time(1), pose_at(1, std::nan(""), 3)), ConfigError);
}

}  // namespace
}  // namespace desert_sim

int main(int argc, char** argv) {
  ros::init(argc, argv, "sensors");
  ::testing::InitGoogleTest(&argc, argv);
  ros::start();
  return RUN_ALL_TESTS();
}
