#pragma once
/// What ~save_terrain can write.

#include <string>

#include "src/io/terrain_files.hpp"
#include "src/ros/node/moment.hpp"

namespace desert_sim {

enum class TerrainFormat : int { geotiff, png16, rosbag };
constexpr const char* terrain_formats[] = {"geotiff", "png16", "rosbag"};

/// `terrain` must outlive the writer. A bag's map is in the frame `frame`, on `topic`.
LayerWriter layer_writer(TerrainFormat format, const TerrainToSave& terrain, const std::string& frame,
                         const std::string& topic);

}  // namespace desert_sim
