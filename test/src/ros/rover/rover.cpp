/// Two rovers in one master: what they publish belongs together, what they are told is obeyed or refused.
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

#include "test/support/ros/rover_tests.hpp"

namespace {

using desert_sim::RoverStatus;
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
  void SetUp() override {
    ASSERT_TRUE(wait_until(
        [this] { return status_.count() > 0 && status_.last().state != RoverStatus::NO_TERRAIN; }, 30))
        << status_.last().reason;
    const auto answer = ask<std_srvs::Trigger>(first + "/reset");
    ASSERT_TRUE(answer.success) << answer.message;
  }
  bool is(const std::string& state) {
    return wait_until([&] { return status_.last().state == state; });
  }
  Listener<RoverStatus> status_{first + "/status"};
};

TEST_F(TwoRovers, DriveWhereTheyAreToldAndPublishWhatBelongsTogether) {
  Listener<Odometry> odom("/first/odom"), truth("/first/ground_truth"), other("/second/ground_truth");
  Listener<sensor_msgs::JointState> joints("/first/joint_states");
  Listener<sensor_msgs::Imu> imu("/first/imu");
  tf2_ros::Buffer buffer;
  tf2_ros::TransformListener listener(buffer);
  const auto start = truth.last();
  EXPECT_NEAR(start.pose.pose.position.x, 60, 1e-6);
  EXPECT_EQ(start.header.frame_id, "terrain");
  EXPECT_EQ(start.child_frame_id, "first/base_link");
  const double other_x = other.last().pose.pose.position.x;

  ros::Publisher cmd = ros::NodeHandle().advertise<geometry_msgs::Twist>("/first/cmd_vel", 1);
  geometry_msgs::Twist ahead;
  ahead.linear.x = 0.2;
  EXPECT_TRUE(wait_until([&] {
    cmd.publish(ahead);
    ros::WallDuration(0.05).sleep();
    return truth.last().pose.pose.position.x > 60.8;
  }));
  EXPECT_EQ(status_.last().state, RoverStatus::DRIVING);
  EXPECT_NEAR(odom.last().twist.twist.linear.x, 0.2, 1e-9);
  EXPECT_TRUE(is(RoverStatus::IDLE)) << "it goes on without commands";  // after cmd_vel_timeout
  EXPECT_EQ(other.last().pose.pose.position.x, other_x);

  // The wheels believe in the way of their rims; the way made is shorter by the slip.
  const RoverStatus told = status_.last();
  EXPECT_NEAR(odom.last().pose.pose.position.x, told.way_commanded, 1e-3);
  EXPECT_NEAR(truth.last().pose.pose.position.x - 60, told.way_made, 2e-3);
  const double slip = 1 - told.way_made / told.way_commanded;
  EXPECT_GT(slip, 0.01);
  EXPECT_LT(slip, 0.1);
  EXPECT_LT(told.contact_error, 1e-4);
  EXPECT_EQ(told.wheels.size(), 4u);
  EXPECT_EQ(told.sinkage.size(), 4u);

  const sensor_msgs::JointState wheels = joints.last();
  const auto front = std::find(wheels.name.begin(), wheels.name.end(), "front_left_wheel_joint");
  ASSERT_NE(front, wheels.name.end());
  EXPECT_NEAR(wheels.position[static_cast<std::size_t>(front - wheels.name.begin())],
              std::remainder(told.way_commanded / 0.1, 2 * M_PI), 1e-2);
  EXPECT_NEAR(imu.last().linear_acceleration.z, 9.81, 0.05);
  EXPECT_EQ(imu.last().header.frame_id, "first/base_link");

  const auto at_rest = buffer.lookupTransform("terrain", "first/base_link", ros::Time(0), ros::Duration(5));
  EXPECT_NEAR(at_rest.transform.translation.x, truth.last().pose.pose.position.x, 1e-6);
  EXPECT_NEAR(at_rest.transform.translation.z, truth.last().pose.pose.position.z, 1e-6);
  const auto believed =
      buffer.lookupTransform("first/odom", "first/base_footprint", ros::Time(0), ros::Duration(5));
  EXPECT_NEAR(believed.transform.translation.x, odom.last().pose.pose.position.x, 1e-6);
  const auto rate = truth.count();
  ros::WallDuration(1).sleep();
  EXPECT_GT(truth.count() - rate, 25u) << "50 Hz are wanted";
}

TEST_F(TwoRovers, TheOtherTurnsOnTheSpotAndDrivesSideways) {
  Listener<Odometry> truth("/second/ground_truth");
  ASSERT_TRUE(set_pose(second, 80, 40, M_PI / 2).success);
  desert_sim::DriveRover::Request sideways;
  sideways.twist.linear.y = 0.2;
  sideways.seconds = 3;
  ASSERT_TRUE(ask<desert_sim::DriveRover>(second + "/drive", sideways).success);
  EXPECT_TRUE(wait_until([&] { return truth.last().pose.pose.position.x < 79.6; }));
  EXPECT_NEAR(truth.last().pose.pose.position.y, 40, 0.01);
  // Its tracks move sand, and neither make nor lose any.
  Listener<RoverStatus> told(second + "/status");
  EXPECT_TRUE(told.wait_for([](const RoverStatus& s) { return s.tracks > 0; }));
  Listener<desert_sim::SimulationStatus> terrain("status");
  for (const desert_sim::MaterialVolume& material : terrain.last().volumes)
    EXPECT_EQ(material.residual, 0) << material.material;
}

