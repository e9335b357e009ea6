#pragma once
/// The rovers and planners beside a node of the simulation, found by the types of their topics.

#include <desert_sim/PlannerStatus.h>
#include <geometry_msgs/Twist.h>
#include <ros/node_handle.h>

#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string>

namespace desert_sim {

/// By the planner's name, such as /rover/desert_planner.
using PlannerStatuses = std::map<std::string, PlannerStatusConstPtr>;
/// The namespaces of rovers, such as /rover.
using RoverNames = std::set<std::string>;

/// For one thread, which may wait for the master; drive() for any.
class Fleet {
 public:
  /// `found` and `heard` are called by look() and by the queue of `node`.
  Fleet(const ros::NodeHandle& node, std::function<void(const RoverNames&)> found,
        std::function<void(const PlannerStatuses&)> heard);

  /// Looks for rovers and planners in the namespace of a node such as /mars/desert_sim, and connects to them.
  /// Finds what it found before while the master does not answer.
  void look(const std::string& node);
  /// Begins anew, with nothing found.
  void forget();
  /// Connects to `cmd_vel` of this rover in the place of another one; empty: of none.
  void choose(const std::string& rover);
  /// Sends a command to the chosen rover; without one, does nothing. It never waits.
  void drive(const geometry_msgs::Twist& command);

 private:
  void listen_to(const std::set<std::string>& planners);
  void connect();

  ros::NodeHandle node_;
  const std::function<void(const RoverNames&)> found_;
  const std::function<void(const PlannerStatuses&)> heard_;
  RoverNames rovers_;
  std::string chosen_;
  std::map<std::string, ros::Subscriber> subscribers_;
  PlannerStatuses planners_;
  std::mutex mutex_;  ///< guards the next
  ros::Publisher commands_;
};

}  // namespace desert_sim
