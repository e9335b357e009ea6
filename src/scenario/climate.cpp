#include "desert_sim/scenario/climate.hpp"

#include <algorithm>
#include <utility>

#include "desert_sim/scenario/yaml_parameters.hpp"

namespace desert_sim {

namespace {

constexpr std::pair<const char*, const char*> presets[] = {
#include "desert_sim/climates_presets.inc"
};

const char* text_of(const std::string& name) {
  for (const auto& [known, text] : presets)
    if (name == known) return text;
  return nullptr;
}

/// Maps are merged; anything else that is there stays.
void fill_in(YAML::Node scenario, const YAML::Node& climate) {
  for (const auto& entry : climate) {
    const std::string key = entry.first.Scalar();
    if (!scenario[key])
      scenario[key] = entry.second;
    else if (scenario[key].IsMap() && entry.second.IsMap())
      fill_in(scenario[key], entry.second);
  }
}

}  // namespace

std::vector<std::string> climates() {
  std::vector<std::string> names;
  for (const auto& preset : presets) names.push_back(preset.first);
  std::sort(names.begin(), names.end());
  return names;
}

std::string climate_doc(const std::string& name) {
  const std::string text = text_of(name);
  return text.substr(2, text.find('\n') - 2);  // without "# "
}

YAML::Node with_climate(const YAML::Node& root, Faults& faults) {
  const YAML::Node given = root["climate"];
  if (!given.IsDefined() || given.IsNull()) return root;
  const char* const text = given.IsScalar() ? text_of(given.Scalar()) : nullptr;
  if (!text) {
    std::string known;
    for (const std::string& name : climates()) known += (known.empty() ? "" : ", ") + name;
    faults.add("climate", "'" + yaml::shown(given) + "' is not one of: " + known);
    return root;
  }
  YAML::Node whole = YAML::Clone(root);
  const YAML::Node climate = YAML::Load(text);
  // A list of species comes with a matrix of its own.
  const bool own_species = root["species"].IsDefined();
  for (const auto& entry : climate) {
    const std::string key = entry.first.Scalar();
    if (own_species && (key == "species" || key == "competition")) continue;
    YAML::Node one(YAML::NodeType::Map);
    one[key] = entry.second;
    fill_in(whole, one);
  }
  return whole;
}

}  // namespace desert_sim
