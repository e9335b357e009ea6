#pragma once
/// A terrain as files: its layers, and a scenario that builds the same terrain from them.

#include <functional>
#include <string>

#include "src/simulation/simulation.hpp"

namespace desert_sim {

/// Layers that make up a terrain; a snapshot of them is what save_terrain() takes.
std::vector<Layer> terrain_layers(const Simulation& simulation);
/// Those that a snapshot has.
std::vector<Layer> terrain_layers(const Snapshot& snapshot);

/// How a scenario builds the layers again, from files that are named relative to their folder.
struct SavedLayers {
  std::vector<RasterStep> steps;
  std::string georeferenced;  ///< the file that has the projection; empty: none has
};

/// Writes the layers that make up a terrain to files of a folder. Their names are made by layer_file().
/// Throws ConfigError naming the file.
using LayerWriter =
    std::function<SavedLayers(const Snapshot& snapshot, const std::string& folder, const std::string& tag)>;
std::string layer_file(const std::string& what, const std::string& tag, const std::string& ending);

/// float32 GeoTIFFs.
LayerWriter geotiff_writer(const std::string& projection);
/// 16-bit PNGs between a layer's lowest and highest value, north up.
LayerWriter png16_writer();

/// Writes the snapshot's layers into the folder of `scenario_file`, then that file: `scenario` with the
/// terrain made of these files. Heights are rounded to the format; a checkpoint keeps every bit. `tag` sets
/// the files' names apart from those of an earlier save, which stays whole until the new scenario file has
/// taken its place, and is removed then. Throws ConfigError naming the file.
void save_terrain(const std::string& scenario_file, const Scenario& scenario, const Snapshot& snapshot,
                  const LayerWriter& write_layers, const std::string& tag);

}  // namespace desert_sim
