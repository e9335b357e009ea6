#pragma once
/// A planner as a node: goals by topic and action, path, status and commands. Everything but the reception of
/// terrain and transforms happens on one thread.

#include <actionlib/client/simple_action_client.h>
#include <desert_sim/ForecastTerrainAction.h>
#include <desert_sim/RoverStatus.h>
#include <geometry_msgs/PoseStamped.h>
#include <move_base_msgs/MoveBaseAction.h>
#include <nav_msgs/Odometry.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <std_srvs/Trigger.h>
#include <tf2/buffer_core.h>

#include <atomic>
#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "src/planner/forecast_schedule.hpp"
#include "src/ros/conversion/transform_listener.hpp"
#include "src/ros/planner/planner_messages.hpp"
#include "src/ros/planner/planner_terrain.hpp"
#include "src/ros/support/action_server.hpp"
#include "src/ros/support/latched_publisher.hpp"

namespace desert_sim {

class PlannerServer {
 public:
  /// Topics are below `node`, parameters, path and status below `private_node`. Throws ConfigError for input
  /// that is refused.
  PlannerServer(const ros::NodeHandle& node, const ros::NodeHandle& private_node);
  ~PlannerServer();

  /// What failed at run time; empty while all is well.
  std::string failure() const;

 private:
  using MoveBaseServer = ActionServer<move_base_msgs::MoveBaseAction>;
  using MoveBaseGoal = MoveBaseServer::GoalHandle;
  using ForecastClient = actionlib::SimpleActionClient<ForecastTerrainAction>;
  static constexpr double patience = 0.05;  ///< [s] of wall time until it looks whether it has to end

  // ---- when it acts
  void run();
  void act_as_time_passes();
  void act_in_lockstep();
  void act(double time, const PlanarPose& pose, std::optional<std::uint64_t> step);
  bool pose_by_tf(PlanarPose& pose, std::string& problem);
  void take_terrain(std::optional<std::uint64_t> step);
  double time_now() const;

  // ---- what it is told
  void receive_rover_status(const RoverStatusConstPtr& status);
  void receive_truth(const nav_msgs::OdometryConstPtr& truth);
  void receive_goal(const geometry_msgs::PoseStampedConstPtr& goal);
  void receive_action_goal(MoveBaseGoal goal);
  void receive_action_cancel(const MoveBaseGoal& goal);
  void take_forecast(const Forecast& forecast);
  bool cancel(std_srvs::TriggerRequest& request, std_srvs::TriggerResponse& response);
  /// Throws ConfigError for a goal that is refused.
  void set_goal(const geometry_msgs::PoseStamped& goal);
  void ask_for_forecast(double time);
  void end_forecast(const actionlib::SimpleClientGoalState& state, const ForecastTerrainResult* result);

  // ---- what it tells
  void send(const DriveCommand& command);
  void publish_path();
  void publish_status(bool always);
  bool action_is_active();
  void end_action();

  ros::CallbackQueue queue_;
  ros::NodeHandle node_, private_node_;
  const PlannerSetup setup_;
  const bool lockstep_;
  Navigator navigator_;
  tf2::BufferCore transforms_;
  TransformListener transform_listener_{transforms_};

  std::map<std::uint64_t, RoverStatusConstPtr> statuses_;  ///< in lockstep, by step of the terrain
  std::map<ros::Time, nav_msgs::OdometryConstPtr> truths_;
  RoverStatusConstPtr rover_;
  geometry_msgs::PoseStamped goal_;  ///< the last one, in the terrain's frame
  std::string refusal_, ground_refusal_, last_told_;
  DriveCommand command_;
  bool driving_ = false;  ///< the last command was not that of standing still
  double plan_time_ = 0;
  double lockstep_time_ = 0;
  ros::Time pose_stamp_;  ///< of the rover's pose that it knows; 0 before there is one
  std::uint64_t terrain_step_ = 0, published_path_ = 0;
  double published_done_ = 0;  ///< of that path [m]
  ForecastSchedule forecasts_;
  double forecast_progress_ = 0;  ///< of the one that is under way
  std::chrono::steady_clock::time_point last_status_;

  LatchedPublisher<nav_msgs::Path> path_publisher_;
  LatchedPublisher<PlannerStatus> status_publisher_;
  ros::Publisher command_publisher_;
  ros::Subscriber goal_subscriber_, status_subscriber_, truth_subscriber_, forecast_subscriber_;
  ros::ServiceServer cancel_server_;
  std::string drive_service_;  ///< in lockstep
  std::unique_ptr<MoveBaseServer> action_;
  MoveBaseGoal action_goal_;  ///< the last one that was accepted
  std::unique_ptr<ForecastClient> forecast_client_;
  PlannerTerrain terrain_;
  mutable std::mutex failure_mutex_;
  std::string failure_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace desert_sim
