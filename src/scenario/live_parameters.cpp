#include "src/scenario/live_parameters.hpp"

#include <yaml-cpp/yaml.h>

#include <map>
#include <set>

#include "src/core/did_you_mean.hpp"
#include "src/core/joined.hpp"
#include "src/core/quoted.hpp"
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

void collect_leaf_values(const YAML::Node& node, const std::string& path, ParameterTexts& found) {
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

void remove_leaf(YAML::Node root, const std::string& path) {
  const std::size_t dot = path.find('.');
  if (dot == std::string::npos) {
    root.remove(path);
    return;
  }
  const YAML::Node section = root[path.substr(0, dot)];
  if (section.IsMap()) remove_leaf(section, path.substr(dot + 1));
}

/// What a scenario that was read anew cannot have from its text.
Scenario with_origin_of(Scenario scenario, const Scenario& origin) {
  scenario.name = origin.name;
  scenario.folder = origin.folder;
  scenario.projection = origin.projection;
  scenario.wind_series = origin.wind_series;
  return scenario;
}

/// Lists beside the sections that can change, whole or in part.
bool is_of_live_list(const std::string& path) {
  const std::string list = path.substr(0, path.find('.'));
  return list == "species" || list == "competition" || list == "growth_curves" || path == "run.timeline";
}

/// Species that settings have added compete by 1, like those of a scenario that says nothing of it.
void complete_competition(YAML::Node root, std::size_t species_before) {
  YAML::Node rows = root["competition"];
  const std::size_t count = root["species"].IsSequence() ? root["species"].size() : 0;
  if (!rows.IsSequence() || rows.size() != species_before || count <= species_before) return;
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t j = k < species_before ? species_before : 0; j < count; ++j) rows[k].push_back(1);
}

/// Plants refer to their species by its place.
void check_species_kept(const Scenario& before, const Scenario& changed, ValidationErrors& errors) {
  for (std::size_t n = 0; n < before.species.size(); ++n) {
    const std::string &name = before.species[n].name, key = "species." + std::to_string(n);
    if (n >= changed.species.size())
      errors.add(key, in_quotes(name) + " is missing, which plants may be of (allowed: more species)");
    else if (changed.species[n].name != name)
      errors.add(key + ".name", in_quotes(changed.species[n].name) + " would take the place of " +
                                    in_quotes(name) + ", which plants may be of (allowed: this name)");
  }
  if (before.get<VegetationParameters>().enabled && !changed.get<VegetationParameters>().enabled)
    errors.add("vegetation.enabled", "false would end the plants that live (allowed: true)");
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
    } else if (!live.count(path) && !is_of_live_list(path)) {
      errors.add(path,
                 "unknown parameter (config/parameters.md lists all)" + did_you_mean(path, joined(live)));
    }
  }
  errors.throw_if_any();
  YAML::Node root = YAML::Load(dump_scenario(scenario));
  for (const std::string& setting : settings) apply_setting(root, setting);
  complete_competition(root, scenario.species.size());
  Scenario changed = parse_scenario(root, "set_parameters", "");
  check_species_kept(scenario, changed, errors);
  errors.throw_if_any();
  return with_origin_of(std::move(changed), scenario);
}

ParameterTexts parameter_texts(const Scenario& scenario) {
  ParameterTexts texts;
  collect_leaf_values(YAML::Load(dump_scenario(scenario)), "", texts);
  return texts;
}

Scenario with_parameter_texts(const Scenario& scenario,
                              const std::map<std::string, std::optional<std::string>>& texts,
                              const std::string& what) {
  const YAML::Node root = YAML::Load(dump_scenario(scenario));
  for (const auto& [path, text] : texts) {
    if (text)
      apply_setting(root, path + "=" + *text);
    else
      remove_leaf(root, path);
  }
  return with_origin_of(parse_scenario(root, what, ""), scenario);
}

std::vector<std::pair<std::string, std::string>> changed_parameters(const Scenario& before,
                                                                    const Scenario& now) {
  const ParameterTexts old = parameter_texts(before);
  std::vector<std::pair<std::string, std::string>> changed;
  for (const auto& [path, value] : parameter_texts(now)) {
    const auto found = old.find(path);
    if (found == old.end() || found->second != value) changed.emplace_back(path, value);
  }
  return changed;
}

}  // namespace desert_sim
