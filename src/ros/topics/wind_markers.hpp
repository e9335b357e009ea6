#pragma once
/// ~wind_markers: arrows of the wind at the surface, and the simulation's clock as a text.

#include <visualization_msgs/MarkerArray.h>

#include <string>
#include <vector>

#include "src/ros/node/moment.hpp"

namespace desert_sim {

const std::vector<Layer>& wind_marker_layers();

class WindMarkers {
 public:
  explicit WindMarkers(std::string frame) : frame_(std::move(frame)) {}
  /// At most `count` arrows, in the namespace "wind", ids 0… by rows from the south-west; the text "clock",
  /// id 0, above the north edge. An arrow of the high-altitude wind's speed nearly reaches the next one;
  /// colour goes from blue (half that speed) over white to red (half as fast again). When the number of
  /// arrows has changed, the old ones are deleted first.
  visualization_msgs::MarkerArrayPtr markers(const TerrainState& state, int count);

 private:
  std::string frame_;
  int columns_ = 0, rows_ = 0;
};

/// Such as "1 d 02:03:04   step 93784   wind 5.0 m/s to 90 deg".
std::string clock_text(const Snapshot& snapshot);

}  // namespace desert_sim
