#pragma once
/// ~elevation and ~elevation_updates: keyframes, and what changed since.

#include <desert_sim/ElevationUpdate.h>
#include <ros/publisher.h>

#include <string>

#include "desert_sim/ros/held_elevation.hpp"
#include "desert_sim/ros/moment.hpp"

namespace desert_sim {

/// Numbers keyframes and updates and publishes them. One thread at a time.
class ElevationStream {
 public:
  ElevationStream(ros::Publisher keyframes, ros::Publisher updates, std::string frame);
  /// See HeldElevation.
  void configure(double threshold, int tile) { held_.configure(threshold, tile); }
  void publish_keyframe(const TerrainState& state);
  /// Starts a keyframe that nobody gets if there is no subscriber to keyframes and none has been started for
  /// this terrain; if there is one, a keyframe is due first: false, and nothing is published.
  bool publish_update(const TerrainState& state);

 private:
  void start_keyframe(const TerrainState& state);

  ros::Publisher keyframes_, updates_;
  std::string frame_;
  HeldElevation held_{0, 1};
  std::uint64_t terrain_ = 0;
  std::uint32_t keyframe_ = 0, sequence_ = 0;
};

}  // namespace desert_sim
