#pragma once
/// ~elevation and ~elevation_updates: keyframes, and what changed since.

#include <desert_sim/ElevationUpdate.h>
#include <ros/publisher.h>

#include <string>

#include "src/ros/node/moment.hpp"

namespace desert_sim {

/// Numbers keyframes and updates and publishes them. What subscribers hold is kept by the simulation, and
/// goes with its terrain when that is replaced. One thread at a time.
class ElevationStream {
 public:
  ElevationStream(ros::Publisher keyframes, ros::Publisher updates, std::string frame);
  /// `threshold` [m]: how far a cell that is held may be off. `tile` [cells]: largest width and height of
  /// what is sent as one.
  void configure(double threshold, int tile);

  // What has to be asked for; where both are due, the update first.
  void ask_for_update(StateQuery& held);
  void ask_for_keyframe(StateQuery& held);

  void publish_keyframe(const TerrainState& state);
  /// Starts a keyframe that nobody gets if there is no subscriber to keyframes and none has been started for
  /// this terrain; if there is one, a keyframe is due first: false, and nothing is published.
  bool publish_update(const TerrainState& state);

 private:
  void start_keyframe();

  ros::Publisher keyframes_, updates_;
  std::string frame_;
  double threshold_ = 0;
  int tile_ = 1;
  bool starts_without_ = false;  ///< of the update that was asked for
  std::uint32_t keyframe_ = 0, sequence_ = 0;
};

}  // namespace desert_sim
