#include "src/scenario/climate.hpp"

#include "src/core/did_you_mean.hpp"
#include "src/core/joined.hpp"
#include "src/scenario/presets.hpp"
#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

namespace {

constexpr Presets::Row climate_preset_rows[] = {
#include "desert_sim/climates_presets.inc"
};
constexpr Presets climate_presets(climate_preset_rows);

}  // namespace

std::vector<std::string> climates() { return climate_presets.names(); }

std::string climate_doc(const std::string& name) {
  const std::string text = climate_presets.text(name);
  return text.substr(2, text.find('\n') - 2);  // skips the leading "# "
}

YAML::Node apply_climate(const YAML::Node& root, ValidationErrors& errors) {
  const YAML::Node given = root["climate"];
  if (!given.IsDefined() || given.IsNull()) return root;
  const char* const text = given.IsScalar() ? climate_presets.text(given.Scalar()) : nullptr;
  if (!text) {
    errors.add("climate", not_one_of(yaml::node_text(given), joined(climate_presets.names())));
    return root;
  }
  YAML::Node whole = YAML::Clone(root);
  const YAML::Node climate = YAML::Load(text);
  // A scenario with its own list of species does not use the climate's competition matrix either.
  const bool own_species = root["species"].IsDefined();
  for (const auto& entry : climate) {
    const std::string key = entry.first.Scalar();
    if (own_species && (key == "species" || key == "competition")) continue;
    YAML::Node one(YAML::NodeType::Map);
    one[key] = entry.second;
    yaml::merge_missing(whole, one);
  }
  return whole;
}

}  // namespace desert_sim
