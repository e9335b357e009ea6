#include "src/ros/topics/map_parameters.hpp"

namespace desert_sim {

namespace {

constexpr double most_values = 67108864;

void read_layers(const YAML::Node& node, const std::string& key, Faults& faults,
                 std::vector<MapLayer>& layers) {
  if (!node.IsDefined()) return;
  if (!node.IsSequence() || node.size() == 0)
    return faults.add(key, (node.IsSequence() ? "an empty list" : yaml::shown(node)) +
                               " where a list of layers is expected (known: " + map_layer_names() + ")");
  std::vector<std::string> names;
  for (const YAML::Node& name : node) names.push_back(name.IsScalar() ? name.Scalar() : yaml::shown(name));
  try {
    layers = choose_map_layers(names, key);
  } catch (const ConfigError& e) {
    faults.add(key, std::string(e.what()).substr(key.size() + 2));
  }
}

}  // namespace

void read_map_setup(const YAML::Node& root, Faults& faults, MapSetup& maps, std::set<std::string>& known) {
  yaml::read_parameters(root, "", faults, maps.parameters, known);
  known.insert({"grid_map_layers", "local_map_layers"});
  read_layers(root["grid_map_layers"], "grid_map_layers", faults, maps.grid_map_layers);
  read_layers(root["local_map_layers"], "local_map_layers", faults, maps.local_map_layers);
  const MapParameters& p = maps.parameters;
  if ((p.grid_map_length_x == 0) != (p.grid_map_length_y == 0))
    faults.add("grid_map_length_x", "and grid_map_length_y must both be 0 or both be above it");
}

void require_moderate(const MapWindow& window, std::size_t layers, const std::string& what) {
  const double values = static_cast<double>(window.width) * window.height * static_cast<double>(layers);
  if (values > most_values)
    throw ConfigError(what + ": " + std::to_string(window.width) + " x " + std::to_string(window.height) +
                      " cells of " + std::to_string(layers) + " layers are more than " +
                      std::to_string(static_cast<long long>(most_values)) + " values");
}

void check_map_sizes(const MapSetup& maps, const GridParameters& grid) {
  Snapshot s;
  s.width = grid.width;
  s.height = grid.height;
  s.cell_size = grid.cell_size;
  s.origin_x = grid.origin_x;
  s.origin_y = grid.origin_y;
  const MapParameters& p = maps.parameters;
  // The whole terrain is as large as it is: nobody has to subscribe.
  if (p.grid_map_length_x > 0)
    require_moderate(window_of({p.grid_map_x, p.grid_map_y, p.grid_map_length_x, p.grid_map_length_y}, s),
                     maps.grid_map_layers.size(), "grid_map_length_x and grid_map_length_y");
  require_moderate(window_of({grid.origin_x, grid.origin_y, p.local_map_length_x, p.local_map_length_y}, s),
                   maps.local_map_layers.size(), "local_map_length_x and local_map_length_y");
}

}  // namespace desert_sim
