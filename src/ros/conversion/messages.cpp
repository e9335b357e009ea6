#include "src/ros/conversion/messages.hpp"

namespace desert_sim {

std_msgs::Header header_of(const Moment& moment, const std::string& frame) {
  std_msgs::Header header;
  header.stamp = moment.stamp;
  header.frame_id = frame;
  return header;
}

geometry_msgs::Pose origin_of(const Snapshot& snapshot) {
  geometry_msgs::Pose pose;
  pose.position.x = snapshot.origin_x;
  pose.position.y = snapshot.origin_y;
  pose.orientation.w = 1;
  return pose;
}

geometry_msgs::Vector3 vector_of(wind::Vector v) {
  geometry_msgs::Vector3 vector;
  vector.x = v.x;
  vector.y = v.y;
  return vector;
}

}  // namespace desert_sim
