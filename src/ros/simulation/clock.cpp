#include "src/ros/simulation/clock.hpp"

#include <ros/master.h>
#include <ros/this_node.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "src/core/error.hpp"

namespace desert_sim {

namespace {

constexpr const char* clock_topic = "/clock";

/// The name of another node that publishes /clock; empty if there is none.
std::string other_publisher() {
  std::vector<std::string> ours;
  ros::this_node::getAdvertisedTopics(ours);
  if (std::find(ours.begin(), ours.end(), clock_topic) != ours.end()) return "another part of this process";
  XmlRpc::XmlRpcValue request, response, state;
  request[0] = ros::this_node::getName();
  if (!ros::master::execute("getSystemState", request, response, state, false))
    throw Error("publish_clock: the ROS master does not answer the question which node publishes /clock");
  XmlRpc::XmlRpcValue& publishers = state[0];
  for (int n = 0; n < publishers.size(); ++n) {
    XmlRpc::XmlRpcValue &name = publishers[n][0], &nodes = publishers[n][1];
    if (static_cast<std::string>(name) != clock_topic) continue;
    for (int k = 0; k < nodes.size(); ++k)
      if (static_cast<std::string>(nodes[k]) != ros::this_node::getName()) return nodes[k];
  }
  return "";
}

}  // namespace

ros::Time clock_time(double seconds) {
  if (!(seconds >= 0 && seconds < std::numeric_limits<std::uint32_t>::max()))
    throw Error("publish_clock: " + std::to_string(seconds) +
                " s exceed the range of ROS time (allowed: [0, 4294967295) s)");
  return std::max(ros::Time(seconds), ros::Time(0, 1));
}

ClockPublisher::ClockPublisher() {
  const std::string other = other_publisher();
  if (!other.empty())
    throw ConfigError(
        "publish_clock: " + other +
        " already publishes /clock, and with two publishers the time would jump back and forth; stop "
        "that node, or set publish_clock to false and use_sim_time to true to follow its clock");
  publisher_ = {ros::NodeHandle(), clock_topic, 100};
}

void ClockPublisher::publish(double seconds) const {
  rosgraph_msgs::Clock message;
  message.clock = clock_time(seconds);
  publisher_.publish(message);
}

}  // namespace desert_sim
