#include "src/rviz/fleet.hpp"

#include <desert_sim/RoverStatus.h>
#include <ros/master.h>
#include <ros/message_traits.h>
#include <ros/names.h>
#include <ros/this_node.h>

#include <optional>
#include <utility>

namespace desert_sim {

namespace {

using Topics = std::map<std::string, std::string>;  // types by name

/// The topics that somebody publishes below a namespace; none if the master does not answer.
std::optional<Topics> published_topics(const std::string& space) {
  XmlRpc::XmlRpcValue request, response, list;
  request[0] = ros::this_node::getName();
  request[1] = space;
  if (!ros::master::execute("getPublishedTopics", request, response, list, false)) return std::nullopt;
  Topics topics;
  for (int n = 0; n < list.size(); ++n) topics[list[n][0]] = static_cast<std::string&>(list[n][1]);
  return topics;
}

/// The names of the nodes whose topic status has this type.
template <class Status>
std::set<std::string> nodes_with(const Topics& topics) {
  const std::string end = "/status";
  std::set<std::string> names;
  for (const auto& [topic, type] : topics) {
    const std::size_t size = topic.size() < end.size() ? 0 : topic.size() - end.size();
    if (type == ros::message_traits::datatype<Status>() && topic.substr(size) == end)
      names.insert(topic.substr(0, size));
  }
  return names;
}

}  // namespace

Fleet::Fleet(const ros::NodeHandle& node, std::function<void(const RoverNames&)> found,
             std::function<void(const PlannerStatuses&)> heard)
    : node_(node), found_(std::move(found)), heard_(std::move(heard)) {}

void Fleet::look(const std::string& node) {
  const std::optional<Topics> topics = published_topics(ros::names::parentNamespace(node));
  if (!topics) return;
  RoverNames rovers;
  for (const std::string& name : nodes_with<RoverStatus>(*topics))
    rovers.insert(ros::names::parentNamespace(name));
  if (rovers != rovers_) found_(rovers_ = rovers);
  listen_to(nodes_with<PlannerStatus>(*topics));
  // A new master knows nothing of a publisher of the old one.
  if (rovers_.count(chosen_) > 0 && topics->count(chosen_ + "/cmd_vel") == 0) connect();
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
