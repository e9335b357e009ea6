#include "src/rviz/fleet.hpp"

#include <desert_sim/RoverStatus.h>
#include <ros/master.h>
#include <ros/message_traits.h>
#include <ros/names.h>

#include <utility>

namespace desert_sim {

namespace {

/// The topics NAME/status of a type below a namespace, as the names; false if the master does not answer.
template <class Status>
bool find_names(const std::string& space, std::set<std::string>& names) {
  XmlRpc::XmlRpcValue request, response, topics;
  request[0] = "/desert_sim";
  request[1] = space;
  if (!ros::master::execute("getPublishedTopics", request, response, topics, false)) return false;
  const std::string end = "/status";
  for (int n = 0; n < topics.size(); ++n) {
    const std::string topic = topics[n][0], type = topics[n][1];
    const bool fits =
        topic.size() > end.size() && topic.compare(topic.size() - end.size(), end.size(), end) == 0;
    if (fits && type == ros::message_traits::datatype<Status>())
      names.insert(topic.substr(0, topic.size() - end.size()));
  }
  return true;
}

}  // namespace

Fleet::Fleet(const ros::NodeHandle& node, std::function<void(const RoverNames&)> found,
             std::function<void(const PlannerStatuses&)> heard)
    : node_(node), found_(std::move(found)), heard_(std::move(heard)) {}

void Fleet::look(const std::string& node) {
  const std::string space = ros::names::parentNamespace(node);
  std::set<std::string> rover_nodes, planners;
  if (!find_names<RoverStatus>(space, rover_nodes) || !find_names<PlannerStatus>(space, planners)) return;
  RoverNames rovers;
  for (const std::string& rover_node : rover_nodes) rovers.insert(ros::names::parentNamespace(rover_node));
  if (rovers != rovers_) found_(rovers_ = rovers);
  listen_to(planners);
  bool heard = true;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    heard = commands_ && commands_.getNumSubscribers() > 0;
  }
  // A new master knows nothing of a publisher of the old one.
  if (!heard && rovers_.count(chosen_) > 0) connect();
}

void Fleet::forget() {
  if (!rovers_.empty()) found_(rovers_ = {});
  listen_to({});
}

void Fleet::listen_to(const std::set<std::string>& planners) {
  bool lost = false;
  for (auto s = subscribers_.begin(); s != subscribers_.end();) {
    if (planners.count(s->first) > 0) {
      ++s;
      continue;
    }
    lost = planners_.erase(s->first) > 0 || lost;
    s = subscribers_.erase(s);
  }
  if (lost) heard_(planners_);
  for (const std::string& planner : planners) {
    ros::Subscriber& subscriber = subscribers_[planner];
    if (subscriber && subscriber.getNumPublishers() > 0) continue;
    subscriber = ros::Subscriber();
    const boost::function<void(const PlannerStatusConstPtr&)> receive =
        [this, planner](const PlannerStatusConstPtr& status) {
          planners_[planner] = status;
          heard_(planners_);
        };
    subscriber = node_.subscribe<PlannerStatus>(planner + "/status", 1, receive);
  }
}

void Fleet::choose(const std::string& rover) {
  if (rover == chosen_) return;
  chosen_ = rover;
  connect();
}

void Fleet::connect() {
  ros::Publisher old;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::swap(old, commands_);
  }
  old.shutdown();
  if (chosen_.empty()) return;
  ros::Publisher made = node_.advertise<geometry_msgs::Twist>(chosen_ + "/cmd_vel", 1);
  const std::lock_guard<std::mutex> lock(mutex_);
  commands_ = made;
}

void Fleet::drive(const geometry_msgs::Twist& command) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (commands_) commands_.publish(command);
}

}  // namespace desert_sim
