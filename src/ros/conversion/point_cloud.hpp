#pragma once
/// ~points: the surface as coloured, shaded points. ~water_points: that of the water.

#include <sensor_msgs/PointCloud2.h>

#include <string>
#include <vector>

#include "src/ros/node/moment.hpp"

namespace desert_sim {

/// The layers that points show.
const std::vector<Layer>& point_layers();

/// Every k-th cell in both directions, such that there are at most `count` points; row-major from the
/// south-west, one row of the cloud a row of cells. Fields, float32: x, y, z [m], rgb (material in its
/// colour, lit from the west-north-west), sand [m], wind_shadow [0…1].
sensor_msgs::PointCloud2Ptr point_cloud(const TerrainState& state, const std::string& frame, int count);

const std::vector<Layer>& water_point_layers();

/// The water's surface at those of the same cells that are under more than a centimetre of it, in the same
/// order, in a cloud of one row. Fields, float32: x, y, z [m], rgb (by depth), depth [m], speed [m/s].
sensor_msgs::PointCloud2Ptr water_cloud(const TerrainState& state, const std::string& frame, int count);

}  // namespace desert_sim
