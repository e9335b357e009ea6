/// A planner beside a rover, in a ROS time that the test tells: goals by topic and action, what comes into
/// the way, and what it says when there is no way.
#include <actionlib/client/simple_action_client.h>
#include <actionlib/server/action_server.h>
#include <desert_sim/EditTerrain.h>
#include <desert_sim/Forecast.h>
#include <desert_sim/ForecastTerrainAction.h>
#include <desert_sim/PlannerStatus.h>
#include <move_base_msgs/MoveBaseAction.h>
#include <nav_msgs/OccupancyGrid.h>
#include <nav_msgs/Path.h>
#include <ros/master.h>

#include <set>

#include "include/desert_sim/testing/inbox.hpp"
#include "test/support/ros/child_process.hpp"
#include "test/support/ros/rover_tests.hpp"
#include "test/support/ros/test_clock.hpp"

namespace {

using desert_sim::PlannerStatus;
using desert_sim::RoverStatus;
using desert_sim::test::Inbox;
using node_test::ask;
using node_test::call;
using node_test::Listener;
using node_test::wait_until;
using MoveBase = actionlib::SimpleActionClient<move_base_msgs::MoveBaseAction>;

const std::string rover = "/desert_rover", planner = "/desert_planner";

geometry_msgs::PoseStamped pose_at(double x, double y) {
  geometry_msgs::PoseStamped pose;
  pose.header.frame_id = "terrain";
  pose.pose.position.x = x;
  pose.pose.position.y = y;
  pose.pose.orientation.w = 1;
  return pose;
}

move_base_msgs::MoveBaseGoal goal_at(double x, double y) {
  move_base_msgs::MoveBaseGoal goal;
  goal.target_pose = pose_at(x, y);
  return goal;
}

/// A rectangle of obstacles, or of sand that is added or taken away.
void edit(const std::string& layer, const std::string& merge, double value, double x, double y, double half_x,
          double half_y) {
  desert_sim::EditTerrain::Request request;
  request.layer = layer;
  request.shape = "rectangle";
  request.merge = merge;
  request.center.x = x;
  request.center.y = y;
  request.radius = half_x;
  request.radius_y = half_y;
  request.inner = 1;
  request.value = value;
  const auto answer = call<desert_sim::EditTerrain>("edit_terrain", request);
  ASSERT_TRUE(answer.success) << answer.message;
}

/// While the time stands still, the planner acts nevertheless, and the terrain comes to it.
class Planner : public testing::Test {
 protected:
  static void SetUpTestSuite() { watch_ = new Watch; }
  static void TearDownTestSuite() { delete watch_; }
  void SetUp() override {
    ASSERT_TRUE(call<std_srvs::Trigger>("reset").success);
    ask<std_srvs::Trigger>(planner + "/cancel");
    ASSERT_TRUE(wait_until([this] { return clock_->advance(0.02), truth_.last() != nullptr; }))
        << "it has no terrain: " << rover_.last().reason;
    const auto answer = node_test::set_pose(rover, 40, 0, 0);
    ASSERT_TRUE(answer.success) << answer.message;
    tick(0.1);
    ASSERT_NEAR(position().x, 40, 1e-3);
  }
  /// Lets the time go on, and the rover with it.
  void tick(double seconds) {
    clock_->advance(seconds);
    ASSERT_TRUE(truth_.wait_for(
        [this](const nav_msgs::Odometry& m) { return m.header.stamp == clock_->now(); }, patience_));
  }
  /// Likewise, until the planner has sent its command for where the rover is then: on a busy machine the
  /// rover would go on by old ones, and leave its path.
  void tick_and_lead(double seconds) {
    tick(seconds);
    EXPECT_TRUE(wait_until([&] { return status_.last().header.stamp >= clock_->now() || !leads(); }));
  }
  /// Whether it comes true within so many seconds of the rover's time.
  bool drives_until(const std::function<bool()>& condition, double seconds) {
    const ros::Time end = clock_->now() + ros::Duration(seconds);
    while (!condition()) {
      if (clock_->now() > end) return false;
      tick_and_lead(0.2);
    }
    return true;
  }
  /// Whether it comes true of the terrain at a time of its own, while the rover goes on slowly.
  bool creeps_until(const std::function<bool()>& condition) {
    return wait_until([&] { return tick_and_lead(0.01), condition(); });
  }
  bool leads() const {
    const std::string state = status_.last().state;
    return state == PlannerStatus::DRIVING || state == PlannerStatus::WAITING ||
           state == PlannerStatus::RECOVERING;
  }
  geometry_msgs::Point position() const { return truth_.last()->pose.pose.position; }

