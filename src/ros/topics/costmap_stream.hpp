#pragma once
/// ~costmap and ~costmap_updates, for costmap_2d's static layer: whole maps, and one rectangle a tick.

#include <map_msgs/OccupancyGridUpdate.h>
#include <nav_msgs/OccupancyGrid.h>
#include <ros/publisher.h>

#include <chrono>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "src/ros/node/moment.hpp"

namespace desert_sim {

/// Numbers nothing: a subscriber needs one whole map and all updates since. What subscribers hold is kept by
/// the simulation, which tells what they lack, and here beside it, because a rectangle has all its cells.
/// One thread at a time.
class CostmapStream {
 public:
  CostmapStream(ros::Publisher keyframes, ros::Publisher updates, std::string frame);
  /// A costmap_2d that takes two messages in between two of its own cycles only looks at the cells of the
  /// second: what was sent less than one and a half periods of `update_rate` ago (0: seconds) is part of the
  /// next rectangle. `threshold`: see CostQuery.
  void configure(double update_rate, int threshold);
  /// What publish_update() needs. publish_keyframe() needs the whole map.
  void ask_for_update(CostQuery& query);
  void publish_keyframe(const TerrainState& state);
  /// The smallest rectangle with all cells that differ from what is held by more than the threshold. Nothing,
  /// and false, if none does, or if a whole map is due first: subscribers hold one of another terrain or
  /// none. Soon after the terrain was replaced, a whole map in its place: a message on one topic may overtake
  /// one on another, and costmap_2d writes an update that does not fit the map it holds past that map's end.
  bool publish_update(const TerrainState& state);

 private:
  using Clock = std::chrono::steady_clock;
  struct Sent {
    Clock::time_point time;
    CellBox cells;
  };

  bool holds(const TerrainState& state) const;
  void take(const CostChanges& changes, const TerrainState& state);
  void publish_whole(const TerrainState& state);
  void publish_box(const CellBox& box, const TerrainState& state);

  ros::Publisher keyframes_, updates_;
  std::string frame_;
  std::chrono::duration<double> repeat_{0};
  int threshold_ = 0;
  int width_ = 0, height_ = 0;
  std::vector<std::int8_t> held_;  ///< row-major
  std::uint64_t terrain_ = 0;      ///< that is held
  std::deque<Sent> sent_;          ///< lately, without what was repeated
  Clock::time_point replaced_;     ///< when a map of another terrain was held first
};

}  // namespace desert_sim
