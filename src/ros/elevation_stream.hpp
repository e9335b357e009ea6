#pragma once
/// ~elevation and ~elevation_updates: keyframes, and the tiles that changed since.

#include <desert_sim/ElevationUpdate.h>
#include <ros/publisher.h>

#include <string>
#include <vector>

#include "desert_sim/ros/moment.hpp"

namespace desert_sim {

/// What subscribers hold after a keyframe and its updates.
class HeldElevation {
 public:
  /// `threshold` [m]; `tile` [cells].
  HeldElevation(double threshold, int tile) : threshold_(threshold), tile_(tile) {}
  void hold(const Snapshot& snapshot);
  void forget();
  /// Whether updates of this terrain can build on what is held.
  bool holds(const Snapshot& snapshot) const;
  /// Tiles in which some cell differs by more than the threshold from what is held, which then holds them.
  std::vector<ElevationTile> take_changes(const Snapshot& snapshot);

 private:
  bool differs(const std::vector<float>& now, const ElevationTile& tile) const;

  double threshold_;
  int tile_, width_ = 0, height_ = 0;
  std::vector<float> held_;
};

/// Numbers keyframes and updates and publishes them. One thread at a time.
class ElevationStream {
 public:
  ElevationStream(ros::Publisher keyframes, ros::Publisher updates, std::string frame, double threshold,
                  int tile);
  void publish_keyframe(const TerrainState& state);
  /// Starts a keyframe that nobody gets if there is no subscriber to keyframes and none has been started for
  /// this terrain; if there is one, a keyframe is due first: false, and nothing is published.
  bool publish_update(const TerrainState& state);

 private:
  void start_keyframe(const TerrainState& state);

  ros::Publisher keyframes_, updates_;
  std::string frame_;
  HeldElevation held_;
  std::uint64_t terrain_ = 0;
  std::uint32_t keyframe_ = 0, sequence_ = 0;
};

}  // namespace desert_sim
