#include "src/ros/conversion/terrain_transforms.hpp"

#include <tf2/LinearMath/Quaternion.h>

#include <thread>

#include "src/core/error.hpp"
#include "src/core/quoted.hpp"

namespace desert_sim {

tf2::Transform TerrainTransforms::lookup(const std::string& frame, const ros::Time& time) const {
  const geometry_msgs::Transform found = buffer_.lookupTransform(terrain_frame_, frame, time).transform;
  const auto& r = found.rotation;
  const auto& t = found.translation;
  return tf2::Transform(tf2::Quaternion(r.x, r.y, r.z, r.w), tf2::Vector3(t.x, t.y, t.z));
}

tf2::Transform TerrainTransforms::to_terrain(const std_msgs::Header& header) const {
  const std::string& given = header.frame_id;
  const std::string frame = frame_name(given);
  if (frame.empty() || frame == terrain_frame_) return tf2::Transform::getIdentity();
  const auto end = std::chrono::steady_clock::now() + patience_;
  while (true) {
    try {
      return lookup(frame, header.stamp);
    } catch (const std::runtime_error& e) {  // of tf2, or of times that are too far apart
      if (std::chrono::steady_clock::now() >= end)
        throw ConfigError("frame " + in_quotes(given) + " cannot be transformed into the terrain's frame '" +
                          terrain_frame_ + "': " + shortened(e.what()));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

bool TerrainTransforms::latest_to_terrain(const std::string& frame, tf2::Transform& transform,
                                          std::string& reason) const {
  try {
    transform = lookup(frame, ros::Time(0));
    return true;
  } catch (const std::runtime_error& e) {  // of tf2, or of times that are too far apart
    reason = "frame " + in_quotes(frame) + " cannot be transformed into the terrain's frame '" +
             terrain_frame_ + "': " + shortened(e.what());
    return false;
  }
}

}  // namespace desert_sim
