#pragma once
/// Actions, whatever the stamps of their goals and cancels are.

#include <actionlib/server/action_server_base.h>
#include <ros/console.h>
#include <ros/node_handle.h>

#include <boost/make_shared.hpp>
#include <string>

#include "src/client/ros_time.hpp"

namespace desert_sim {

/// What actionlib::ActionServer does, on its base. That one adds durations to the stamps that goals and
/// cancels bring and to the time of /clock, which throws near 2^32 s and so ends the process; and a cancel
/// with a stamp of the future would cancel all later goals. Here a stamp later than now is taken as now, and
/// the status is told by wall time. Callbacks are those of the node handle's queue; after start().
template <class Spec>
class ActionServer final : public actionlib::ActionServerBase<Spec> {
 public:
  ACTION_DEFINITION(Spec)
  using Base = actionlib::ActionServerBase<Spec>;
  using GoalHandle = actionlib::ServerGoalHandle<Spec>;
  using Callback = boost::function<void(GoalHandle)>;

  ActionServer(const ros::NodeHandle& node, const std::string& name, const Callback& on_goal,
               const Callback& on_cancel)
      : Base(on_goal, on_cancel, false), node_(node, name) {}

 private:
  static constexpr double status_period = 0.2;  ///< [s]
  static constexpr double status_timeout = 5;   ///< [s] for which the end of a goal is told

  void initialize() override {
    constexpr std::uint32_t queue = 50;
    result_publisher_ = node_.advertise<ActionResult>("result", queue);
    feedback_publisher_ = node_.advertise<ActionFeedback>("feedback", queue);
    status_publisher_ = node_.advertise<actionlib_msgs::GoalStatusArray>("status", queue, true);
    timer_ = node_.createWallTimer(ros::WallDuration(status_period),
                                   [this](const ros::WallTimerEvent&) { publishStatus(); });
    const boost::function<void(const ActionGoalConstPtr&)> on_goal = [this](const ActionGoalConstPtr& goal) {
      Base::goalCallback(
          not_of_the_future(goal, [](ActionGoal& g) -> ros::Time& { return g.goal_id.stamp; }));
    };
    const boost::function<void(const actionlib_msgs::GoalIDConstPtr&)> on_cancel =
        [this](const actionlib_msgs::GoalIDConstPtr& id) {
          Base::cancelCallback(
              not_of_the_future(id, [](actionlib_msgs::GoalID& g) -> ros::Time& { return g.stamp; }));
          forget_unknown_goals();
        };
    goals_ = node_.subscribe<ActionGoal>("goal", queue, on_goal);
    cancels_ = node_.subscribe<actionlib_msgs::GoalID>("cancel", queue, on_cancel);
  }

  /// Cancels of goals that never come are kept for a while, also those without a stamp.
  void forget_unknown_goals() {
    const boost::recursive_mutex::scoped_lock lock(this->lock_);
    for (auto& goal : this->status_list_)
      if (goal.handle_tracker_.expired() && goal.handle_destruction_time_.isZero())
        goal.handle_destruction_time_ = ros::Time::now();
  }

  template <class Message, class Stamp>
  boost::shared_ptr<const Message> not_of_the_future(const boost::shared_ptr<const Message>& message,
                                                     const Stamp& stamp) const {
    auto copy = boost::make_shared<Message>(*message);
    const ros::Time now = ros::Time::now();
    if (stamp(*copy) <= now) return message;
    ROS_WARN_THROTTLE(
        10, "%s: a goal or cancel has a stamp of the future, %.3f s, which is taken as now, %.3f s.",
        node_.getNamespace().c_str(), stamp(*copy).toSec(), now.toSec());
    stamp(*copy) = now;
    return copy;
  }

  void publishResult(const actionlib_msgs::GoalStatus& status, const Result& result) override {
    const boost::recursive_mutex::scoped_lock lock(this->lock_);
    const auto message = boost::make_shared<ActionResult>();
    message->header.stamp = ros::Time::now();
    message->status = status;
    message->result = result;
    if (result_publisher_) result_publisher_.publish(message);
    publishStatus();
  }

  void publishFeedback(const actionlib_msgs::GoalStatus& status, const Feedback& feedback) override {
    const boost::recursive_mutex::scoped_lock lock(this->lock_);
    const auto message = boost::make_shared<ActionFeedback>();
    message->header.stamp = ros::Time::now();
    message->status = status;
    message->feedback = feedback;
    if (feedback_publisher_) feedback_publisher_.publish(message);
  }

  /// All goals that somebody still handles, or that ended a moment ago.
  void publishStatus() override {
    const boost::recursive_mutex::scoped_lock lock(this->lock_);
    if (!this->started_ || !status_publisher_) return;  // no publisher: ROS was shutting down
    const ros::Time now = ros::Time::now();
    actionlib_msgs::GoalStatusArray message;
    message.header.stamp = now;
    for (const auto& goal : this->status_list_) message.status_list.push_back(goal.status_);
    this->status_list_.remove_if([&](const auto& goal) {
      return !goal.handle_destruction_time_.isZero() &&
             seconds_between(goal.handle_destruction_time_, now) > status_timeout;
    });
    status_publisher_.publish(message);
  }

  ros::NodeHandle node_;
  ros::Publisher result_publisher_, feedback_publisher_, status_publisher_;
  ros::WallTimer timer_;
  ros::Subscriber goals_, cancels_;
};

}  // namespace desert_sim
