#pragma once
/// Frames: transforms to the terrain's frame, a static frame in the middle of the terrain, and names of
/// frames.

#include <ros/callback_queue.h>
#include <ros/message_event.h>
#include <ros/spinner.h>
#include <ros/subscriber.h>
#include <std_msgs/Header.h>
#include <tf2/LinearMath/Transform.h>
#include <tf2_msgs/TFMessage.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <memory>
#include <string>

#include "src/simulation/simulation.hpp"

namespace desert_sim {

class ValidationErrors;

/// Removes a leading '/', which tf2 does not know, from the value of the parameter `key`. A value that is no
/// name of a frame is an error.
void check_frame(std::string& frame, const std::string& key, ValidationErrors& errors);

class Frames {
 public:
  /// Listens to /tf and /tf_static on a thread of its own.
  explicit Frames(std::string terrain_frame);
  ~Frames();
  const std::string& terrain_frame() const { return terrain_frame_; }

  /// The transform from the header's frame (empty: the terrain's) at its stamp (0: the latest there is) to
  /// the terrain's. Waits a moment for a transform that is on its way; throws ConfigError with the reason if
  /// there is none.
  tf2::Transform to_terrain(const std_msgs::Header& header) const;

  /// The latest transform from `frame` to the terrain's, without waiting. If there is none, returns false,
  /// and `why` says the reason.
  bool latest_to_terrain(const std::string& frame, tf2::Transform& transform, std::string& reason) const;

  /// Publishes the static frame `name` in the middle of the terrain, at its mean elevation.
  void announce_center(const std::string& name, const Snapshot& snapshot);
  bool has_center() const { return broadcaster_ != nullptr; }
  /// Moves that frame to the middle of another terrain. Only one thread may call it at a time.
  void move_center(const Snapshot& snapshot);

 private:
  using TransformEvent = ros::MessageEvent<const tf2_msgs::TFMessage>;
  void receive(const TransformEvent& event, bool is_static);

  std::string terrain_frame_;
  tf2_ros::Buffer buffer_;
  ros::Time last_received_;  ///< of receive() alone
  ros::CallbackQueue queue_;
  ros::Subscriber transforms_, static_transforms_;
  ros::AsyncSpinner spinner_{1, &queue_};
  std::string center_name_;
  std::unique_ptr<tf2_ros::StaticTransformBroadcaster> broadcaster_;
};

}  // namespace desert_sim
