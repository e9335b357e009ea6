#include "src/ros/planner/planner_server.hpp"

#include <desert_sim/DriveRover.h>
#include <geometry_msgs/Twist.h>
#include <ros/console.h>
#include <ros/init.h>
#include <ros/service.h>
#include <tf2_geometry_msgs/tf2_geometry_msgs.h>

#include <algorithm>
#include <cmath>

#include "include/desert_sim/client/service_call.hpp"
#include "src/client/ros_time.hpp"
#include "src/core/error.hpp"

namespace desert_sim {

namespace {

constexpr std::size_t lockstep_queue = 1000;  // [messages]

geometry_msgs::Twist twist_of(const DriveCommand& command) {
  geometry_msgs::Twist twist;
  twist.linear.x = command.forward;
  twist.linear.y = command.sideways;
  twist.angular.z = command.yaw_rate;
  return twist;
}

}  // namespace

PlannerServer::PlannerServer(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : node_(node),
      private_node_(private_node),
      setup_(read_planner_setup(private_node)),
      lockstep_(setup_.node.clock == RoverClock::lockstep),
      navigator_(setup_.planner),
      forecasts_(setup_.node.forecast_period, setup_.node.forecast_stride),
      terrain_(setup_) {
  node_.setCallbackQueue(&queue_);
  private_node_.setCallbackQueue(&queue_);
  if (setup_.planner.planner == PlannerKind::ompl)
    navigator_.set_layer_source([this](const GridFrame& frame) { return terrain_.layers(frame); });
  path_publisher_ = {private_node_, "path", 1};
  status_publisher_ = {private_node_, "status", 100};
  command_publisher_ = node_.advertise<geometry_msgs::Twist>("cmd_vel", 1);
  const std::string goals = setup_.node.goal_topic.empty() ? "move_base_simple/goal" : setup_.node.goal_topic;
  goal_subscriber_ = node_.subscribe(goals, 1, &PlannerServer::receive_goal, this);
  const std::uint32_t queue = lockstep_ ? lockstep_queue : 10;
  status_subscriber_ =
      node_.subscribe(setup_.node.rover_node + "/status", queue, &PlannerServer::receive_rover_status, this);
  if (lockstep_) {
    truth_subscriber_ = node_.subscribe("ground_truth", queue, &PlannerServer::receive_truth, this);
    drive_service_ = node_.resolveName(setup_.node.rover_node + "/drive");
  }
  if (setup_.planner.planner == PlannerKind::forecast) {
    // One source alone: ~forecast/maps has a horizon of its own, and makes the desert run ahead once more.
    const std::string name = setup_.node.terrain_node + "/forecast";
    if (setup_.node.forecast_period > 0)
      forecast_client_ = std::make_unique<ForecastClient>(node_, name, false);
    else
      forecast_subscriber_ = node_.subscribe<Forecast>(
          name + "/maps", 2, [this](const ForecastConstPtr& forecast) { take_forecast(*forecast); });
  }
  cancel_server_ = private_node_.advertiseService("cancel", &PlannerServer::cancel, this);
  action_ = std::make_unique<MoveBaseServer>(
      node_, "move_base", [this](const MoveBaseGoal& goal) { receive_action_goal(goal); },
      [this](const MoveBaseGoal& goal) { receive_action_cancel(goal); });
  if (ros::isShuttingDown())
    throw Error("ROS is shutting down");  // what was advertised after that is no publisher
  action_->start();
  publish_status(true);
  thread_ = std::thread([this] { run(); });
}

PlannerServer::~PlannerServer() {
  stopping_ = true;
  thread_.join();
}

std::string PlannerServer::failure() const {
  const std::lock_guard<std::mutex> lock(failure_mutex_);
  return failure_;
}

// ---- when it acts

void PlannerServer::run() {
  try {
    lockstep_ ? act_in_lockstep() : act_as_time_passes();
  } catch (const std::exception& e) {
    const std::lock_guard<std::mutex> lock(failure_mutex_);
    failure_ = limited_message(e.what());
  }
}

double PlannerServer::time_now() const { return lockstep_ ? lockstep_time_ : ros::Time::now().toSec(); }

void PlannerServer::act_as_time_passes() {
  using Clock = std::chrono::steady_clock;
  const auto period =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / setup_.node.rate));
  auto due = Clock::now() + period;
  while (!stopping_ && ros::ok()) {
    const std::chrono::duration<double> left = due - Clock::now();
    if (left.count() > 0) {
      queue_.callAvailable(ros::WallDuration(std::min(left.count(), patience)));
      continue;
    }
    due = std::max(due + period, Clock::now());
    queue_.callAvailable();
    if (ros::Time::now().isZero()) continue;  // nobody has told the time yet
    PlanarPose pose;
    std::string problem;
    if (pose_by_tf(pose, problem)) {
      act(time_now(), pose, {});
      continue;
    }
    take_terrain({});
    if (navigator_.active()) ROS_WARN_THROTTLE(5, "%s", problem.c_str());
    send({});
    publish_status(false);
  }
}