TEST_F(TwoRovers, RefuseWhatIsNoCommandAndSaySo) {
  ros::Publisher cmd = ros::NodeHandle().advertise<geometry_msgs::Twist>("/first/cmd_vel", 1);
  geometry_msgs::Twist bad;
  bad.linear.x = node_test::not_a_number;
  EXPECT_TRUE(wait_until([&] {
    cmd.publish(bad);
    ros::WallDuration(0.05).sleep();
    return status_.last().refusal.find("linear.x: = nan") != std::string::npos;
  })) << status_.last().refusal;
  EXPECT_EQ(status_.last().state, RoverStatus::IDLE);
  const auto refused = [](const auto& answer, const std::string& what) {
    EXPECT_FALSE(answer.success);
    EXPECT_NE(answer.message.find(what), std::string::npos) << answer.message;
  };
  refused(drive(first, 0.1, node_test::infinity), "angular.z: = inf");
  refused(drive(first, 0.1, 0, -3), "seconds");
  refused(set_pose(first, node_test::not_a_number, 0, 0), "x: = nan");
  refused(set_pose(first, 1000, 0, 0), "off the terrain");
  desert_sim::LoadRover::Request load;
  load.name = "../outside";
  refused(ask<desert_sim::LoadRover>(first + "/load_state", load), "..");
  load.name = "missing";
  refused(ask<desert_sim::LoadRover>(first + "/load_state", load), "missing");
  EXPECT_NEAR(Listener<Odometry>("/first/ground_truth").last().pose.pose.position.x, 60, 1e-6);
}

TEST_F(TwoRovers, SavedStatesAreLoadedAndBadFilesRefused) {
  const std::string before = drive(first, 0, 0).state_hash;
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
  EXPECT_TRUE(wait_until([] {
    return std::abs(Listener<Odometry>("/first/ground_truth").last().pose.pose.position.x - 70) < 1e-6;
  }));
  std::fstream(saved.path, std::ios::in | std::ios::out | std::ios::binary).seekp(300).put('!');
  const auto broken = ask<desert_sim::LoadRover>(first + "/load_state", load);
  EXPECT_FALSE(broken.success);
  EXPECT_NE(broken.message.find("checksum"), std::string::npos) << broken.message;
}

TEST_F(TwoRovers, TellWhatStopsThem) {
  // The edge of the terrain: x from 10 to 138.
  ASSERT_TRUE(set_pose(first, 137.4, 20, 0).success);
  ASSERT_TRUE(drive(first, 0.3, 0).success);
  EXPECT_TRUE(is(RoverStatus::OFF_GRID)) << status_.last().reason;
  EXPECT_NE(status_.last().reason.find("terrain ends"), std::string::npos);
  ASSERT_TRUE(drive(first, -0.3, 0).success);
  EXPECT_TRUE(is(RoverStatus::DRIVING)) << status_.last().reason;

  // An obstacle ahead.
  ASSERT_TRUE(set_pose(first, 50, 0, 0).success);
  desert_sim::EditTerrain::Request rock;
  rock.layer = "obstacle";
  rock.shape = "rectangle";
  rock.merge = "replace";
  rock.center.x = 53;
  rock.radius = rock.radius_y = 1;
  rock.inner = 1;
  rock.value = 1;
  ASSERT_TRUE(call<desert_sim::EditTerrain>("edit_terrain", rock).success);
  ASSERT_TRUE(drive(first, 0.3, 0).success);
  EXPECT_TRUE(is(RoverStatus::BLOCKED)) << status_.last().reason;
  EXPECT_NE(status_.last().reason.find("obstacle"), std::string::npos) << status_.last().reason;

  // Sand falls on it, and is taken away again.
  ASSERT_TRUE(set_pose(first, 40, 10, 0).success);
  desert_sim::EditTerrain::Request heap;
  heap.layer = "sand";
  heap.shape = "circle";
  heap.merge = "add";
  heap.center.x = 40;
  heap.center.y = 10;
  heap.radius = 6;
  heap.inner = 1;
  heap.value = 0.6;
  ASSERT_TRUE(call<desert_sim::EditTerrain>("edit_terrain", heap).success);
  EXPECT_TRUE(is(RoverStatus::BURIED)) << status_.last().reason;
  EXPECT_NE(status_.last().reason.find("sand came on its wheels"), std::string::npos)
      << status_.last().reason;
  heap.merge = "sub";
  ASSERT_TRUE(call<desert_sim::EditTerrain>("edit_terrain", heap).success);
  EXPECT_TRUE(is(RoverStatus::IDLE)) << status_.last().reason;
}

/// Returns of the first cloud that a new subscriber gets.
std::size_t returns_of_first_cloud() {
  Listener<sensor_msgs::PointCloud2> clouds("/first/lidar/points");
  clouds.last();
  const sensor_msgs::PointCloud2 cloud = clouds.all().front();
  std::size_t returns = 0;
  for (sensor_msgs::PointCloud2ConstIterator<float> x(cloud, "x"); x != x.end(); ++x)
    returns += std::isfinite(*x);
  return returns;
}

TEST_F(TwoRovers, SeeInTheirFirstScanWhatOnlySensorsSee) {
  ASSERT_TRUE(call<std_srvs::Trigger>("reset").success);
  const std::size_t clear = returns_of_first_cloud();
  EXPECT_GT(clear, 1000u);
  ASSERT_TRUE(node_test::step(5).success);  // sand is in the air from now on
  for (int n = 0; n < 3; ++n) EXPECT_LT(returns_of_first_cloud(), clear / 2) << n;
}

}  // namespace

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "rover_test"); }
