#pragma once
/// Frames: transforms to the terrain's frame as they are published, a static frame in the middle of the
/// terrain, and names of frames.

#include <tf2_ros/static_transform_broadcaster.h>

#include <memory>
#include <mutex>
#include <string>

#include "src/ros/conversion/terrain_transforms.hpp"
#include "src/ros/conversion/transform_listener.hpp"
#include "src/simulation/simulation.hpp"

namespace desert_sim {

class ValidationErrors;

/// Removes a leading '/', which tf2 does not know, from the value of the parameter `key`. A value that is no
/// name of a frame is an error.
void check_frame(std::string& frame, const std::string& key, ValidationErrors& errors);

/// A frame whose origin lies at (x, y, z) in the terrain's, and whose axes are parallel to the terrain's.
struct ViewFrame {
  std::string name;
  double x = 0, y = 0, z = 0;
};

class Frames : public TerrainTransforms {
 public:
  /// Listens to /tf and /tf_static on a thread of its own.
  explicit Frames(std::string terrain_frame);

  /// Publishes the static frame `name` in the middle of the terrain, at its mean elevation.
  void announce_center(const std::string& name, const Snapshot& snapshot);
  bool has_center() const { return broadcaster_ != nullptr; }
  /// Moves that frame to the middle of another terrain. Only one thread may call it at a time.
  void move_center(const Snapshot& snapshot);
  /// The frame for what viewers draw in float32: that in the middle of the terrain, if there is one and the
  /// terrain reaches farther than 16 km from the origin of its own, where float32 is coarser than a
  /// millimetre (half a metre at 4000 km, in UTM); else the terrain's.
  ViewFrame view_frame() const;

 private:
  TransformListener listener_;
  std::string center_name_;
  mutable std::mutex view_mutex_;
  ViewFrame view_;  ///< guarded by view_mutex_
  std::unique_ptr<tf2_ros::StaticTransformBroadcaster> broadcaster_;
};

}  // namespace desert_sim
