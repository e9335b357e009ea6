#include "src/ros/parameters/node_parameters.hpp"

#include <yaml-cpp/yaml.h>

#include <set>
#include <sstream>

#include "src/core/did_you_mean.hpp"
#include "src/core/joined.hpp"
#include "src/core/parameter_page.hpp"
#include "src/ros/conversion/frames.hpp"
#include "src/ros/support/private_parameters.hpp"
#include "src/scenario/scenario_file.hpp"
#include "src/scenario/yaml_document.hpp"
#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

namespace {

// ---- Reading.

std::set<std::string> scenario_sections() {
  std::set<std::string> names;
  for (const auto& entry : YAML::Load(dump_scenario(Scenario()))) names.insert(entry.first.Scalar());
  return names;
}

/// The sections of the scenario among the parameters. A key that is neither a section nor in `known` is a
/// error.
YAML::Node extract_sections(const YAML::Node& root, const std::set<std::string>& known,
                            ValidationErrors& errors) {
  const std::set<std::string> sections = scenario_sections();
  YAML::Node scenario(YAML::NodeType::Map);
  const std::string names = joined(known), section_names = joined(sections);
  for (const auto& entry : root) {
    const std::string key = entry.first.Scalar();
    if (sections.count(key)) {
      scenario[key] = entry.second;
    } else if (!known.count(key)) {
      errors.add(key, "unknown parameter (known: " + names + "; sections of a scenario: " + section_names +
                          ")" + did_you_mean(key, names + ", " + section_names));
    }
  }
  return scenario;
}

/// Takes a list, one setting, or a list as text, as command lines give it: _settings:='[wind.speed=7,
/// seed=3]'.
Settings read_settings(const YAML::Node& given, ValidationErrors& errors) {
  if (!given.IsDefined() || given.IsNull() || (given.IsScalar() && given.Scalar().empty())) return {};
  if (given.IsScalar() && given.Scalar().front() != '[') return {given.Scalar()};
  YAML::Node node = given;
  Settings settings;
  try {
    if (given.IsScalar()) node.reset(yaml::load_document(given.Scalar()));
  } catch (const YAML::Exception& e) {
    errors.add("settings", yaml::node_text(given) + " is not a list: " + e.msg);
    return settings;
  }
  if (!node.IsSequence())
    errors.add("settings", yaml::node_text(node) + " is given where a list of path=value is expected");
  for (std::size_t n = 0; node.IsSequence() && n < node.size(); ++n) {
    if (node[n].IsScalar()) {
      settings.push_back(node[n].Scalar());
    } else {
      errors.add("settings." + std::to_string(n),
                 yaml::node_text(node[n]) + " is given where a text path=value is expected");
    }
  }
  return settings;
}

/// Adds the leaves of the sections as settings, so that they override single keys of a file. A list is one
/// leaf.
void flatten(const YAML::Node& node, const std::string& path, Settings& settings) {
  if (node.IsMap()) {
    for (const auto& entry : node)
      flatten(entry.second, (path.empty() ? "" : path + ".") + entry.first.Scalar(), settings);
    return;
  }
  YAML::Emitter out;
  out.SetMapFormat(YAML::Flow);
  out.SetSeqFormat(YAML::Flow);
  out << node;
  settings.push_back(path + "=" + out.c_str());
}

Scenario read_scenario_of(const std::string& source, const NodeParameters& node, const YAML::Node& sections,
                          const Settings& settings) {
  if (node.scenario.empty()) {
    if (sections.size() == 0)
      throw ConfigError(
          source +
          ": no scenario is given: set ~scenario, or the sections of a scenario (grid, terrain, wind, ...)");
    if (!settings.empty())
      throw ConfigError(source +
                        ": settings: they override keys of a scenario file, but ~scenario is empty; set the "
                        "sections of the scenario instead");
    Scenario scenario = parse_scenario(sections, source, "");
    scenario.name = "parameters";
    return scenario;
  }
  Settings all;
  flatten(sections, "", all);
  all.insert(all.end(), settings.begin(), settings.end());
  return load_scenario(scenario_file(node.scenario), all);
}

Scenario read_scenario(const std::string& source, const NodeParameters& node, const YAML::Node& sections,
                       const Settings& settings) {
  Scenario scenario = read_scenario_of(source, node, sections, settings);
  if (!node.script.empty()) add_script(scenario, node.script);
  return scenario;
}

// ---- The page.

void write_map_layers(std::ostream& out) {
  const PublisherSetup defaults;
  out << "\n## Layers of maps\n\n"
         "`grid_map_layers` (default `"
      << yaml_list(defaults.maps.grid_map_layers) << "`) and `local_map_layers` (default `"
      << yaml_list(defaults.maps.local_map_layers)
      << "`) are lists of these; `~get_submap` and `~get_grid_map` know the same. Each but the elevation, "
         "which "
         "has `~elevation`, is also a topic `~layers/<name>` with its `~layers/<name>_updates`. An update "
         "has "
         "the cells that changed by more than the threshold since what subscribers hold; `layer_thresholds` "
         "(default `"
      << yaml_map(defaults.layer_thresholds)
      << "`) gives layers other thresholds: `{sand_depth: 0.01, wind_x: 0.1}`. A layer that nobody asks for "
         "is "
         "not computed; one that the terrain does not have is 0.\n\n"
         "| layer | unit | threshold | what |\n|---|---|---|---|\n";
  for (const MapLayer& layer : map_layers) {
    const LayerInfo& about = info(layer.layer);
    out << "| `" << layer.name << "` | " << about.unit << " | ";
    if (layer.layer == Layer::elevation)
      out << "`update_threshold`";
    else
      out << layer.threshold;
    out << " | " << about.doc << " |\n";
  }
}

}  // namespace

NodeSetup read_node_setup(const ros::NodeHandle& private_node) {
  const std::string name = private_node.getNamespace(), source = "parameters of " + name;
  const YAML::Node root = private_parameters(name);
  ValidationErrors errors(source);
  NodeSetup setup;
  std::set<std::string> known{"settings"};
  yaml::read_parameters(root, "", errors, setup.node, known);
  read_publisher_setup(root, errors, setup.publishers, known);
  const Settings settings = read_settings(root["settings"], errors);
  const YAML::Node sections = extract_sections(root, known, errors);
  check_frame(setup.node.frame_id, "frame_id", errors);
  std::string& center = setup.node.center_frame;
  if (!center.empty() && center[0] == '~') center = name + "/" + center.substr(1);
  if (!center.empty()) check_frame(center, "center_frame", errors);
  errors.throw_if_any();
  setup.scenario = read_scenario(source, setup.node, sections, settings);
  return setup;
}

std::string describe_node_parameters() {
  std::ostringstream out;
  out << "# Parameters of the node\n\n"
         "Written by `desert_sim_node --describe`; a test fails when it is stale. All are private to the "
         "node. "
         "Beside them it takes the sections of a scenario ([parameters.md](parameters.md)), and `settings`, "
         "a "
         "list of `path=value` that override keys of the scenario file.\n\n## Node\n\n";
  write_parameter_table(out, NodeParameters());
  out << "\n## Topics\n\n"
         "Rates are of wall time; without subscribers nothing is sent. A rate of 0 leaves what is sent to a "
         "new "
         "subscriber, before the service `~step` answers, and after a reset or load.\n\n";
  write_parameter_table(out, PublisherParameters());
  out << "\n## Maps\n\n";
  write_parameter_table(out, MapParameters());
  write_map_layers(out);
  return out.str();
}

}  // namespace desert_sim