  void send(const std::string& topic, const geometry_msgs::PoseStamped& goal) {
    publisher_ = ros::NodeHandle().advertise<geometry_msgs::PoseStamped>(topic, 1);
    ASSERT_TRUE(wait_until([this] { return publisher_.getNumSubscribers() > 0; }));
    publisher_.publish(goal);
  }
  bool is(const std::string& state) {
    return wait_until([&] { return status_.last().state == state; });
  }
  std::string told() const { return status_.last().state + ": " + status_.last().reason; }

  /// What all tests use; made once, because the master takes its time for each.
  struct Watch {
    ros::NodeHandle node;
    node_test::TestClock clock;
    Listener<RoverStatus> rover{::rover + "/status"};
    Listener<PlannerStatus> planner{::planner + "/status"};
    Inbox<nav_msgs::Odometry> truth{node, "/ground_truth"};
    MoveBase action{"/move_base", false};
  };
  static inline Watch* watch_ = nullptr;

  const double patience_ = 60 * desert_sim::test::patience();
  node_test::TestClock* const clock_ = &watch_->clock;
  const Listener<RoverStatus>& rover_ = watch_->rover;
  const Listener<PlannerStatus>& status_ = watch_->planner;
  const Inbox<nav_msgs::Odometry>& truth_ = watch_->truth;
  MoveBase& action_ = watch_->action;
  ros::Publisher publisher_;
};

TEST_F(Planner, DrivesToAGoalOfTheTopicOnAPathThatLiesOnTheTerrain) {
  Listener<nav_msgs::Path> paths(planner + "/path");
  send("/move_base_simple/goal", pose_at(52, 8));
  ASSERT_TRUE(is(PlannerStatus::DRIVING)) << told();
  ASSERT_TRUE(wait_until([&] { return !paths.last().poses.empty(); }));
  const nav_msgs::Path path = paths.last();
  EXPECT_EQ(path.header.frame_id, "terrain");
  for (const geometry_msgs::PoseStamped& pose : path.poses) EXPECT_NEAR(pose.pose.position.z, 1.5, 0.01);
  EXPECT_NEAR(path.poses.back().pose.position.x, 52, 1e-6);
  EXPECT_NEAR(path.poses.front().pose.position.x, 40, 1);
  ASSERT_TRUE(drives_until([this] { return position().x > 46; }, 60)) << told();
  EXPECT_TRUE(wait_until([&] {
    const auto now = paths.last().poses;
    return !now.empty() && std::abs(now.front().pose.position.x - position().x) < 3;
  })) << "behind the rover no path is shown";
  EXPECT_NEAR(paths.last().poses.back().pose.position.x, 52, 1e-6);
  ASSERT_TRUE(drives_until([this] { return status_.last().state == PlannerStatus::ARRIVED; }, 60)) << told();
  EXPECT_NEAR(std::hypot(position().x - 52, position().y - 8), 0, 1.5);
  EXPECT_EQ(status_.last().replans, 0U) << status_.last().last_replan;
  EXPECT_TRUE(wait_until([&] { return paths.last().poses.empty(); })) << "no path is shown at the end";
}

TEST_F(Planner, ServesTheActionOfMoveBaseAndItsCancelling) {
  ASSERT_TRUE(wait_until([this] { return action_.isServerConnected(); }));
  action_.sendGoal(goal_at(48, 3));
  ASSERT_TRUE(drives_until([this] { return action_.getState().isDone(); }, 60)) << told();
  EXPECT_EQ(action_.getState(), actionlib::SimpleClientGoalState::SUCCEEDED) << told();
  action_.sendGoal(goal_at(80, 3));
  ASSERT_TRUE(drives_until([this] { return rover_.last().state == RoverStatus::DRIVING; }, 10)) << told();
  action_.cancelGoal();
  ASSERT_TRUE(wait_until([this] { return action_.getState().isDone(); }));
  EXPECT_EQ(action_.getState(), actionlib::SimpleClientGoalState::PREEMPTED);
  EXPECT_TRUE(is(PlannerStatus::CANCELLED)) << told();
  EXPECT_TRUE(drives_until([this] { return rover_.last().state == RoverStatus::IDLE; }, 5));
}

TEST_F(Planner, GoesRoundADuneThatComesIntoItsWay) {
  send("/move_base_simple/goal", pose_at(62, 0));
  ASSERT_TRUE(is(PlannerStatus::DRIVING)) << told();
  edit("sand", "add", 8, 52, 0, 3, 5);
  const auto blocked = [this] { return status_.last().last_replan.find("blocked") != std::string::npos; };
  ASSERT_TRUE(creeps_until(blocked)) << told() << "; " << status_.last().last_replan;
  double furthest = 0;
  ASSERT_TRUE(drives_until(
      [&] {
        furthest = std::max(furthest, std::abs(position().y));
        return status_.last().state == PlannerStatus::ARRIVED;
      },
      90))
      << told();
  EXPECT_GT(furthest, 5);
}

TEST_F(Planner, SaysWhyThereIsNoPath) {
  edit("obstacle", "replace", 1, 60, 10, 4, 4);
  ASSERT_TRUE(wait_until([this] { return action_.isServerConnected(); }));
  action_.sendGoal(goal_at(60, 10));
  const std::string reason = "the goal (60, 10) is not passable";
  EXPECT_TRUE(creeps_until([&] { return told().find(reason) != std::string::npos; })) << told();
  ASSERT_TRUE(drives_until([this] { return action_.getState().isDone(); }, 5)) << told();
  EXPECT_EQ(action_.getState(), actionlib::SimpleClientGoalState::ABORTED);
  EXPECT_NE(action_.getState().getText().find(reason), std::string::npos) << action_.getState().getText();
  // A wall all round the goal.
  edit("obstacle", "replace", 0, 60, 10, 2, 2);
  action_.sendGoal(goal_at(1000, 10));
  ASSERT_TRUE(wait_until([this] { return action_.getState().isDone(); }));
  EXPECT_NE(action_.getState().getText().find("refused: the goal (1000, 10) is off the terrain"),
            std::string::npos)
      << action_.getState().getText();
}

TEST_F(Planner, RefusesGoalsThatAreNone) {
  geometry_msgs::PoseStamped bad = pose_at(node_test::not_a_number, 0);
  send("/move_base_simple/goal", bad);
  EXPECT_TRUE(wait_until([this] { return status_.last().refusal.find("finite") != std::string::npos; }))
      << status_.last().refusal;
  bad = pose_at(50, 0);
  bad.pose.orientation.w = 0;
  send("/move_base_simple/goal", bad);
  EXPECT_TRUE(wait_until([this] { return status_.last().refusal.find("quaternion") != std::string::npos; }))
      << status_.last().refusal;
  bad = pose_at(50, 0);
  bad.header.frame_id = "nowhere";
  send("/move_base_simple/goal", bad);
  EXPECT_TRUE(wait_until([this] { return status_.last().refusal.find("'nowhere'") != std::string::npos; }))
      << status_.last().refusal;
  EXPECT_NE(status_.last().state, PlannerStatus::DRIVING);
}

TEST_F(Planner, WaitsWhileTheRoverIsBuried) {
  send("/move_base_simple/goal", pose_at(70, 0));
  ASSERT_TRUE(is(PlannerStatus::DRIVING)) << told();
  const double x = position().x;
  edit("sand", "add", 0.6, x, 0, 14, 10);
  ASSERT_TRUE(creeps_until([this] { return status_.last().reason.rfind("buried: ", 0) == 0; })) << told();
  edit("sand", "sub", 0.6, x, 0, 14, 10);
  EXPECT_TRUE(creeps_until([this] { return status_.last().state == PlannerStatus::DRIVING; })) << told();
}

TEST_F(Planner, PlansWithOmpl) {
  Listener<nav_msgs::Path> paths("/ompl_planner/path");
  send("/ompl_planner/goal", pose_at(70, 20));
  ASSERT_TRUE(wait_until([&] { return !paths.last().poses.empty(); }))
      << Listener<PlannerStatus>("/ompl_planner/status").last().reason;
  EXPECT_NEAR(paths.last().poses.back().pose.position.x, 70, 1e-6);
}

double longest_wait(const nav_msgs::Path& path) {
  double longest = 0;
  for (std::size_t n = 1; n < path.poses.size(); ++n)
    longest = std::max(longest, (path.poses[n].header.stamp - path.poses[n - 1].header.stamp).toSec());
  return longest;
}

/// A wall from one edge of the terrain to the other, which the forecast says will be gone.
TEST_F(Planner, PlansThroughAForecast) {
  Listener<nav_msgs::OccupancyGrid> costs("costmap");
  desert_sim::Forecast forecast;
  forecast.header.frame_id = "terrain";
  forecast.header.stamp = clock_->now();
  forecast.members = 1;
  forecast.times = {100, 200};
  forecast.costs.assign(2, costs.last());
  edit("obstacle", "replace", 1, 53, 28, 2.5, 60);
  ros::Publisher maps =
      ros::NodeHandle().advertise<desert_sim::Forecast>("/desert_sim/forecast/maps", 1, true);
  maps.publish(forecast);
  Listener<PlannerStatus> status("/forecast_planner/status");
  Listener<nav_msgs::Path> paths("/forecast_planner/path");
  send("/forecast_planner/goal", pose_at(62, 0));
  ASSERT_TRUE(creeps_until([&] {
    return status.last().forecast_age >= 0 && longest_wait(paths.last()) > 60;
  })) << "it waits before the wall: "
      << status.last().state << " " << status.last().reason << ", " << longest_wait(paths.last()) << " s";
  forecast.costs.pop_back();
  maps.publish(forecast);
  EXPECT_TRUE(wait_until([&] {
    return status.last().refusal.find("1 maps of costs for 2 moments") != std::string::npos;
  })) << status.last().refusal;
  ask<std_srvs::Trigger>("/forecast_planner/cancel");
}

/// Takes goals for forecasts, and leaves them to the test.
class LateForecasts {
 public:
  using Server = actionlib::ActionServer<desert_sim::ForecastTerrainAction>;