void PlannerServer::act_in_lockstep() {
  while (!stopping_ && ros::ok()) {
    queue_.callAvailable(ros::WallDuration(patience));
    while (!statuses_.empty()) {
      const auto [step, status] = *statuses_.begin();
      const auto truth = truths_.find(status->terrain_stamp);
      if (truth == truths_.end() || !terrain_.has(step, status->terrain_stamp)) break;
      rover_ = status;
      const nav_msgs::OdometryConstPtr odometry = truth->second;
      lockstep_time_ = status->terrain_time * setup_.node.seconds_per_sim_second;
      truths_.erase(truths_.begin(), std::next(truth));
      statuses_.erase(statuses_.begin());
      PlanarPose pose;
      try {
        pose = planar_pose(odometry->pose.pose, "ground_truth");
        pose_stamp_ = odometry->header.stamp;
      } catch (const ConfigError& e) {
        ROS_WARN_THROTTLE(5, "A pose of the rover is ignored: %s", e.what());
        continue;
      }
      act(lockstep_time_, pose, step);
    }
    if (statuses_.empty()) publish_status(false);
  }
}

void PlannerServer::take_terrain(std::optional<std::uint64_t> step) {
  for (const MapChange& change : terrain_.take(step)) {
    const MapInfo& info = change.map->info();
    terrain_step_ = info.step;
    if (change.cells.empty()) continue;
    const LayerMap::Rectangle& c = change.cells;
    const CostGrid::Box box{static_cast<int>(c.x), static_cast<int>(c.y), static_cast<int>(c.width),
                            static_cast<int>(c.height)};
    navigator_.update(grid_frame_of(info), box, change.map->values(c).data());
  }
  const std::string& refusal = navigator_.ground_refusal();
  if (refusal == ground_refusal_) return;
  ground_refusal_ = refusal;
  refusal_ = refusal.empty() ? "" : "terrain: " + refusal;
  if (!refusal.empty()) ROS_WARN("This terrain cannot be planned on: %s", refusal.c_str());
}

bool PlannerServer::pose_by_tf(PlanarPose& pose, std::string& problem) {
  const std::string terrain = terrain_.frame();
  if (terrain.empty()) {
    problem = "the terrain of " + setup_.node.terrain_node + " has not arrived yet";
    return false;
  }
  try {
    const auto t = transforms_.lookupTransform(terrain, setup_.base_frame(), ros::Time(0));
    pose = {t.transform.translation.x, t.transform.translation.y, yaw_of(t.transform.rotation)};
    const double age = seconds_between(t.header.stamp, ros::Time::now());
    if (!std::isfinite(pose.x) || !std::isfinite(pose.y) || !std::isfinite(pose.yaw)) {
      problem = "the rover's pose is not of finite numbers";
      return false;
    }
    if (age <= setup_.node.pose_age) {
      pose_stamp_ = t.header.stamp;
      return true;
    }
    problem = "the rover's pose is " + std::to_string(age) +
              " s old (pose_age: " + std::to_string(setup_.node.pose_age) + ")";
  } catch (const tf2::TransformException& e) {
    problem = std::string("the rover's pose is not known: ") + e.what();
  }
  return false;
}

