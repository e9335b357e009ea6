#pragma once
/// ~plants and ~plant_markers: plants one by one.

#include <desert_sim/Plants.h>
#include <visualization_msgs/MarkerArray.h>

#include <string>
#include <vector>

#include "src/ros/node/moment.hpp"

namespace desert_sim {

/// At most `count` plants, the widest; in the order of the list.
PlantsPtr plants_message(const TerrainState& state, const std::string& frame, int count);

/// Plants as triangles, a marker a species and level of detail, in the species' namespace: id 0 has the
/// widest tenth of `count` plants, with trunk and crown of six sides, id 1 the others of the `count` widest,
/// as pyramids. A plant in bad health is drawn lower. Markers that are no longer needed are deleted.
class PlantMarkers {
 public:
  explicit PlantMarkers(std::string frame) : frame_(std::move(frame)) {}
  visualization_msgs::MarkerArrayPtr markers(const TerrainState& state, int count);

 private:
  std::string frame_;
  std::vector<std::string> shown_;  ///< namespaces
};

}  // namespace desert_sim
