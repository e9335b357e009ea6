/// Two rovers in one master, in a ROS time that the test tells: what they publish belongs together, what they
/// are told is obeyed or refused.
#include <desert_sim/EditTerrain.h>
#include <desert_sim/SimulationStatus.h>
#include <geometry_msgs/Twist.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <tf2/LinearMath/Transform.h>
#include <tf2_geometry_msgs/tf2_geometry_msgs.h>
#include <tf2_ros/transform_listener.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "include/desert_sim/testing/inbox.hpp"
#include "test/support/ros/rover_tests.hpp"
#include "test/support/ros/test_clock.hpp"

namespace {

using desert_sim::RoverStatus;
using desert_sim::test::Inbox;
using nav_msgs::Odometry;
using node_test::ask;
using node_test::call;
using node_test::drive;
using node_test::Listener;
using node_test::set_pose;
using node_test::wait_until;

const std::string first = "/first/desert_rover", second = "/second/desert_rover";

class TwoRovers : public testing::Test {
 protected:
  static void SetUpTestSuite() { watch_ = new Watch; }
  static void TearDownTestSuite() { delete watch_; }
  void SetUp() override {
    ASSERT_TRUE(wait_until([this] { return clock_->advance(0.02), truth_.last() && other_.last(); }))
        << "they have no terrain: " << status_.last().reason;
    const auto answer = ask<std_srvs::Trigger>(first + "/reset");
    ASSERT_TRUE(answer.success) << answer.message;
    tick();
  }
  /// Lets the time go on, and both rovers with it.
  void tick(double seconds = 0.1) {
    clock_->advance(seconds);
    for (const Inbox<Odometry>* poses : {&truth_, &other_}) ASSERT_TRUE(is_of_now(*poses));
  }
  /// Waits for the message of this moment.
  template <class Message>
  bool is_of_now(const Inbox<Message>& inbox) const {
    return inbox.wait_for([this](const Message& m) { return m.header.stamp == clock_->now(); },
                          60 * desert_sim::test::patience());
  }
  /// Whether it comes true within so many seconds of the rovers' time; `before_each_tick` acts meanwhile.
  bool tick_until(
      const std::function<bool()>& condition, double seconds,
      const std::function<void()>& before_each_tick = [] {}) {
    for (const ros::Time end = clock_->now() + ros::Duration(seconds); clock_->now() < end; tick()) {
      if (condition()) return true;
      before_each_tick();
    }
    return condition();
  }
  bool becomes(const std::string& state, double seconds = 20) {
    return tick_until([&] { return status_.last().state == state; }, seconds);
  }
  static double x_of(const Inbox<Odometry>& poses) { return poses.last()->pose.pose.position.x; }

  /// What all tests use; made once, because the master takes its time for each.
  struct Watch {
    ros::NodeHandle node;
    node_test::TestClock clock;
    Listener<RoverStatus> status{first + "/status"};
    Inbox<Odometry> truth{node, "/first/ground_truth"}, other{node, "/second/ground_truth"};
  };
  static inline Watch* watch_ = nullptr;