void PlannerServer::act(double time, const PlanarPose& pose, std::optional<std::uint64_t> step) {
  take_terrain(step);
  if (navigator_.active()) ask_for_forecast(time);
  const int plans = navigator_.status().plans;
  const auto begin = std::chrono::steady_clock::now();
  const RoverCondition condition = rover_ ? condition_named(rover_->state) : RoverCondition::driving;
  const DriveCommand command = navigator_.act(time, pose, condition, rover_ ? rover_->reason : "");
  if (navigator_.status().plans != plans)
    plan_time_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  send(command);
  publish_path();
  if (action_is_active()) {
    move_base_msgs::MoveBaseFeedback feedback;
    feedback.base_position.header.frame_id = terrain_.frame();
    feedback.base_position.header.stamp = ros::Time::now();
    feedback.base_position.pose.position.x = pose.x;
    feedback.base_position.pose.position.y = pose.y;
    feedback.base_position.pose.orientation = yaw_quaternion(pose.yaw);
    action_goal_.publishFeedback(feedback);
  }
  end_action();
  publish_status(step.has_value());
}

void PlannerServer::send(const DriveCommand& command) {
  command_ = command;
  const bool moves = command.forward != 0 || command.sideways != 0 || command.yaw_rate != 0;
  const bool wanted = setup_.node.drive && (navigator_.active() || moves || driving_);
  driving_ = moves;
  if (!wanted) return;
  if (!lockstep_) {
    command_publisher_.publish(twist_of(command));
    return;
  }
  DriveRover drive;
  drive.request.twist = twist_of(command);
  if (!call_service(drive_service_, drive))
    ROS_WARN_THROTTLE(5, "%s does not answer: the rover does not get its command", drive_service_.c_str());
  else if (!drive.response.success)
    ROS_WARN_THROTTLE(5, "the rover refuses its command: %s", drive.response.message.c_str());
}

// ---- what it tells

/// Another path at once, and what lies ahead of the same one when the rover has come a cell further.
void PlannerServer::publish_path() {
  const auto elevation = terrain_.elevation();
  const double step = elevation ? elevation->info().cell_size : 0, done = navigator_.path_done();
  if (navigator_.path_number() == published_path_ && done <= published_done_ + step) return;
  published_path_ = navigator_.path_number();
  published_done_ = done;
  path_publisher_.publish(path_message(navigator_.path(), navigator_.schedule(), elevation.get(),
                                       terrain_.frame(), ros::Time::now()));
}

void PlannerServer::publish_status(bool always) {
  PlannerStatus m = planner_status_message(navigator_.status());
  const std::string told = m.state + "\n" + (m.state == PlannerStatus::WAITING ? "" : m.reason) + "\n" +
                           refusal_ + "\n" + m.last_replan;
  const auto now = std::chrono::steady_clock::now();
  const std::chrono::duration<double> age = now - last_status_;
  if (!always && told == last_told_ && age.count() < 1 / setup_.node.status_rate) return;
  last_told_ = told;
  last_status_ = now;
  m.header.stamp = pose_stamp_;
  m.header.frame_id = terrain_.frame();
  m.refusal = refusal_;
  m.planner = planner_kinds[static_cast<int>(setup_.planner.planner)];
  m.goal = goal_;
  m.forecast_progress = forecasts_.under_way() ? forecast_progress_ : -1;
  m.forecast_stride = static_cast<std::uint32_t>(forecasts_.stride());
  m.plan_time = plan_time_;
  m.command = twist_of(command_);
  m.terrain_step = terrain_step_;
  status_publisher_.publish(m);
}

bool PlannerServer::action_is_active() {
  if (!action_goal_.getGoal()) return false;
  const auto status = action_goal_.getGoalStatus().status;
  return status == actionlib_msgs::GoalStatus::ACTIVE || status == actionlib_msgs::GoalStatus::PREEMPTING;
}

void PlannerServer::end_action() {
  if (!action_is_active() || navigator_.active()) return;
  const NavigatorStatus& s = navigator_.status();
  if (s.state == NavigatorState::arrived)
    action_goal_.setSucceeded({}, "arrived");
  else if (s.state == NavigatorState::cancelled)
    action_goal_.setCanceled({}, s.reason);
  else
    action_goal_.setAborted({}, std::string(navigator_states[static_cast<int>(s.state)]) + ": " + s.reason);
}

}  // namespace desert_sim
