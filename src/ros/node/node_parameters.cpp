#include "src/ros/node/node_parameters.hpp"

#include <ros/master.h>
#include <ros/param.h>
#include <yaml-cpp/yaml.h>

#include <set>

#include "src/ros/node/frame_name.hpp"
#include "src/ros/node/package_folder.hpp"
#include "src/ros/node/xmlrpc_yaml.hpp"
#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

namespace {

YAML::Node read_namespace(const std::string& name) {
  XmlRpc::XmlRpcValue value;
  if (!ros::param::get(name, value)) {
    if (!ros::master::check())
      throw Error("the master, which keeps the parameters of " + name + ", does not answer");
    return YAML::Node(YAML::NodeType::Map);
  }
  return yaml_from_xmlrpc(value, name);
}

std::set<std::string> scenario_sections() {
  std::set<std::string> names;
  for (const auto& entry : YAML::Load(dump_scenario(Scenario()))) names.insert(entry.first.Scalar());
  return names;
}

/// Splits off the scenario's sections; a key that is neither one nor in `known` is a fault.
YAML::Node take_sections(const YAML::Node& root, const std::set<std::string>& known, Faults& faults) {
  const std::set<std::string> sections = scenario_sections();
  YAML::Node scenario(YAML::NodeType::Map);
  std::string names, section_names;
  for (const std::string& name : known) names += (names.empty() ? "" : ", ") + name;
  for (const std::string& name : sections) section_names += (section_names.empty() ? "" : ", ") + name;
  for (const auto& entry : root) {
    const std::string key = entry.first.Scalar();
    if (sections.count(key)) {
      scenario[key] = entry.second;
    } else if (!known.count(key)) {
      faults.add(key,
                 "unknown parameter (known: " + names + "; sections of a scenario: " + section_names + ")");
    }
  }
  return scenario;
}

Settings read_settings(const YAML::Node& node, Faults& faults) {
  Settings settings;
  if (!node.IsDefined() || node.IsNull() || (node.IsScalar() && node.Scalar().empty())) return settings;
  if (node.IsScalar()) return {node.Scalar()};
  if (!node.IsSequence())
    faults.add("settings", yaml::shown(node) + " where a list of path=value is expected");
  for (std::size_t n = 0; node.IsSequence() && n < node.size(); ++n) {
    if (node[n].IsScalar()) {
      settings.push_back(node[n].Scalar());
    } else {
      faults.add("settings." + std::to_string(n),
                 yaml::shown(node[n]) + " where a text path=value is expected");
    }
  }
  return settings;
}

/// The leaves of the sections as settings, so that they override single keys of a file. A list is one leaf.
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

Scenario read_scenario(const std::string& source, const NodeParameters& node, const YAML::Node& sections,
                       const Settings& settings) {
  if (node.scenario.empty()) {
    if (sections.size() == 0)
      throw ConfigError(source +
                        ": no scenario: set ~scenario, or the sections of one (grid, terrain, wind, ...)");
    if (!settings.empty())
      throw ConfigError(source +
                        ": settings: change the keys of a scenario file, and ~scenario is empty; set the "
                        "sections themselves");
    Scenario scenario = parse_scenario(sections, source, "");
    scenario.name = "parameters";
    return scenario;
  }
  Settings all;
  flatten(sections, "", all);
  all.insert(all.end(), settings.begin(), settings.end());
  return load_scenario(scenario_file(node.scenario), all);
}

}  // namespace

NodeSetup read_node_setup(const ros::NodeHandle& private_node) {
  const std::string name = private_node.getNamespace(), source = "parameters of " + name;
  const YAML::Node root = read_namespace(name);
  Faults faults(source);
  NodeSetup setup;
  std::set<std::string> known{"settings"};
  yaml::read_parameters(root, "", faults, setup.node, known);
  read_publisher_setup(root, faults, setup.publishers, known);
  const Settings settings = read_settings(root["settings"], faults);
  const YAML::Node sections = take_sections(root, known, faults);
  check_frame(setup.node.frame_id, "frame_id", faults);
  if (!setup.node.center_frame.empty()) check_frame(setup.node.center_frame, "center_frame", faults);
  faults.throw_if_any();
  setup.scenario = read_scenario(source, setup.node, sections, settings);
  return setup;
}

}  // namespace desert_sim
