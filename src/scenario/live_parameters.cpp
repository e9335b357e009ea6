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
  std::set<std::string> paths;
  const Scenario defaults;
  visit_live_parameters(defaults, [&](const std::string& section, const ParameterRow& row,
                                      ConstParameterValue) { paths.insert(section + "." + row.name); });
  for (const Section* section : defaults.sections.all())
    if (section->list_name()) paths.insert(section->name() + "." + section->list_name());
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

void visit_live_parameters(const Scenario& scenario, const LiveParameterVisit& visit) {
  const auto of_section = [&](const std::string& section) -> ConstParameterVisit {
    return [&visit, section](const ParameterRow& row, ConstParameterValue value) {
      if (!fixed_reason(section + "." + row.name)) visit(section, row, value);
    };
  };
  for (const Section* section : scenario.sections.all()) section->visit(of_section(section->name()));
  visit_parameters(scenario.wind_regime, of_section("wind"));
  visit_parameters(scenario.wind, of_section("wind"));
  visit_parameters(scenario.run, of_section("run"));
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
