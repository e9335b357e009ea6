// The sensors of a rover as topics: what is published when, what of, and that nothing is done for nobody.

#include "src/ros/rover/sensors.hpp"

#include <gtest/gtest.h>
#include <ros/ros.h>

#include <boost/make_shared.hpp>
#include <cmath>
#include <cstring>
#include <functional>

#include "src/core/error.hpp"
#include "test/support/messages.hpp"

namespace desert_sim {
namespace {

constexpr double patience = 10;  // [s]

bool within_patience(const std::function<bool()>& condition) {
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(patience);
  while (!condition() && ros::ok() && ros::WallTime::now() < end) {
    ros::spinOnce();
    ros::WallDuration(0.005).sleep();
  }
  return condition();
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
    ASSERT_TRUE(within_patience([this] { return points_.getNumPublishers() > 0; }));
    // The publisher knows the subscriber a moment later.
    ASSERT_TRUE(within_patience([this] { return send_pose(1e3 + ++probes_), !clouds_.empty(); }));
    ros::WallDuration(0.3).sleep();  // for those that are still on their way
    ros::spinOnce();
    clouds_.clear();
  }
  bool send_pose(double seconds, double z = 2) {
    sensors_->on_pose(ros::Time(seconds), pose_at(100, 30, z));
    return true;
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
  int probes_ = 0;
};

TEST_F(SensorTopics, NothingIsDoneWithoutSubscribers) {
  make(false);
  tell_terrain(0);
  for (int n = 0; n < 100; ++n) send_pose(0.1 * n);
  ros::WallDuration(0.3).sleep();
  const SensorPublisher::Statistics s = sensors_->statistics();
  EXPECT_EQ(s.scans, 0u);
  EXPECT_EQ(s.pictures, 0u);
  EXPECT_EQ(s.uploads, 0u);
}

TEST_F(SensorTopics, ScansComeAtTheirRateInLockstep) {
  make(true);
  tell_terrain(0);
  subscribe_points();
  for (int n = 0; n < 100; ++n) send_pose(5000 + 0.02 * n);
  ASSERT_TRUE(within_patience([this] { return clouds_.size() >= 10; }));
  ros::WallDuration(0.1).sleep();
  ros::spinOnce();
  ASSERT_EQ(clouds_.size(), 10u) << "2 s at 5 Hz";
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
  const std::uint64_t before = sensors_->statistics().uploads;
  tell_terrain(1);
  tell_terrain(1.25);
  send_pose(6000);
  ASSERT_TRUE(within_patience([this] { return !clouds_.empty(); }));
  EXPECT_NEAR(first_range(0), 2.25, 1e-4);
  EXPECT_EQ(sensors_->statistics().uploads, before + 1) << "both changes in one";
  send_pose(6001);
  ASSERT_TRUE(within_patience([this] { return clouds_.size() > 1; }));
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
  const std::uint64_t before = made_or_skipped();
  send_pose(7000);
  ASSERT_TRUE(within_patience([this] { return clouds_.size() == 1; }));
  EXPECT_NEAR(first_range(0), 3.5, 1e-4);
  for (int n = 1; n <= 1000; ++n) send_pose(7000 + n);
  ASSERT_TRUE(within_patience([this] { return clouds_.back()->header.stamp == ros::Time(8000); }))
      << "the newest pose is never left out";
  EXPECT_TRUE(within_patience([&] { return made_or_skipped() == before + 1001; }))
      << made_or_skipped() - before;
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
  ASSERT_TRUE(within_patience([&] {
    send_pose(9000 + ++probes_);
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
