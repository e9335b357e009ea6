/// What a PlannerServer is told: goals, the rover's state, forecasts.
#include <ros/console.h>

#include <cmath>

#include "src/core/error.hpp"
#include "src/ros/planner/planner_server.hpp"

namespace desert_sim {

namespace {

constexpr std::size_t most_waiting = 1000;

}  // namespace

void PlannerServer::receive_rover_status(const RoverStatusConstPtr& status) {
  if (!lockstep_) {
    rover_ = status;
    return;
  }
  if (!std::isfinite(status->terrain_time)) {
    ROS_WARN_THROTTLE(5, "A status of the rover is ignored: its terrain_time is %g", status->terrain_time);
    return;
  }
  // Of the states of one step the last one counts. After a reset the steps begin again.
  if (status->header.frame_id.empty()) return;
  statuses_.erase(statuses_.upper_bound(status->terrain_step), statuses_.end());
  if (rover_ && rover_->terrain_step == status->terrain_step &&
      rover_->terrain_stamp == status->terrain_stamp)
    return;
  statuses_[status->terrain_step] = status;
  if (statuses_.size() > most_waiting) statuses_.erase(statuses_.begin());
}

void PlannerServer::receive_truth(const nav_msgs::OdometryConstPtr& truth) {
  truths_[truth->header.stamp] = truth;
  if (truths_.size() > most_waiting) truths_.erase(truths_.begin());
}

void PlannerServer::set_goal(const geometry_msgs::PoseStamped& goal) {
  const geometry_msgs::PoseStamped in_terrain = goal_in_terrain(goal, terrain_.frame(), transforms_);
  take_terrain({});
  navigator_.set_goal(planar_pose(in_terrain.pose, "the goal"), time_now());
  goal_ = in_terrain;
  refusal_.clear();
  forecasts_.hurry();
}

void PlannerServer::receive_goal(const geometry_msgs::PoseStampedConstPtr& goal) {
  try {
    set_goal(*goal);
    if (action_is_active()) action_goal_.setCanceled({}, "another goal came by topic");
  } catch (const ConfigError& e) {
    ROS_WARN("move_base_simple/goal: a goal was refused: %s", e.what());
    refusal_ = "move_base_simple/goal: " + std::string(e.what());
  }
  publish_status(false);
}

void PlannerServer::receive_action_goal(MoveBaseGoal goal) {
  if (action_is_active()) action_goal_.setCanceled({}, "another goal was received");
  action_goal_ = goal;
  action_goal_.setAccepted();
  try {
    set_goal(goal.getGoal()->target_pose);
  } catch (const ConfigError& e) {
    ROS_WARN("move_base: a goal was refused: %s", e.what());
    refusal_ = "move_base: " + std::string(e.what());
    navigator_.cancel("another goal came, and was refused");
    action_goal_.setAborted({}, std::string("refused: ") + e.what());
  }
  publish_status(false);
}

void PlannerServer::receive_action_cancel(const MoveBaseGoal& goal) {
  if (!action_is_active() || action_goal_ != goal) return;
  navigator_.cancel("the client of move_base has cancelled the goal");
  send({});
  end_action();
  publish_path();
  publish_status(false);
}

bool PlannerServer::cancel(std_srvs::TriggerRequest&, std_srvs::TriggerResponse& response) {
  response.success = navigator_.active();
  response.message = response.success ? "cancelled" : "there is no goal to cancel";
  navigator_.cancel("~cancel was called");
  send({});
  end_action();
  publish_path();
  publish_status(false);
  return true;
}

// ---- forecasts

void PlannerServer::take_forecast(const Forecast& forecast) {
  try {
    const double begin =
        lockstep_ ? forecast.sim_time * setup_.node.seconds_per_sim_second : forecast.header.stamp.toSec();
    const double pace = lockstep_ && forecast.seconds_per_sim_second > 0
                            ? setup_.node.seconds_per_sim_second / forecast.seconds_per_sim_second
                            : 1;
    const ForecastCosts costs = forecast_costs(forecast, begin, pace, setup_.node.forecast_probability);
    take_terrain({});
    navigator_.set_forecast(costs);
  } catch (const ConfigError& e) {
    ROS_WARN("a forecast was refused: %s", e.what());
    refusal_ = "forecast: " + std::string(e.what());
  }
}

void PlannerServer::ask_for_forecast(double time) {
  if (!forecast_client_ || !forecast_client_->isServerConnected() || !forecasts_.due(time)) return;
  forecasts_.ask(time);
  forecast_progress_ = 0;
  ForecastTerrainGoal goal;
  goal.horizon = setup_.node.forecast_horizon;
  goal.moments = static_cast<std::uint32_t>(setup_.node.forecast_moments);
  goal.stride = static_cast<std::uint32_t>(forecasts_.stride());
  forecast_client_->sendGoal(
      goal,
      [this](const actionlib::SimpleClientGoalState& state, const ForecastTerrainResultConstPtr& result) {
        end_forecast(state, result.get());
      },
      [] {},
      [this](const ForecastTerrainFeedbackConstPtr& feedback) {
        forecast_progress_ = static_cast<double>(feedback->progress);
      });
  // In lockstep the same calls give the same path, however long a forecast takes.
  while (lockstep_ && forecasts_.under_way() && !stopping_ && ros::ok() &&
         forecast_client_->isServerConnected())
    queue_.callAvailable(ros::WallDuration(patience));
}

void PlannerServer::end_forecast(const actionlib::SimpleClientGoalState& state,
                                 const ForecastTerrainResult* result) {
  const bool arrived = state == actionlib::SimpleClientGoalState::SUCCEEDED && result;
  const int stride = forecasts_.stride();
  forecasts_.end(time_now(), arrived);
  if (forecasts_.stride() > stride)
    ROS_INFO(
        "A forecast took longer than forecast_period (%g s): the next one has a stride of %d, not of %d.",
        setup_.node.forecast_period, forecasts_.stride(), stride);
  if (arrived) return take_forecast(result->forecast);
  if (state == actionlib::SimpleClientGoalState::PREEMPTED) return;
  refusal_ = "forecast: " + state.toString() + ": " +
             (result && !result->message.empty() ? result->message : state.getText());
  ROS_WARN("%s", refusal_.c_str());
}

}  // namespace desert_sim
