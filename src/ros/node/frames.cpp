#include "src/ros/node/frames.hpp"

#include <ros/console.h>
#include <ros/init.h>
#include <ros/names.h>
#include <ros/node_handle.h>
#include <tf2/LinearMath/Quaternion.h>

#include <chrono>
#include <numeric>
#include <thread>

#include "src/core/error.hpp"
#include "src/core/quoted.hpp"
#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

namespace {

constexpr auto transform_timeout = std::chrono::milliseconds(200);  // of wall time: ROS time may stand still

tf2::Transform transform_of(const geometry_msgs::TransformStamped& found) {
  const auto& r = found.transform.rotation;
  const auto& t = found.transform.translation;
  return tf2::Transform(tf2::Quaternion(r.x, r.y, r.z, r.w), tf2::Vector3(t.x, t.y, t.z));
}

}  // namespace

void check_frame(std::string& frame, const std::string& key, ValidationErrors& errors) {
  if (!frame.empty() && frame[0] == '/') frame.erase(0, 1);
  std::string reason;
  if (frame.empty() || !ros::names::validate(frame, reason))
    errors.add(key, "'" + frame + "' is not a valid frame name" + (reason.empty() ? "" : ": " + reason));
}

Frames::Frames(std::string terrain_frame) : terrain_frame_(std::move(terrain_frame)) {
  ros::NodeHandle node;
  node.setCallbackQueue(&queue_);
  const auto subscribe = [&](const char* topic, bool is_static) {
    const boost::function<void(const TransformEvent&)> callback =
        [this, is_static](const TransformEvent& event) { receive(event, is_static); };
    return node.subscribe<tf2_msgs::TFMessage>(topic, 100, callback);
  };
  transforms_ = subscribe("/tf", false);
  static_transforms_ = subscribe("/tf_static", true);
  spinner_.start();
}

Frames::~Frames() { spinner_.stop(); }

/// Does what tf2_ros::TransformListener does, which throws out of its thread, and so ends the process, where
/// the clock goes back by more than 2^31 s.
void Frames::receive(const TransformEvent& event, bool is_static) {
  const ros::Time now = ros::Time::now();
  if (now < last_received_) {
    ROS_WARN("ROS time has jumped back: the transforms that were received before it are forgotten.");
    buffer_.clear();
  }
  last_received_ = now;
  for (const geometry_msgs::TransformStamped& transform : event.getConstMessage()->transforms) {
    try {
      buffer_.setTransform(transform, event.getPublisherName(), is_static);
    } catch (const std::exception& e) {
      ROS_ERROR_THROTTLE(10, "A transform to frame %s is ignored: %s",
                         quoted(transform.child_frame_id).c_str(), e.what());
    }
  }
}

tf2::Transform Frames::to_terrain(const std_msgs::Header& header) const {
  const std::string& given = header.frame_id;
  const std::string frame = !given.empty() && given[0] == '/' ? given.substr(1) : given;
  if (frame.empty() || frame == terrain_frame_) return tf2::Transform::getIdentity();
  const auto end = std::chrono::steady_clock::now() + transform_timeout;
  while (true) {
    try {
      return transform_of(buffer_.lookupTransform(terrain_frame_, frame, header.stamp));
    } catch (const std::runtime_error& e) {  // of tf2, or of times that are too far apart
      if (std::chrono::steady_clock::now() >= end)
        throw ConfigError("frame " + quoted(given) + " cannot be transformed into the terrain's frame '" +
                          terrain_frame_ + "': " + shortened(e.what()));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

bool Frames::latest_to_terrain(const std::string& frame, tf2::Transform& transform,
                               std::string& reason) const {
  try {
    transform = transform_of(buffer_.lookupTransform(terrain_frame_, frame, ros::Time(0)));
    return true;
  } catch (const std::runtime_error& e) {  // of tf2, or of times that are too far apart
    reason = "frame " + quoted(frame) + " cannot be transformed into the terrain's frame '" + terrain_frame_ +
             "': " + shortened(e.what());
    return false;
  }
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
  center.header.frame_id = terrain_frame_;
  center.child_frame_id = center_name_;
  center.transform.translation.x = s.origin_x + 0.5 * s.width * s.cell_size;
  center.transform.translation.y = s.origin_y + 0.5 * s.height * s.cell_size;
  center.transform.translation.z = std::accumulate(z.begin(), z.end(), 0.0) / static_cast<double>(z.size());
  center.transform.rotation.w = 1;
  // If the node was told to end while it started, the broadcaster has no publisher, and tf2 asserts that it
  // has one.
  if (!ros::isShuttingDown()) broadcaster_->sendTransform(center);
}

}  // namespace desert_sim
