#include "src/ros/topics/publisher_parameters.hpp"

#include <sstream>

#include "src/core/did_you_mean.hpp"
#include "src/ros/conversion/frames.hpp"

namespace desert_sim {

namespace {

/// Reads a list of names of layers; a missing one leaves `layers`.
void read_layers(const YAML::Node& node, const std::string& key, ValidationErrors& errors,
                 std::vector<MapLayer>& layers) {
  if (!node.IsDefined()) return;
  if (!node.IsSequence() || node.size() == 0)
    return errors.add(key, (node.IsSequence() ? "an empty list" : yaml::node_text(node)) +
                               " where a list of layers is expected (known: " + map_layer_names() + ")");
  std::vector<std::string> names;
  for (const YAML::Node& name : node)
    names.push_back(name.IsScalar() ? name.Scalar() : yaml::node_text(name));
  try {
    layers = map_layers_named(names, key);
  } catch (const ConfigError& e) {
    errors.add(key, std::string(e.what()).substr(key.size() + 2));
  }
}

/// Reads a map from names of layers to thresholds; a missing one leaves `thresholds`.
void read_thresholds(const YAML::Node& node, ValidationErrors& errors, LayerThresholds& thresholds) {
  const std::string key = "layer_thresholds";
  if (!node.IsDefined()) return;
  if (!node.IsMap())
    return errors.add(key, yaml::node_text(node) + " where a map from layers to thresholds is expected");
  thresholds.clear();
  for (const auto& entry : node) {
    const std::string name = entry.first.Scalar();
    double threshold = -1;
    if (name == "elevation")
      errors.add(key + ".elevation", "has a parameter of its own: update_threshold");
    else if (!find_map_layer(name))
      errors.add(key, not_one_of(name, map_layer_names()));
    else if (!YAML::convert<double>::decode(entry.second, threshold) ||
             !(threshold >= 0 && threshold <= 1000))
      errors.add(key + "." + name, yaml::node_text(entry.second) + " is not a number from 0 to 1000");
    else
      thresholds[name] = threshold;
  }
}

void read_map_setup(const YAML::Node& root, ValidationErrors& errors, MapSetup& maps,
                    std::set<std::string>& known) {
  yaml::read_parameters(root, "", errors, maps.parameters, known);
  known.insert({"grid_map_layers", "local_map_layers"});
  read_layers(root["grid_map_layers"], "grid_map_layers", errors, maps.grid_map_layers);
  read_layers(root["local_map_layers"], "local_map_layers", errors, maps.local_map_layers);
  const MapParameters& p = maps.parameters;
  if ((p.grid_map_length_x == 0) != (p.grid_map_length_y == 0))
    errors.add("grid_map_length_x", "and grid_map_length_y must both be 0 or both be above it");
  if (p.local_map_resolution > 0 && p.local_map_resolution < finest_detail)
    errors.add("local_map_resolution", std::to_string(p.local_map_resolution) + " is neither 0 nor in [" +
                                           std::to_string(finest_detail) + ", 1000] m");
}

}  // namespace

std::string yaml_map(const LayerThresholds& thresholds) {
  std::ostringstream text;
  for (const auto& [name, threshold] : thresholds)
    text << (text.tellp() > 0 ? ", " : "") << name << ": " << threshold;
  return "{" + text.str() + "}";
}

void read_publisher_setup(const YAML::Node& root, ValidationErrors& errors, PublisherSetup& setup,
                          std::set<std::string>& known) {
  yaml::read_parameters(root, "", errors, setup.topics, known);
  known.insert("layer_thresholds");
  read_thresholds(root["layer_thresholds"], errors, setup.layer_thresholds);
  read_map_setup(root, errors, setup.maps, known);
  check_frame(setup.maps.parameters.robot_frame, "robot_frame", errors);
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
    require_map_size(window_of({p.grid_map_x, p.grid_map_y, p.grid_map_length_x, p.grid_map_length_y}, s),
                     maps.grid_map_layers.size(), "grid_map_length_x and grid_map_length_y");
  if (p.local_map_resolution > 0) s.cell_size = p.local_map_resolution;
  require_map_size(window_of({grid.origin_x, grid.origin_y, p.local_map_length_x, p.local_map_length_y}, s),
                   maps.local_map_layers.size(), "local_map_length_x and local_map_length_y");
}

}  // namespace desert_sim
