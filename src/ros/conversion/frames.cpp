#include "src/ros/conversion/frames.hpp"

#include <ros/init.h>
#include <ros/names.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "src/core/error.hpp"
#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

namespace {

constexpr auto transform_timeout = std::chrono::milliseconds(200);
constexpr double near = 16384;  // [m]: up to there float32 steps are at most a millimetre

}  // namespace

void check_frame(std::string& frame, const std::string& key, ValidationErrors& errors) {
  frame = frame_name(frame);
  std::string reason;
  if (frame.empty() || !ros::names::validate(frame, reason))
    errors.add(key, "'" + frame + "' is not a valid frame name" + (reason.empty() ? "" : ": " + reason));
}

Frames::Frames(std::string terrain_frame)
    : TerrainTransforms(std::move(terrain_frame), transform_timeout), listener_(buffer()) {
  view_.name = this->terrain_frame();
}

void Frames::announce_center(const std::string& name, const Snapshot& snapshot) {
  center_name_ = name;
  broadcaster_ = std::make_unique<tf2_ros::StaticTransformBroadcaster>();
  move_center(snapshot);
}

void Frames::move_center(const Snapshot& s) {
  const std::vector<float>& z = s.layers.at(Layer::elevation);
  geometry_msgs::TransformStamped center;
  center.header.stamp = ros::Time::now();
  center.header.frame_id = terrain_frame();
  center.child_frame_id = center_name_;
  center.transform.translation.x = s.origin_x + 0.5 * s.width * s.cell_size;
  center.transform.translation.y = s.origin_y + 0.5 * s.height * s.cell_size;
  center.transform.translation.z = std::accumulate(z.begin(), z.end(), 0.0) / static_cast<double>(z.size());
  center.transform.rotation.w = 1;
  // If the node was told to end while it started, the broadcaster has no publisher, and tf2 asserts that it
  // has one.
  if (!ros::isShuttingDown()) broadcaster_->sendTransform(center);
  const geometry_msgs::Vector3& at = center.transform.translation;
  const double farthest = std::max({std::abs(s.origin_x), std::abs(s.origin_x + s.width * s.cell_size),
                                    std::abs(s.origin_y), std::abs(s.origin_y + s.height * s.cell_size)});
  const std::lock_guard<std::mutex> lock(view_mutex_);
  view_ = farthest > near ? ViewFrame{center_name_, at.x, at.y, at.z} : ViewFrame{terrain_frame()};
}

ViewFrame Frames::view_frame() const {
  const std::lock_guard<std::mutex> lock(view_mutex_);
  return view_;
}

}  // namespace desert_sim
