#include "src/rviz/draped_path_display.hpp"

#include <pluginlib/class_list_macros.hpp>

namespace desert_sim {

DrapedPathDisplay::DrapedPathDisplay()
    : DrapedLineDisplay("", QString::fromStdString(ros::message_traits::datatype<nav_msgs::Path>()),
                        "A path, whose heights do not count: it is laid on the ground.",
                        QColor(40, 110, 255)) {}

std::optional<DrapedLineDisplay::Line> DrapedPathDisplay::take() {
  const nav_msgs::PathConstPtr path = inbox_.take();
  if (!path) return std::nullopt;
  Line line{path->header.frame_id, {}};
  line.points.reserve(path->poses.size());
  for (const geometry_msgs::PoseStamped& pose : path->poses)
    line.points.push_back({pose.pose.position.x, pose.pose.position.y});
  return line;
}

}  // namespace desert_sim

PLUGINLIB_EXPORT_CLASS(desert_sim::DrapedPathDisplay, rviz::Display)
