#pragma once
/// Transforms to the terrain's frame, from what was told of other frames. No ROS graph is needed.

#include <geometry_msgs/TransformStamped.h>
#include <std_msgs/Header.h>
#include <tf2/LinearMath/Transform.h>
#include <tf2/buffer_core.h>

#include <chrono>
#include <string>

namespace desert_sim {

/// The name of a frame without the '/' before it, which tf2 does not know, but messages of older programs
/// have.
inline std::string frame_name(const std::string& given) {
  return !given.empty() && given[0] == '/' ? given.substr(1) : given;
}

/// Safe to use from several threads.
class TerrainTransforms {
 public:
  /// `patience`: how long to_terrain() waits for a transform that is on its way, in wall time, since ROS time
  /// may stand still.
  explicit TerrainTransforms(std::string terrain_frame,
                             std::chrono::milliseconds patience = std::chrono::milliseconds(0))
      : terrain_frame_(std::move(terrain_frame)), patience_(patience) {}

  const std::string& terrain_frame() const { return terrain_frame_; }

  /// The transform from the header's frame (empty: the terrain's) at its stamp (0: the latest there is) to
  /// the terrain's. Throws ConfigError with the reason if there is none.
  tf2::Transform to_terrain(const std_msgs::Header& header) const;

  /// The latest transform from `frame` to the terrain's, without waiting. If there is none, returns false,
  /// and `reason` says why.
  bool latest_to_terrain(const std::string& frame, tf2::Transform& transform, std::string& reason) const;

  /// Takes a transform; tf2 may ignore it, or throw its exceptions. `sender` is who told it.
  void add(const geometry_msgs::TransformStamped& transform, const std::string& sender, bool is_static) {
    buffer_.setTransform(transform, sender, is_static);
  }

 protected:
  tf2::BufferCore& buffer() { return buffer_; }

 private:
  tf2::Transform lookup(const std::string& frame, const ros::Time& time) const;

  const std::string terrain_frame_;
  const std::chrono::milliseconds patience_;
  tf2::BufferCore buffer_;
};

}  // namespace desert_sim
