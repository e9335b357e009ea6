#pragma once
/// What subscribers to ~elevation and ~elevation_updates hold, and what they lack.

#include <desert_sim/ElevationTile.h>

#include <vector>

#include "desert_sim/ros/cell_box.hpp"
#include "desert_sim/simulation/simulation.hpp"

namespace desert_sim {

class HeldElevation {
 public:
  /// `threshold` [m]: how far a cell that is held may be off. `tile` [cells]: largest width and height of
  /// what is sent as one.
  HeldElevation(double threshold, int tile) { configure(threshold, tile); }
  void configure(double threshold, int tile);
  /// A keyframe: all of it.
  void hold(const Snapshot& snapshot);
  void forget();
  /// Whether updates of this terrain can build on what is held.
  bool holds(const Snapshot& snapshot) const;
  /// The cells that differ by more than the threshold from what is held, which then holds them: as steps, the
  /// error of which is within the threshold, or as elevations, where steps in eight bits would be too coarse.
  std::vector<ElevationTile> take_changes(const Snapshot& snapshot);

 private:
  std::size_t row(int y) const { return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_); }
  bool differs(float now, float held) const;
  /// The smallest box in `cells` that has all that differ.
  CellBox differing(const std::vector<float>& now, const CellBox& cells) const;
  ElevationTile take(const std::vector<float>& now, const CellBox& cells);

  float threshold_ = 0;
  int tile_ = 1, width_ = 0, height_ = 0;
  std::vector<float> held_;
};

}  // namespace desert_sim
