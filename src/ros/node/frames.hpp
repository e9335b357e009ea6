#pragma once
/// Points of other frames, brought into the terrain's; and a frame in the middle of the terrain.

#include <std_msgs/Header.h>
#include <tf2/LinearMath/Transform.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>

#include <memory>
#include <string>

#include "src/simulation/simulation.hpp"

namespace desert_sim {

class Frames {
 public:
  /// Listens to /tf on threads of its own.
  explicit Frames(std::string terrain_frame);
  const std::string& terrain_frame() const { return terrain_frame_; }

  /// From the header's frame (empty: the terrain's) at its stamp (0: the latest there is) to the terrain's.
  /// Waits a moment for a transform that is on its way; throws ConfigError with the reason if there is none.
  tf2::Transform to_terrain(const std_msgs::Header& header) const;

  /// Of the latest there is, from `frame` to the terrain's, without waiting; if there is none false, and
  /// `why`.
  bool latest_to_terrain(const std::string& frame, tf2::Transform& transform, std::string& why) const;

  /// Publishes the static frame `name` in the middle of the terrain, at its mean height.
  void announce_center(const std::string& name, const Snapshot& snapshot);
  bool has_center() const { return broadcaster_ != nullptr; }
  /// Moves it to the middle of another terrain. By one thread at a time.
  void move_center(const Snapshot& snapshot);

 private:
  std::string terrain_frame_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
  std::string center_name_;
  std::unique_ptr<tf2_ros::StaticTransformBroadcaster> broadcaster_;
};

}  // namespace desert_sim