  LateForecasts() { server_.start(); }
  std::size_t goals() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return goals_.size();
  }
  int cancels() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return cancels_;
  }
  Server::GoalHandle last() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return goals_.back();
  }

 private:
  void take(Server::GoalHandle goal) {
    goal.setAccepted();
    const std::lock_guard<std::mutex> lock(mutex_);
    goals_.push_back(goal);
  }
  void cancel(Server::GoalHandle) {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++cancels_;
  }

  mutable std::mutex mutex_;
  std::vector<Server::GoalHandle> goals_;
  int cancels_ = 0;
  ros::NodeHandle node_;
  Server server_{node_, "/late_forecast", [this](Server::GoalHandle goal) { take(goal); },
                 [this](Server::GoalHandle goal) { cancel(goal); }, false};
};

std::set<std::string> subscribers(const std::string& topic) {
  XmlRpc::XmlRpcValue arguments, answer, state;
  arguments[0] = ros::this_node::getName();
  std::set<std::string> names;
  if (!ros::master::execute("getSystemState", arguments, answer, state, false)) return names;
  for (int n = 0; n < state[1].size(); ++n)
    if (std::string(state[1][n][0]) == topic)
      for (int k = 0; k < state[1][n][1].size(); ++k) names.insert(state[1][n][1][k]);
  return names;
}

