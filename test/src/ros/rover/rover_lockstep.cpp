/// A rover in lockstep: the same commands between the same steps give the same path to the bit, again,
/// after a checkpoint, from the journal beside a simulation without ROS, and after kill -9; and the same
/// clouds of the lidar.
#include <desert_sim/EditTerrain.h>
#include <desert_sim/LoadCheckpoint.h>
#include <desert_sim/SaveCheckpoint.h>
#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <tf2/LinearMath/Transform.h>
#include <tf2_geometry_msgs/tf2_geometry_msgs.h>
#include <tf2_ros/transform_listener.h>

#include <algorithm>
#include <cmath>

#include "include/desert_sim/client/terrain_client.hpp"
#include "src/core/hash_text.hpp"
#include "src/ros/conversion/messages.hpp"
#include "src/rover/journal.hpp"
#include "src/rover/simulated_ground.hpp"
#include "test/support/ros/child_process.hpp"
#include "test/support/ros/rover_tests.hpp"

namespace {

using node_test::ask;
using node_test::call;
using node_test::drive;
using node_test::step;

const std::string rover = "/desert_rover";
constexpr int steps = 12;

double forward(int n) { return n % 5 == 4 ? -0.1 : 0.25; }
double turn(int n) { return 0.1 * (n % 3 - 1); }

/// The states before the commands from step `begin` on, and after the last step.
std::vector<std::string> path(int begin, int end) {
  std::vector<std::string> hashes;
  for (int n = begin; n < end; ++n) {
    const auto answer = drive(rover, forward(n), turn(n));
    EXPECT_TRUE(answer.success) << answer.message;
    EXPECT_EQ(answer.terrain_step, static_cast<std::uint64_t>(n));
    hashes.push_back(answer.state_hash);
    EXPECT_TRUE(step(1).success);
  }
  hashes.push_back(drive(rover, 0, 0).state_hash);
  return hashes;
}

void begin_anew() {
  ASSERT_TRUE(call<std_srvs::Trigger>("reset").success);
  const auto answer = ask<std_srvs::Trigger>(rover + "/reset");
  ASSERT_TRUE(answer.success) << answer.message;
}

TEST(RoverLockstep, TheSameCallsGiveTheSamePath) {
  begin_anew();
  const std::vector<std::string> once = path(0, steps);
  begin_anew();
  EXPECT_EQ(path(0, steps), once);
  EXPECT_NE(once.front(), once.back());
  node_test::Listener<desert_sim::RoverStatus> status(rover + "/status");
  EXPECT_TRUE(status.wait_for([](const desert_sim::RoverStatus& s) { return s.way_made > 2; }))
      << status.last().way_made << " m, " << status.last().state << " " << status.last().reason;
}

TEST(RoverLockstep, ACommandIsToldAtOnce) {
  begin_anew();
  node_test::Listener<desert_sim::RoverStatus> status(rover + "/status");
  ASSERT_TRUE(status.wait_for([](const desert_sim::RoverStatus&) { return true; }));
  const std::uint64_t before = status.last().commands;
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<geometry_msgs::Twist>("/cmd_vel", 1);
  ASSERT_TRUE(node_test::wait_until([&] { return publisher.getNumSubscribers() > 0; }));
  geometry_msgs::Twist command;
  const auto told = [&](std::uint64_t number) {
    publisher.publish(command);
    return status.wait_for([&](const desert_sim::RoverStatus& s) { return s.commands == before + number; });
  };
  command.linear.x = 0.125;
  EXPECT_TRUE(told(1));
  EXPECT_EQ(status.last().command.linear.x, 0.125);
  EXPECT_TRUE(told(2)) << "the same again";
  command.linear.x = NAN;
  EXPECT_TRUE(told(3)) << "refused";
  EXPECT_EQ(status.last().command.linear.x, 0.125);
  EXPECT_NE(status.last().refusal, "");
}

TEST(RoverLockstep, ACheckpointOfBothGoesOnTheSameWay) {
  begin_anew();
  std::vector<std::string> whole = path(0, 6);
  desert_sim::SaveCheckpoint::Request terrain;
  terrain.name = "terrain";
  ASSERT_TRUE(call<desert_sim::SaveCheckpoint>("save_checkpoint", terrain).success);
  desert_sim::SaveRover::Request state;
  state.name = "rover";
  const auto saved = ask<desert_sim::SaveRover>(rover + "/save_state", state);
  ASSERT_TRUE(saved.success) << saved.message;
  EXPECT_EQ(saved.terrain_step, 6u);
  whole = path(6, steps);

  for (const bool terrain_first : {true, false}) {
    begin_anew();
    path(0, 2);
    desert_sim::LoadCheckpoint::Request load;
    load.name = "terrain";
    desert_sim::LoadRover::Request load_rover;
    load_rover.name = "rover";
    if (terrain_first) {
      ASSERT_TRUE(call<desert_sim::LoadCheckpoint>("load_checkpoint", load).success);
    }
    const auto loaded = ask<desert_sim::LoadRover>(rover + "/load_state", load_rover);
    ASSERT_TRUE(loaded.success) << loaded.message;
    EXPECT_EQ(loaded.state_hash, saved.state_hash);
    if (!terrain_first) {
      ASSERT_TRUE(call<desert_sim::LoadCheckpoint>("load_checkpoint", load).success);
    }
    EXPECT_EQ(path(6, steps), whole) << terrain_first;
  }
}

TEST(RoverLockstep, TheJournalLeadsToTheSameStateWithoutRos) {
  begin_anew();
  path(0, steps);
  const std::string end = drive(rover, 0, 0).state_hash;
  std::string file;
  ASSERT_TRUE(ros::param::get("/rover_lockstep/journal", file));
  desert_sim::RoverJournal journal = desert_sim::read_rover_journal(file);
  EXPECT_EQ(journal.wet_ground.half_wet, 2.5) << "as the parameters of its node say";
  EXPECT_EQ(journal.wet_ground.saturated, 0.25);
  // What came before the last reset had terrains of its own.
  auto first = journal.events.begin();
  for (auto event = journal.events.begin(); event != journal.events.end(); ++event)
    if (const auto* place = std::get_if<desert_sim::rover_event::Place>(&*event); place && place->reset)
      first = event;
  journal.events.erase(journal.events.begin(), first);
  desert_sim::Scenario scenario =
      desert_sim::load_scenario(DESERT_SOURCE_DIR "/test/support/ros/scenarios/drifting.yaml");
  desert_sim::SimulatedGround ground(scenario, desert_sim::no_raster_loader, "cpu", 1);
  const auto at_step = [&ground](std::uint64_t wanted) -> const desert_sim::GroundSource& {
    return ground.at(wanted);
  };
  EXPECT_EQ(desert_sim::hash_text(desert_sim::hash_of(desert_sim::replay(journal, at_step))), end);
}

TEST(RoverLockstep, AnObstacleStopsIt) {
  begin_anew();
  const node_test::Listener<desert_sim::RoverStatus> status(rover + "/status");
  ASSERT_TRUE(node_test::set_pose(rover, 8, 12, 0).success);
  desert_sim::EditTerrain::Request rock;
  rock.layer = "obstacle";
  rock.shape = "rectangle";
  rock.merge = "replace";
  rock.center.x = 11;
  rock.center.y = 12;
  rock.radius = rock.radius_y = 1;
  rock.inner = 1;
  rock.value = 1;
  ASSERT_TRUE(call<desert_sim::EditTerrain>("edit_terrain", rock).success);
  ASSERT_TRUE(drive(rover, 0.3, 0).success);
  desert_sim::RoverStatus told;
  for (std::uint64_t n = 1; n <= 10 && told.state != desert_sim::RoverStatus::BLOCKED; ++n) {
    ASSERT_TRUE(step(1).success);
    ASSERT_TRUE(status.wait_for([&](const desert_sim::RoverStatus& s) {
      told = s;
      return s.terrain_step == n;
    }));
  }
  EXPECT_EQ(told.state, desert_sim::RoverStatus::BLOCKED);
  EXPECT_NE(told.reason.find("obstacle"), std::string::npos) << told.reason;
}

TEST(RoverLockstep, CloudsLieOnTheTerrainAndRepeatToTheBit) {
  constexpr int scans = 5;
  desert_sim::TerrainClient terrain;
  tf2_ros::Buffer buffer;
  tf2_ros::TransformListener listener(buffer);
  const node_test::Listener<sensor_msgs::PointCloud2> clouds("/lidar/points");
  begin_anew();
  ASSERT_TRUE(node_test::wait_until([&] {
    return step(1).success && clouds.count() > 0 && buffer.canTransform("terrain", "lidar", ros::Time(0));
  })) << "each state has a scan and transforms once the rover knows who listens to them";
  const auto last_clouds = [&] {
    begin_anew();
    const ros::Time begin = ros::Time::now();  // by the same clock as stamps
    path(0, scans);
    std::vector<sensor_msgs::PointCloud2> found;
    EXPECT_TRUE(node_test::wait_until([&] {
      found = clouds.all();
      found.erase(std::remove_if(found.begin(), found.end(),
                                 [&](const auto& cloud) { return cloud.header.stamp < begin; }),
                  found.end());
      return found.size() >= scans;
    }));
    return found;
  };
  const std::vector<sensor_msgs::PointCloud2> once = last_clouds(), again = last_clouds();
  ASSERT_EQ(once.size(), static_cast<std::size_t>(scans));
  ASSERT_EQ(again.size(), static_cast<std::size_t>(scans));
  for (std::size_t n = 0; n < once.size(); ++n) EXPECT_EQ(once[n].data, again[n].data) << n;
  EXPECT_NE(once.front().data, once.back().data);
  for (std::size_t n = 1; n < again.size(); ++n) EXPECT_GT(again[n].header.stamp, again[n - 1].header.stamp);
  EXPECT_GT(again.front().header.stamp, once.back().header.stamp) << "each state has a scan of its own";

  const sensor_msgs::PointCloud2& cloud = again.back();
  EXPECT_EQ(cloud.header.frame_id, "lidar");
  ASSERT_TRUE(node_test::wait_until(
      [&] { return terrain.map() && terrain.map()->info().stamp == cloud.header.stamp; }));
  ASSERT_EQ(terrain.map()->info().step, static_cast<std::uint64_t>(scans));
  ASSERT_TRUE(
      node_test::wait_until([&] { return buffer.canTransform("terrain", "lidar", cloud.header.stamp); }));
  tf2::Transform to_terrain;
  tf2::fromMsg(buffer.lookupTransform("terrain", "lidar", cloud.header.stamp).transform, to_terrain);
  int points = 0, lost = 0;
  sensor_msgs::PointCloud2ConstIterator<float> p(cloud, "x");
  for (; p != p.end(); ++p) {
    if (std::isnan(p[0])) {
      ++lost;
      continue;
    }
    const tf2::Vector3 at = to_terrain * tf2::Vector3(p[0], p[1], p[2]);
    const std::optional<double> ground = terrain.elevation(at.x(), at.y());
    if (!ground) continue;  // noise has moved a point at the edge over it
    ++points;
    EXPECT_NEAR(at.z(), *ground, 0.01) << at.x() << " " << at.y();
  }
  EXPECT_GT(points, 400);
  EXPECT_GT(lost, 30) << "a tenth is dropped";
}

TEST(RoverLockstep, ANodeThatIsKilledStartsSanely) {
  begin_anew();
  const std::string name = "/killed";
  ros::param::set(name + "/clock", std::string("lockstep"));
  ros::param::set(name + "/answer_timeout", 600.0);
  ros::param::set(name + "/publish_tf", false);
  ros::param::set(name + "/x", 10.0);
  ros::param::set(name + "/y", 14.0);
  std::string folder;
  ASSERT_TRUE(ros::param::get("/desert_rover/data_dir", folder));
  ros::param::set(name + "/data_dir", folder);
  const auto start = [&] {
    return std::make_unique<node_test::ChildProcess>(
        std::vector<std::string>{DESERT_ROVER_BINARY, "__name:=killed", "odom:=/killed/odom",
                                 "imu:=/killed/imu", "joint_states:=/killed/joint_states",
                                 "ground_truth:=/killed/ground_truth", "cmd_vel:=/killed/cmd_vel"});
  };
  const auto wait_for_answer = [&] {
    return node_test::wait_until(
        [&] { return ros::service::exists(name + "/drive", false) && drive(name, 0.2, 0.1).success; });
  };
  auto process = start();
  ASSERT_TRUE(wait_for_answer());
  ASSERT_TRUE(step(1).success);
  desert_sim::SaveRover::Request save;
  save.name = "killed";
  const auto saved = ask<desert_sim::SaveRover>(name + "/save_state", save);
  ASSERT_TRUE(saved.success) << saved.message;
  ASSERT_TRUE(step(1).success);
  EXPECT_EQ(process->end(SIGKILL), 128 + SIGKILL);
  ASSERT_TRUE(step(1).success);
  process = start();
  ASSERT_TRUE(wait_for_answer());
  node_test::Listener<nav_msgs::Odometry> truth("/killed/ground_truth");
  EXPECT_NEAR(truth.last().pose.pose.position.x, 10, 1e-6);
  desert_sim::LoadRover::Request load;
  load.name = "killed";
  const auto loaded = ask<desert_sim::LoadRover>(name + "/load_state", load);
  EXPECT_TRUE(loaded.success) << loaded.message;
  EXPECT_EQ(loaded.state_hash, saved.state_hash);
  EXPECT_EQ(process->end(SIGTERM), 0);
}

TEST(RoverLockstep, WithoutAPlaceItStartsWhereItCanDriveOff) {
  begin_anew();
  desert_sim::EditTerrain::Request tower;  // in the middle, which is (12, 12)
  tower.layer = "bedrock";
  tower.shape = "circle";
  tower.merge = "add";
  tower.center.x = tower.center.y = 12;
  tower.radius = 2.5;
  tower.inner = 1;
  tower.value = 4;
  ASSERT_TRUE(call<desert_sim::EditTerrain>("edit_terrain", tower).success);
  ASSERT_TRUE(step(1).success);
  const std::string name = "/beside";
  ros::param::set(name + "/clock", std::string("lockstep"));
  ros::param::set(name + "/seconds_per_sim_second", 2);
  ros::param::set(name + "/answer_timeout", 600.0);
  ros::param::set(name + "/publish_tf", false);
  node_test::ChildProcess process({DESERT_ROVER_BINARY, "__name:=beside", "odom:=/beside/odom",
                                   "imu:=/beside/imu", "joint_states:=/beside/joint_states",
                                   "ground_truth:=/beside/ground_truth", "cmd_vel:=/beside/cmd_vel"});
  ASSERT_TRUE(node_test::wait_until(
      [&] { return ros::service::exists(name + "/drive", false) && drive(name, 0.2, 0).success; }));
  node_test::Listener<nav_msgs::Odometry> truth("/beside/ground_truth");
  const auto start = truth.last().pose.pose.position;
  EXPECT_GT(std::hypot(start.x - 12, start.y - 12), 2.5) << "not on the tower";
  EXPECT_LT(std::hypot(start.x - 12, start.y - 12), 6) << "but near to it";
  ASSERT_TRUE(step(5).success);
  EXPECT_TRUE(
      truth.wait_for([&](const nav_msgs::Odometry& o) { return o.pose.pose.position.x > start.x + 0.5; }));
  EXPECT_EQ(process.end(SIGTERM), 0);
  begin_anew();
}

TEST(RoverLockstep, BadParametersEndANodeWithTheirNames) {
  const std::string name = "/bad";
  ros::param::del(name);
  ros::param::set(name + "/rate", 1e9);
  ros::param::set(name + "/rover/wheel_radius", -1.0);
  ros::param::set(name + "/speed", 3);
  node_test::ChildProcess process({DESERT_ROVER_BINARY, "__name:=bad"});
  EXPECT_EQ(process.wait(), 2);
}

}  // namespace

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "rover_lockstep_test"); }
