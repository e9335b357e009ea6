#pragma once
/// From the simulation's own types to messages. Sizes, orders, frames and units are in the message files.

#include <desert_sim/ElevationGrid.h>
#include <desert_sim/SimulationStatus.h>
#include <desert_sim/TerrainDiff.h>
#include <desert_sim/WindField.h>

#include <string>

#include "src/ros/node/moment.hpp"

namespace desert_sim {

std_msgs::Header header_of(const Moment& moment, const std::string& frame);
/// Lower-left corner of a grid's cell (0, 0).
geometry_msgs::Pose origin_of(const Snapshot& snapshot);
geometry_msgs::Vector3 vector_of(wind::Vector v);
/// 16 hexadecimal digits, as in summary.json.
std::string hash_text(std::uint64_t hash);

ElevationGridPtr elevation_message(const TerrainState& state, const std::string& frame,
                                   std::uint32_t keyframe);
/// Averages blocks of `decimation`² cells; a block over the edge averages what it has.
WindFieldPtr wind_message(const TerrainState& state, const std::string& frame, int decimation);
/// Of an edit whose result tells its change.
TerrainDiffPtr diff_message(const Reached& edit, const std::string& frame);
SimulationStatusPtr status_message(const StatusReport& report, const std::string& frame);

}  // namespace desert_sim
