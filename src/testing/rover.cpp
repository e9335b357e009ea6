#include "include/desert_sim/testing/rover.hpp"

#include <cmath>

#include "include/desert_sim/testing/node_process.hpp"
#include "src/core/error.hpp"

namespace desert_sim::test {

namespace {

template <class Message>
boost::shared_ptr<const Message> newest(const Inbox<Message>& inbox, const std::string& topic) {
  if (!inbox.wait_for_more_than(0, 60 * patience()))
    throw Error("no message on " + topic + " within a minute: does the rover run, and has it a terrain?");
  return inbox.last();
}

}  // namespace

Rover::Rover(ros::NodeHandle& node, const std::string& name)
    : name_(name),
      node_(name + "/desert_rover"),
      publisher_(node.advertise<geometry_msgs::Twist>(name + "/cmd_vel", 1)),
      ground_truth_(node, name + "/ground_truth"),
      status_(node, node_ + "/status") {}

void Rover::drive(double forward, double yaw_rate) {
  if (!wait_until([this] { return publisher_.getNumSubscribers() > 0; }, 60))
    throw Error("nobody listens to " + name_ + "/cmd_vel: does the rover run?");
  const std::uint64_t before = status().commands;
  geometry_msgs::Twist command;
  command.linear.x = forward;
  command.angular.z = yaw_rate;
  publisher_.publish(command);
  if (!wait_for_status([before](const RoverStatus& s) { return s.commands > before; }, 60 * patience()))
    throw Error(node_ + " has not received the command within a minute");
}

Pose Rover::pose() const {
  const auto now = newest(ground_truth_, name_ + "/ground_truth");
  const geometry_msgs::Point& p = now->pose.pose.position;
  const geometry_msgs::Quaternion& q = now->pose.pose.orientation;
  return {p.x, p.y, p.z, std::atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))};
}

double Rover::distance_to(const Point& p) const {
  const Pose now = pose();
  return std::hypot(p.x - now.x, p.y - now.y);
}

RoverStatus Rover::status() const { return *newest(status_, node_ + "/status"); }

bool Rover::wait_for_stamp(const ros::Time& stamp, double seconds) const {
  return ground_truth_.wait_for([&](const nav_msgs::Odometry& o) { return o.header.stamp >= stamp; },
                                seconds);
}

bool Rover::wait_for_status(const std::function<bool(const RoverStatus&)>& fits, double seconds) const {
  return status_.wait_for(fits, seconds);
}

}  // namespace desert_sim::test
