// Messages of a planner: what is not finite, or does not fit together, is refused and named.

#include "src/ros/planner/planner_messages.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "test/support/refusal.hpp"

namespace desert_sim {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

template <class Action>
void expect_refused(const Action& action, const std::string& part) {
  const std::string text = test::refusal(action);
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

geometry_msgs::Pose pose_at(double x, double y, double w = 1) {
  geometry_msgs::Pose pose;
  pose.position.x = x;
  pose.position.y = y;
  pose.orientation.w = w;
  return pose;
}

geometry_msgs::PoseStamped goal(const std::string& frame, const geometry_msgs::Pose& pose) {
  geometry_msgs::PoseStamped goal;
  goal.header.frame_id = frame;
  goal.pose = pose;
  return goal;
}

/// Of two moments, on 3 × 2 cells.
Forecast forecast() {
  Forecast f;
  f.times = {10, 20};
  f.costs.resize(2);
  for (nav_msgs::OccupancyGrid& map : f.costs) {
    map.info.width = 3;
    map.info.height = 2;
    map.info.resolution = 0.5;
    map.data = {0, 50, 99, 100, -1, 0};
  }
  return f;
}

TEST(PlannerMessages, APlaceIsOfFiniteNumbers) {
  EXPECT_EQ(planar_pose(pose_at(3, -4), "it").y, -4);
  for (const double number : {infinity, -infinity, double(NAN)}) {
    expect_refused([&] { planar_pose(pose_at(number, 0), "it"); }, "it: the place");
    expect_refused([&] { planar_pose(pose_at(0, number), "it"); }, "not of finite numbers");
    expect_refused([&] { planar_pose(pose_at(0, 0, number), "it"); }, "it: the length of the quaternion");
  }
  expect_refused([&] { planar_pose(pose_at(0, 0, 0.5), "it"); }, "0.5");
}

TEST(PlannerMessages, AGoalIsBroughtIntoTheTerrainsFrame) {
  tf2::BufferCore transforms;
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = "map";
  transform.child_frame_id = "site";
  transform.transform.translation.x = 100;
  transform.transform.rotation.w = 1;
  ASSERT_TRUE(transforms.setTransform(transform, "test", true));
  const auto there = [&](const std::string& frame) {
    return goal_in_terrain(goal(frame, pose_at(1, 2)), "map", transforms);
  };
  EXPECT_EQ(there("site").pose.position.x, 101);
  EXPECT_EQ(there("/site").header.frame_id, "map");
  EXPECT_EQ(there("").pose.position.x, 1);
  expect_refused([&] { there("moon"); }, "the goal's frame 'moon' has no transform to 'map'");
  // tf2 takes places at infinity.
  transform.child_frame_id = "far";
  transform.transform.translation.x = infinity;
  ASSERT_TRUE(transforms.setTransform(transform, "test", true));
  expect_refused([&] { there("far"); }, "the goal in the frame 'map': the place");
}

TEST(PlannerMessages, ForecastsAreTimedByThePlannersClock) {
  const ForecastCosts costs = forecast_costs(forecast(), 5, 2, 0.5);
  EXPECT_EQ(costs.times, (std::vector<double>{20, 40}));
  EXPECT_EQ(costs.made, 5);
  EXPECT_EQ(costs.traversability[1][3], 0);
  Forecast f = forecast();
  f.costs[1].data.pop_back();
  expect_refused([&] { forecast_costs(f, 0, 1, 0.5); }, "moment 1");
}

TEST(PlannerMessages, WhoeverSaysNoConditionKnowsNoGround) {
  EXPECT_EQ(condition_named("stuck"), RoverCondition::stuck);
  EXPECT_EQ(condition_named("idle"), RoverCondition::idle);
  EXPECT_EQ(condition_named("no such condition"), RoverCondition::no_terrain);
}

}  // namespace
}  // namespace desert_sim
