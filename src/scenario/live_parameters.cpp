#include "src/scenario/live_parameters.hpp"

#include <yaml-cpp/yaml.h>

#include <map>
#include <set>

#include "src/core/did_you_mean.hpp"
#include "src/core/joined.hpp"
#include "src/scenario/former_keys.hpp"
#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

namespace {

std::set<std::string> live_paths() {
  std::set<std::string> paths{"water.springs"};
  Scenario scenario;
  for_each_live_parameter(scenario, [&](const char* section, const auto& row, const auto&) {
    paths.insert(std::string(section) + "." + row.name);
  });
  for (const auto& [section, parameters] : scenario.process_sections.all())
    for (const std::string& key : parameters->keys()) paths.insert(section + "." + key);
  return paths;
}

void collect_leaf_values(const YAML::Node& node, const std::string& path,
                         std::map<std::string, std::string>& found) {
  if (node.IsMap()) {
    for (const auto& entry : node)
      collect_leaf_values(entry.second, (path.empty() ? "" : path + ".") + entry.first.Scalar(), found);
    return;
  }
  YAML::Emitter out;
  out.SetMapFormat(YAML::Flow);
  out.SetSeqFormat(YAML::Flow);
  out << node;
  found[path] = out.c_str();
}

std::map<std::string, std::string> collect_leaf_values(const Scenario& scenario) {
  std::map<std::string, std::string> found;
  collect_leaf_values(YAML::Load(dump_scenario(scenario)), "", found);
  return found;
}

}  // namespace

const char* fixed_reason(const std::string& path) {
  for (const FixedParameter& fixed : fixed_parameters)
    if (path == fixed.path || path.compare(0, path.find('.'), fixed.path) == 0) return fixed.reason;
  return nullptr;
}

Scenario with_live_settings(const Scenario& scenario, const Settings& settings) {
  const std::set<std::string> live = live_paths();
  ValidationErrors errors("set_parameters");
  for (const std::string& setting : settings) {
    const std::string path = setting.substr(0, setting.find('='));
    if (const char* why = fixed_reason(path)) {
      errors.add(path, std::string("cannot change while the simulation runs: ") + why);
    } else if (const std::string now = instead_of_former_key(setting); !now.empty()) {
      errors.add(path, now);
    } else if (!live.count(path)) {
      errors.add(path,
                 "unknown parameter (config/parameters.md lists all)" + did_you_mean(path, joined(live)));
    }
  }
  errors.throw_if_any();
  Scenario changed = parse_scenario_text(dump_scenario(scenario), "set_parameters", settings);
  changed.name = scenario.name;
  changed.folder = scenario.folder;
  changed.projection = scenario.projection;
  changed.wind_series = scenario.wind_series;
  return changed;
}

std::vector<std::pair<std::string, std::string>> changed_parameters(const Scenario& before,
                                                                    const Scenario& now) {
  const std::map<std::string, std::string> old = collect_leaf_values(before);
  std::vector<std::pair<std::string, std::string>> changed;
  for (const auto& [path, value] : collect_leaf_values(now)) {
    const auto found = old.find(path);
    if (found == old.end() || found->second != value) changed.emplace_back(path, value);
  }
  return changed;
}

}  // namespace desert_sim
