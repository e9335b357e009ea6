#include "src/ros/services/terrain_formats.hpp"

#include <algorithm>

#include "src/grid_map/grid_map_bag.hpp"
#include "src/ros/conversion/grid_map_message.hpp"
#include "src/ros/services/request_fields.hpp"

namespace desert_sim {

namespace {

/// The layer with the name that it has in maps, and with its own name if maps do not offer it.
MapLayer as_map_layer(Layer layer) {
  const auto found = std::find_if(map_layers.begin(), map_layers.end(),
                                  [layer](const MapLayer& offered) { return offered.layer == layer; });
  return found == map_layers.end() ? MapLayer{info(layer).name, layer} : *found;
}

/// Writes all layers into one bag, and the elevation with them for viewers of the map.
LayerWriter bag_writer(const TerrainState& state, const std::string& frame, const std::string& topic) {
  return [&state, frame, topic](const Snapshot& s, const std::string& folder, const std::string& tag) {
    const std::string file = layer_file_name("grid_map", tag, ".bag");
    std::vector<MapLayer> layers{as_map_layer(Layer::elevation)};
    SavedLayers saved;
    for (Layer layer : persistent_layers(s)) {
      layers.push_back(as_map_layer(layer));
      RasterStep step;
      step.layer = info(layer).name;
      step.file = file;
      step.band = static_cast<int>(layers.size());
      step.complete = true;
      saved.steps.push_back(step);
    }
    write_grid_map(folder + "/" + file, topic, grid_map(state, frame, layers, whole_window(s)));
    return saved;
  };
}

}  // namespace

TerrainFormat terrain_format(const std::string& name) {
  return choice_named<TerrainFormat>(terrain_formats, name, "format");
}

LayerWriter layer_writer(TerrainFormat format, const TerrainToSave& terrain, const std::string& frame,
                         const std::string& topic) {
  switch (format) {
    case TerrainFormat::geotiff:
      return geotiff_writer(terrain.scenario.projection);
    case TerrainFormat::png16:
      return png16_writer();
    case TerrainFormat::rosbag:
      break;
  }
  return bag_writer(terrain.state, frame, topic);
}

}  // namespace desert_sim
