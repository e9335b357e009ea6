#pragma once
/// The file formats of ~save_terrain.

#include <string>

#include "src/io/terrain_files.hpp"
#include "src/ros/simulation/terrain_state.hpp"

namespace desert_sim {

enum class TerrainFormat : int { geotiff, png16, rosbag };
constexpr const char* terrain_formats[] = {"geotiff", "png16", "rosbag"};

/// The format of this name. Throws ConfigError, naming the field, for one that is unknown.
TerrainFormat terrain_format(const std::string& name);

/// What writes the layers of `terrain`, which must outlive it. The map in a bag is in the frame `frame`, on
/// `topic`.
LayerWriter layer_writer(TerrainFormat format, const TerrainToSave& terrain, const std::string& frame,
                         const std::string& topic);

}  // namespace desert_sim
