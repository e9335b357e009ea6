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

#include "desert_sim/ros/moment.hpp"

namespace desert_sim {

/// Cells x0 … x1 − 1 and y0 … y1 − 1.
struct CostRectangle {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  bool empty() const { return x0 >= x1 || y0 >= y1; }
  /// The smallest rectangle that holds both.
  CostRectangle with(const CostRectangle& other) const;
};

/// Cost of a traversability: 100 (lethal) at 0, else 0 … 99, falling; −1 (unknown) for NaN.
std::int8_t cost_of(float traversability);

/// Numbers nothing: a subscriber needs one whole map and all updates since. One thread at a time.
class CostmapStream {
 public:
  /// A costmap_2d that takes two messages in between two of its own cycles only looks at the cells of the
  /// second: what was sent less than `repeat` ago is part of the next rectangle.
  CostmapStream(ros::Publisher keyframes, ros::Publisher updates, std::string frame,
                std::chrono::duration<double> repeat);
  void publish_keyframe(const TerrainState& state);
  /// The rectangle of all cells that changed since. Nothing, and false, if none has, or if a whole map is due
  /// first: subscribers hold one of another terrain or none. Soon after the terrain was replaced, a whole map
  /// in its place: a message on one topic may overtake one on another, and costmap_2d writes an update that
  /// does not fit the map it holds past that map's end.
  bool publish_update(const TerrainState& state);

 private:
  using Clock = std::chrono::steady_clock;
  struct Sent {
    Clock::time_point time;
    CostRectangle cells;
  };

  void hold(const TerrainState& state);
  bool holds(const TerrainState& state) const;
  CostRectangle changes(const std::vector<std::int8_t>& now) const;
  /// Adds what was sent lately, and remembers that it is sent now.
  CostRectangle with_recent(const CostRectangle& cells);

  ros::Publisher keyframes_, updates_;
  std::string frame_;
  std::chrono::duration<double> repeat_;
  std::vector<std::int8_t> held_;
  int width_ = 0, height_ = 0;
  std::uint64_t terrain_ = 0;
  std::deque<Sent> sent_;
  Clock::time_point replaced_;  ///< when the first whole map of another terrain was sent
};

}  // namespace desert_sim