/// Forecasts of two sources have two horizons, and tell of two futures.
TEST_F(Planner, AsksForForecastsOrTakesThoseOfTheTopic) {
  EXPECT_EQ(subscribers("/desert_sim/forecast/maps"), std::set<std::string>{"/forecast_planner"});
  EXPECT_EQ(subscribers("/desert_sim/forecast/result"), std::set<std::string>{});
  EXPECT_EQ(subscribers("/late_forecast/maps"), std::set<std::string>{});
  EXPECT_EQ(subscribers("/late_forecast/result"), std::set<std::string>{"/late_planner"});
}

TEST_F(Planner, WaitsForALateForecastAndAsksForACoarserOneThen) {
  Listener<nav_msgs::OccupancyGrid> costs("costmap");
  Listener<PlannerStatus> status("/late_planner/status");
  LateForecasts forecasts;
  send("/late_planner/goal", pose_at(62, 0));
  ASSERT_TRUE(creeps_until([&] { return forecasts.goals() == 1; }));
  LateForecasts::Server::GoalHandle goal = forecasts.last();
  EXPECT_EQ(goal.getGoal()->stride, 2u);
  desert_sim::ForecastTerrainFeedback feedback;
  feedback.progress = 0.25;
  EXPECT_TRUE(creeps_until([&] {
    goal.publishFeedback(feedback);
    return status.last().forecast_progress == 0.25;
  }));
  EXPECT_EQ(status.last().forecast_age, -1);
  const ros::Time late = clock_->now() + ros::Duration(7);  // three periods
  ASSERT_TRUE(creeps_until([&] { return tick(0.5), status.last().header.stamp >= late; }));
  EXPECT_EQ(forecasts.goals(), 1u) << "it asks for another one before the first is there";
  EXPECT_EQ(forecasts.cancels(), 0);
  EXPECT_EQ(status.last().forecast_progress, 0.25);

  desert_sim::ForecastTerrainResult result;
  result.success = true;
  result.forecast.header.frame_id = "terrain";
  result.forecast.header.stamp = clock_->now();
  result.forecast.members = 1;
  result.forecast.times = {100};
  result.forecast.costs = {costs.last()};
  goal.setSucceeded(result);
  ASSERT_TRUE(creeps_until([&] { return forecasts.goals() == 2; }));
  EXPECT_EQ(forecasts.last().getGoal()->stride, 4u);
  EXPECT_TRUE(creeps_until([&] {
    return status.last().forecast_stride == 4 && status.last().forecast_age >= 0;
  })) << status.last().refusal;
  EXPECT_EQ(status.last().refusal, "");
  ask<std_srvs::Trigger>("/late_planner/cancel");
  forecasts.last().setAborted({}, "the test ends");
}

TEST_F(Planner, BadParametersEndANodeWithTheirNames) {
  ros::param::set("/bad_planner/speed", -1.0);
  ros::param::set("/bad_planner/colour", "red");
  node_test::ChildProcess process({DESERT_PLANNER_BINARY, "__name:=bad_planner"});
  EXPECT_EQ(process.wait(), 2);
}

}  // namespace

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "planner_node_test"); }
