/// A rover that was asked for micro-relief: its wheels and its lidar meet the ripples of the simulation, and
/// its heaps at live bushes, at the same step, to the bit for wheels; a rover that was not asked has none.
#include <desert_sim/MicroReliefState.h>
#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <tf2/LinearMath/Transform.h>
#include <tf2_geometry_msgs/tf2_geometry_msgs.h>
#include <tf2_ros/transform_listener.h>

#include <algorithm>
#include <cmath>

#include "src/core/hash_text.hpp"
#include "src/ros/conversion/messages.hpp"
#include "src/rover/journal.hpp"
#include "src/rover/simulated_ground.hpp"
#include "test/support/ros/rover_tests.hpp"

namespace {

using node_test::ask;
using node_test::call;
using node_test::drive;
using node_test::step;

const std::string rippled = "/rippled", smooth = "/other/smooth";
constexpr int steps = 8;

desert_sim::SimulatedGround ground_of_scenario(bool micro_relief,
                                               const std::string& name = "rippled_bushes") {
  return {desert_sim::load_scenario(DESERT_SOURCE_DIR "/test/support/ros/scenarios/" + name + ".yaml"),
          desert_sim::no_raster_loader, "cpu", 1, micro_relief};
}

/// The state of a rover that was told to stop.
std::string stopped(const std::string& rover) {
  drive(rover, 0, 0);
  return drive(rover, 0, 0).state_hash;
}

/// Both rovers drive from the start; what they end with.
std::pair<std::string, std::string> drive_both() {
  EXPECT_TRUE(call<std_srvs::Trigger>("reset").success);
  for (const std::string& rover : {rippled, smooth}) {
    const auto answer = ask<std_srvs::Trigger>(rover + "/reset");
    EXPECT_TRUE(answer.success) << answer.message;
  }
  for (int n = 0; n < steps; ++n) {
    for (const std::string& rover : {rippled, smooth}) {
      const auto answer = drive(rover, 0.25, 0.1 * (n % 3 - 1));
      EXPECT_TRUE(answer.success) << answer.message;
    }
    EXPECT_TRUE(step(1).success);
  }
  return {stopped(rippled), stopped(smooth)};
}

TEST(RoverMicroRelief, WheelsDriveOnTheRipplesOfTheSimulation) {
  const auto [with, without] = drive_both();
  EXPECT_NE(with, without);
  std::string file;
  ASSERT_TRUE(ros::param::get("/rover_micro_relief/journal", file));
  desert_sim::RoverJournal journal = desert_sim::read_rover_journal(file);
  EXPECT_TRUE(journal.micro_relief);
  const auto end_on = [&journal](bool micro_relief, const std::string& name = "rippled_bushes") {
    desert_sim::SimulatedGround ground = ground_of_scenario(micro_relief, name);
    return desert_sim::hash_text(desert_sim::hash_of(desert_sim::replay(
        journal, [&ground](std::uint64_t at) -> const desert_sim::GroundSource& { return ground.at(at); })));
  };
  EXPECT_EQ(end_on(true), with);
  EXPECT_NE(end_on(false), with);
  EXPECT_NE(end_on(true, "rippled"), with) << "heaps at bushes are in its way";
}

TEST(RoverMicroRelief, RoversInRosTimeStandOnThem) {
  const node_test::Listener<nav_msgs::Odometry> rippled_one("/timed/on_ripples"),
      smooth_one("/timed/on_smooth_sand");
  const auto on_smooth_sand = smooth_one.last().pose.pose, on_ripples = rippled_one.last().pose.pose;
  EXPECT_EQ(on_smooth_sand.position.x, -8);
  EXPECT_EQ(on_ripples.position.x, -8);
  EXPECT_NEAR(on_ripples.position.z, on_smooth_sand.position.z, 0.015) << "ripples are 14 mm high";
  EXPECT_NE(on_ripples.position.z, on_smooth_sand.position.z);
}

/// What the desert tells of its last state after drive_both(); stamps are of this machine's time.
desert_sim::MicroReliefState last_state_of_drive(
    const node_test::Listener<desert_sim::MicroReliefState>& states) {
  const ros::Time begin = ros::Time::now();
  drive_both();
  desert_sim::MicroReliefState last;
  EXPECT_TRUE(states.wait_for([&](const desert_sim::MicroReliefState& m) {
    last = m;
    return m.step == steps && m.header.stamp >= begin;
  }));
  return last;
}

TEST(RoverMicroRelief, TheWindOfRipplesIsThatOfTheState) {
  const node_test::Listener<desert_sim::MicroReliefState> states("/desert_sim/micro_relief");
  const desert_sim::MicroReliefState m = last_state_of_drive(states);
  EXPECT_EQ(m.header.frame_id, "terrain");
  EXPECT_EQ(m.seed, 3u);
  EXPECT_EQ(m.mean_speed, 15);
  EXPECT_EQ(m.mean_wind_x, 15);
  EXPECT_EQ(m.mean_wind_y, 0);
  EXPECT_GT(m.ripples_passed, 0);
  EXPECT_NEAR(m.ripple_wavelength, 0.013 + 0.02 * 14, 1e-6) << "the default law at 15 m/s";
  EXPECT_NEAR(m.ripple_height, 0.0467 * m.ripple_wavelength, 1e-6);
  EXPECT_FALSE(m.periodic_x || m.periodic_y);
  EXPECT_NE(m.parameters.find("threshold_speed: 1"), std::string::npos) << m.parameters;
}

/// How far the points of a cloud are from a ground [m].
std::vector<double> distances(const sensor_msgs::PointCloud2& cloud, const tf2::Transform& to_terrain,
                              const desert_sim::GroundSource& ground) {
  std::vector<double> all;
  for (sensor_msgs::PointCloud2ConstIterator<float> p(cloud, "x"); p != p.end(); ++p) {
    if (std::isnan(p[0])) continue;
    const tf2::Vector3 at = to_terrain * tf2::Vector3(p[0], p[1], p[2]);
    if (const std::optional<double> z = ground.elevation(at.x(), at.y()))
      all.push_back(std::abs(at.z() - *z));
  }
  std::sort(all.begin(), all.end());
  return all;
}

TEST(RoverMicroRelief, BeamsEndOnThem) {
  tf2_ros::Buffer buffer;
  tf2_ros::TransformListener transforms(buffer);
  const node_test::Listener<desert_sim::MicroReliefState> states("/desert_sim/micro_relief");
  const node_test::Listener<sensor_msgs::PointCloud2> clouds("/lidar/points");
  // Each state has a scan and transforms once the rover knows who listens to them.
  ASSERT_TRUE(node_test::wait_until([&] {
    return step(1).success && clouds.count() > 0 && buffer.canTransform("terrain", "lidar", ros::Time(0));
  }));
  const ros::Time stamp = last_state_of_drive(states).header.stamp;
  sensor_msgs::PointCloud2 cloud;
  ASSERT_TRUE(clouds.wait_for([&](const sensor_msgs::PointCloud2& m) {
    cloud = m;
    return m.header.stamp == stamp;
  }));
  ASSERT_TRUE(node_test::wait_until([&] { return buffer.canTransform("terrain", "lidar", stamp); }));
  tf2::Transform to_terrain;
  tf2::fromMsg(buffer.lookupTransform("terrain", "lidar", stamp).transform, to_terrain);
  desert_sim::SimulatedGround with = ground_of_scenario(true), without = ground_of_scenario(false);
  const std::vector<double> close = distances(cloud, to_terrain, with.at(steps)),
                            far = distances(cloud, to_terrain, without.at(steps));
  ASSERT_GT(close.size(), 400u);
  EXPECT_LT(close.back(), 5e-4);
  EXPECT_GT(far[far.size() / 2], 1e-3) << "half of the points are off by more where there are no ripples";
}

}  // namespace

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "rover_micro_relief_test"); }