  ros::NodeHandle& node_ = watch_->node;
  node_test::TestClock* const clock_ = &watch_->clock;
  const Listener<RoverStatus>& status_ = watch_->status;
  const Inbox<Odometry>&truth_ = watch_->truth, &other_ = watch_->other;
};

/// A publisher of commands that the first rover listens to.
ros::Publisher commands_to_first() {
  const auto publisher = ros::NodeHandle().advertise<geometry_msgs::Twist>("/first/cmd_vel", 1);
  EXPECT_TRUE(wait_until([&] { return publisher.getNumSubscribers() > 0; }));
  return publisher;
}

TEST_F(TwoRovers, DriveWhereTheyAreToldAndPublishWhatBelongsTogether) {
  Inbox<Odometry> odom(node_, "/first/odom");
  Inbox<sensor_msgs::JointState> joints(node_, "/first/joint_states");
  Inbox<sensor_msgs::Imu> imu(node_, "/first/imu");
  tf2_ros::Buffer buffer;
  tf2_ros::TransformListener listener(buffer);
  ASSERT_TRUE(wait_until([&] {
    tick(0.02);
    return odom.last() && joints.last() && imu.last() &&
           buffer.canTransform("terrain", "first/base_link", ros::Time(0));
  })) << "the rover knows all who listen";
  EXPECT_NEAR(x_of(truth_), 60, 1e-6);
  EXPECT_EQ(truth_.last()->header.frame_id, "terrain");
  EXPECT_EQ(truth_.last()->child_frame_id, "first/base_link");
  const double other_x = x_of(other_);

  const ros::Publisher cmd = commands_to_first();
  geometry_msgs::Twist ahead;
  ahead.linear.x = 0.2;
  const auto drives_ahead = [&] {
    return x_of(truth_) > 60.8 && status_.last().state == RoverStatus::DRIVING &&
           std::abs(odom.last()->twist.twist.linear.x - 0.2) < 1e-9;
  };
  EXPECT_TRUE(tick_until(drives_ahead, 60, [&] { cmd.publish(ahead); }));
  EXPECT_TRUE(becomes(RoverStatus::IDLE, 5)) << "it goes on without commands";  // after cmd_vel_timeout
  EXPECT_EQ(x_of(other_), other_x);

  // All that it has published about its rest.
  tick();
  EXPECT_TRUE(is_of_now(odom) && is_of_now(joints) && is_of_now(imu));
  EXPECT_TRUE(wait_until([&] { return buffer.canTransform("terrain", "first/base_link", clock_->now()); }));
  EXPECT_TRUE(status_.wait_for([this](const RoverStatus& s) { return s.header.stamp == clock_->now(); }));
  const RoverStatus told = status_.last();
  EXPECT_EQ(told.state, RoverStatus::IDLE);
  // The wheels believe in the way of their rims; the way made is shorter by the slip.
  EXPECT_NEAR(odom.last()->pose.pose.position.x, told.way_commanded, 1e-3);
  EXPECT_NEAR(x_of(truth_) - 60, told.way_made, 2e-3);
  const double slip = 1 - told.way_made / told.way_commanded;
  EXPECT_GT(slip, 0.01);
  EXPECT_LT(slip, 0.1);
  EXPECT_LT(told.contact_error, 1e-4);
  EXPECT_EQ(told.wheels.size(), 4u);
  EXPECT_EQ(told.sinkage.size(), 4u);

  const sensor_msgs::JointState wheels = *joints.last();
  const auto front = std::find(wheels.name.begin(), wheels.name.end(), "front_left_wheel_joint");
  ASSERT_NE(front, wheels.name.end());
  EXPECT_NEAR(wheels.position[static_cast<std::size_t>(front - wheels.name.begin())],
              std::remainder(told.way_commanded / 0.1, 2 * M_PI), 1e-2);
  EXPECT_NEAR(imu.last()->linear_acceleration.z, 9.81, 0.05);
  EXPECT_EQ(imu.last()->header.frame_id, "first/base_link");

  const auto at_rest = buffer.lookupTransform("terrain", "first/base_link", clock_->now());
  EXPECT_NEAR(at_rest.transform.translation.x, x_of(truth_), 1e-6);
  EXPECT_NEAR(at_rest.transform.translation.z, truth_.last()->pose.pose.position.z, 1e-6);
  const auto believed = buffer.lookupTransform("first/odom", "first/base_footprint", clock_->now());
  EXPECT_NEAR(believed.transform.translation.x, odom.last()->pose.pose.position.x, 1e-6);
}

TEST_F(TwoRovers, TheOtherTurnsOnTheSpotAndDrivesSideways) {
  ASSERT_TRUE(set_pose(second, 80, 40, M_PI / 2).success);
  desert_sim::DriveRover::Request sideways;
  sideways.twist.linear.y = 0.2;
  sideways.seconds = 3;
  ASSERT_TRUE(ask<desert_sim::DriveRover>(second + "/drive", sideways).success);
  EXPECT_TRUE(tick_until([this] { return x_of(other_) < 79.6; }, 3.5));
  EXPECT_NEAR(other_.last()->pose.pose.position.y, 40, 0.01);
  // Its tracks move sand, and neither make nor lose any.
  Listener<RoverStatus> told(second + "/status");
  EXPECT_TRUE(told.wait_for([](const RoverStatus& s) { return s.tracks > 0; }));
  Listener<desert_sim::SimulationStatus> terrain("status");
  for (const desert_sim::MaterialVolume& material : terrain.last().volumes)
    EXPECT_EQ(material.residual, 0) << material.material;
}

TEST_F(TwoRovers, RefuseWhatIsNoCommandAndSaySo) {
  geometry_msgs::Twist bad;
  bad.linear.x = node_test::not_a_number;
  const ros::Publisher cmd = commands_to_first();
  cmd.publish(bad);
  EXPECT_TRUE(wait_until([this] {
    return status_.last().refusal.find("linear.x: nan") != std::string::npos;
  })) << status_.last().refusal;
  EXPECT_EQ(status_.last().state, RoverStatus::IDLE);
  const auto refused = [](const auto& answer, const std::string& what) {
    EXPECT_FALSE(answer.success);
    EXPECT_NE(answer.message.find(what), std::string::npos) << answer.message;
  };
  refused(drive(first, 0.1, node_test::infinity), "angular.z: inf");
  refused(drive(first, 0.1, 0, -3), "seconds");
  refused(set_pose(first, node_test::not_a_number, 0, 0), "x: nan");
  refused(set_pose(first, 1000, 0, 0), "off the terrain");
  desert_sim::LoadRover::Request load;
  load.name = "../outside";
  refused(ask<desert_sim::LoadRover>(first + "/load_state", load), "..");
  load.name = "missing";
  refused(ask<desert_sim::LoadRover>(first + "/load_state", load), "missing");
  tick();
  EXPECT_NEAR(x_of(truth_), 60, 1e-6);
}

TEST_F(TwoRovers, SavedStatesAreLoadedAndBadFilesRefused) {
  ASSERT_TRUE(set_pose(first, 70, 10, 1).success);
  desert_sim::SaveRover::Request save;
  save.name = "folder/rover";
  const auto saved = ask<desert_sim::SaveRover>(first + "/save_state", save);
  ASSERT_TRUE(saved.success) << saved.message;
  ASSERT_TRUE(ask<std_srvs::Trigger>(first + "/reset").success);
  desert_sim::LoadRover::Request load;
  load.name = save.name;
  const auto loaded = ask<desert_sim::LoadRover>(first + "/load_state", load);
  ASSERT_TRUE(loaded.success) << loaded.message;
  EXPECT_EQ(loaded.state_hash, saved.state_hash);
  tick();
  EXPECT_NEAR(x_of(truth_), 70, 1e-6);
  std::fstream(saved.path, std::ios::in | std::ios::out | std::ios::binary).seekp(300).put('!');
  const auto broken = ask<desert_sim::LoadRover>(first + "/load_state", load);
  EXPECT_FALSE(broken.success);
  EXPECT_NE(broken.message.find("checksum"), std::string::npos) << broken.message;
}

TEST_F(TwoRovers, TellThatTheTerrainEndsAndThatSandCameOnTheirWheels) {
  // x from 10 to 138
  ASSERT_TRUE(set_pose(first, 137.4, 20, 0).success);
  ASSERT_TRUE(drive(first, 0.3, 0).success);
  EXPECT_TRUE(becomes(RoverStatus::OFF_GRID)) << status_.last().reason;
  EXPECT_NE(status_.last().reason.find("terrain ends"), std::string::npos);
  ASSERT_TRUE(drive(first, -0.3, 0).success);
  EXPECT_TRUE(becomes(RoverStatus::DRIVING)) << status_.last().reason;

  // Sand falls on it, and is taken away again. The terrain comes at a time of its own.
  ASSERT_TRUE(set_pose(first, 40, 10, 0).success);
  ASSERT_TRUE(drive(first, 0, 0).success);
  desert_sim::EditTerrain::Request heap;
  heap.layer = "sand";
  heap.shape = "circle";
  heap.merge = "add";
  heap.center.x = 40;
  heap.center.y = 10;
  heap.radius = 6;
  heap.inner = 1;
  heap.value = 0.6;
  const auto becomes_with_the_terrain = [this](const std::string& state) {
    return wait_until([&] { return tick(), status_.last().state == state; });
  };
  ASSERT_TRUE(call<desert_sim::EditTerrain>("edit_terrain", heap).success);
  EXPECT_TRUE(becomes_with_the_terrain(RoverStatus::BURIED)) << status_.last().reason;
  EXPECT_NE(status_.last().reason.find("sand came on its wheels"), std::string::npos)
      << status_.last().reason;
  heap.merge = "sub";
  ASSERT_TRUE(call<desert_sim::EditTerrain>("edit_terrain", heap).success);
  EXPECT_TRUE(becomes_with_the_terrain(RoverStatus::IDLE)) << status_.last().reason;
}

TEST_F(TwoRovers, SeeInTheirFirstScanWhatOnlySensorsSee) {
  // Returns of the first cloud that a new subscriber gets.
  const auto returns_of_first_cloud = [this] {
    const Listener<sensor_msgs::PointCloud2> clouds("/first/lidar/points");
    EXPECT_TRUE(wait_until([&] { return tick(), clouds.count() > 0; }));
    const sensor_msgs::PointCloud2 cloud = clouds.all().at(0);
    std::size_t returns = 0;
    for (sensor_msgs::PointCloud2ConstIterator<float> x(cloud, "x"); x != x.end(); ++x)
      returns += std::isfinite(*x);
    return returns;
  };
  ASSERT_TRUE(call<std_srvs::Trigger>("reset").success);
  const std::size_t clear = returns_of_first_cloud();
  EXPECT_GT(clear, 1000u);
  ASSERT_TRUE(node_test::step(5).success);  // sand is in the air from now on
  for (int n = 0; n < 3; ++n) EXPECT_LT(returns_of_first_cloud(), clear / 2) << n;
}

}  // namespace

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "rover_test"); }
