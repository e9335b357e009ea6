#pragma once
/// Saves a terrain as files: its layers, and a scenario that builds the same terrain from them; or a scenario
/// as it is now, with all of its state.

#include <functional>
#include <string>

#include "src/simulation/simulation.hpp"

namespace desert_sim {

/// The persistent layers in use, which make up a terrain, but for vegetation that live plants make.
/// save_terrain() takes a snapshot of them.
std::vector<Layer> persistent_layers(const Simulation& simulation);
/// The persistent layers of a snapshot.
std::vector<Layer> persistent_layers(const Snapshot& snapshot);

/// The steps with which a scenario loads the saved layers. File names are relative to the scenario's folder.
struct SavedLayers {
  std::vector<RasterStep> steps;
  std::string georeferenced;  ///< a file with georeference and projection; empty: none
};

/// Writes the persistent layers of a snapshot to files in `folder`, with names from layer_file_name(). Throws
/// ConfigError that names the file.
using LayerWriter =
    std::function<SavedLayers(const Snapshot& snapshot, const std::string& folder, const std::string& tag)>;
/// Name of the file of a saved layer: "terrain-<what>-<tag><ending>".
std::string layer_file_name(const std::string& what, const std::string& tag, const std::string& ending);

/// Writes each layer as a float32 GeoTIFF.
LayerWriter geotiff_writer(const std::string& projection);
/// Writes each layer as a 16-bit PNG, scaled between the layer's lowest and highest value, north up.
LayerWriter png16_writer();

/// Writes the snapshot's layers into the folder of `scenario_file`, then the scenario file itself, whose
/// terrain steps load these files. Plants are not saved: where the scenario has any, they come up anew when
/// it is loaded, and the scenario file says so. Heights are rounded to the format's precision; only a
/// checkpoint is exact. `tag` makes the file names differ from those of an earlier save, whose files stay
/// valid until the new scenario file has replaced the old one, and are then removed. Saves to one folder,
/// also those of other processes, wait for each other. Throws ConfigError or WriteError that names the file;
/// an earlier terrain is then unchanged, and nothing new is left.
void save_terrain(const std::string& scenario_file, const Scenario& scenario, const Snapshot& snapshot,
                  const LayerWriter& write_layers, const std::string& tag);

/// Writes the state, as checkpoint_bytes() gives it, beside `scenario_file`, then that file itself:
/// `scenario`, which is to be the present one, with `run.start_from`. Nothing is rounded and nothing left
/// out: it goes on with the same bits. Other saves and errors as for save_terrain().
void save_scenario(const std::string& scenario_file, const Scenario& scenario, std::uint64_t step,
                   const std::string& checkpoint);

}  // namespace desert_sim
