#pragma once
/// ~points: the surface as coloured, shaded points.

#include <sensor_msgs/PointCloud2.h>

#include <string>
#include <vector>

#include "desert_sim/ros/moment.hpp"

namespace desert_sim {

/// The layers that points show.
const std::vector<Layer>& point_layers();

/// Every k-th cell in both directions, such that there are at most `count` points; row-major from the
/// south-west, one row of the cloud a row of cells. Fields, float32: x, y, z [m], rgb (material in its
/// colour, lit from the west-north-west), sand [m], wind_shadow [0…1].
sensor_msgs::PointCloud2Ptr point_cloud(const TerrainState& state, const std::string& frame, int count);

}  // namespace desert_sim
