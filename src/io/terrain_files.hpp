#pragma once
/// A terrain as files: a raster a layer, and a scenario that builds the same terrain from them.

#include <string>

#include "desert_sim/simulation/simulation.hpp"

namespace desert_sim {

/// geotiff: float32, georeferenced. png16: 16 bits between a layer's lowest and highest value, north up.
enum class TerrainFormat : int { geotiff, png16 };
constexpr const char* terrain_formats[] = {"geotiff", "png16"};

/// Layers that make up a terrain; a snapshot of them is what save_terrain() takes.
std::vector<Layer> terrain_layers(const Simulation& simulation);

/// Writes the snapshot's layers into the folder of `scenario_file`, then that file: `scenario` with the
/// terrain made of these rasters. Heights are rounded to the format; a checkpoint keeps every bit. `tag` sets
/// the rasters' names apart from those of an earlier save, which stays whole until the new scenario file has
/// taken its place, and is removed then. Throws ConfigError naming the file.
void save_terrain(const std::string& scenario_file, const Scenario& scenario, const Snapshot& snapshot,
                  TerrainFormat format, const std::string& tag);

}  // namespace desert_sim
