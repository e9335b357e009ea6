/// Desert, rover and planner in lockstep, step by step.
#include <desert_sim/PlannerStatus.h>
#include <geometry_msgs/PoseStamped.h>

#include "test/support/ros/rover_tests.hpp"

namespace {

using desert_sim::PlannerStatus;
using node_test::ask;
using node_test::call;
using node_test::Listener;
using node_test::step;
using node_test::wait_until;

constexpr int steps = 12;

/// The rover's state, with the command that it obeys.
std::string rover_state() {
  desert_sim::SaveRover::Request save;
  save.name = "now";
  const auto answer = ask<desert_sim::SaveRover>("/desert_rover/save_state", save);
  EXPECT_TRUE(answer.success) << answer.message;
  return answer.state_hash;
}

/// Resets all, sets a goal and makes steps, each after the planner has acted on the one before. The states of
/// terrain and rover.
std::vector<std::string> path() {
  ask<std_srvs::Trigger>("/desert_planner/cancel");
  ask<std_srvs::Trigger>("/beside/forecast_planner/cancel");
  EXPECT_TRUE(call<std_srvs::Trigger>("reset").success);
  EXPECT_TRUE(ask<std_srvs::Trigger>("/desert_rover/reset").success);
  Listener<PlannerStatus> planner("/desert_planner/status"), forecaster("/beside/forecast_planner/status");
  EXPECT_TRUE(planner.wait_for([](const PlannerStatus& s) {
    return s.terrain_step == 0 && !s.header.frame_id.empty();
  })) << "it has not seen the start";
  ros::Publisher goals = ros::NodeHandle().advertise<geometry_msgs::PoseStamped>("/move_base_simple/goal", 1);
  EXPECT_TRUE(wait_until([&] { return goals.getNumSubscribers() == 2; })) << "both planners listen for goals";
  geometry_msgs::PoseStamped goal;
  goal.header.frame_id = "terrain";
  goal.pose.position.x = 20;
  goal.pose.position.y = 18;
  goal.pose.orientation.w = 1;
  goals.publish(goal);
  for (Listener<PlannerStatus>* listener : {&planner, &forecaster}) {
    EXPECT_TRUE(listener->wait_for([](const PlannerStatus& s) {
      return s.goal.pose.position.x == 20 && s.state == PlannerStatus::WAITING;
    })) << listener->last().state
        << " " << listener->last().refusal;
  }
  std::vector<std::string> states;
  for (int n = 1; n <= steps; ++n) {
    EXPECT_TRUE(step(1).success);
    EXPECT_TRUE(planner.wait_for([n](const PlannerStatus& s) {
      return s.terrain_step == static_cast<std::uint64_t>(n) && s.plans > 0;
    })) << "step "
        << n << ": " << planner.last().state << " " << planner.last().reason;
    EXPECT_TRUE(forecaster.wait_for([n](const PlannerStatus& s) {
      return s.terrain_step == static_cast<std::uint64_t>(n) && s.plans > 0;
    })) << "step "
        << n << ": " << forecaster.last().state << " " << forecaster.last().reason;
    states.push_back(node_test::hash() + " " + rover_state());
  }
  EXPECT_GE(forecaster.last().forecast_age, 0) << "it has waited for the forecast that it asked for";
  EXPECT_EQ(forecaster.last().refusal, "");
  EXPECT_EQ(planner.last().field_differences, 0U);
  EXPECT_EQ(planner.last().state, PlannerStatus::DRIVING) << planner.last().reason;
  return states;
}

TEST(PlannerLockstep, TheSameCallsGiveTheSamePath) {
  const std::vector<std::string> once = path();
  EXPECT_EQ(path(), once);
  EXPECT_NE(once.front(), once.back());
}

}  // namespace

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "planner_lockstep_test"); }
