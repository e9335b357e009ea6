#include "src/scenario/rover_presets.hpp"

#include "src/core/did_you_mean.hpp"
#include "src/core/joined.hpp"
#include "src/scenario/presets.hpp"
#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

namespace {

constexpr Presets::Row class_rows[] = {
#include "desert_sim/rovers_presets.inc"
};
constexpr Presets classes(class_rows);

}  // namespace

std::vector<std::string> rover_presets() { return classes.names(); }

std::string rover_preset_text(const std::string& name) {
  const char* const text = classes.text(name);
  if (!text) throw ConfigError("rover: " + not_one_of(name, joined(classes.names())));
  return text;
}

std::string rover_preset_doc(const std::string& name) {
  const std::string text = rover_preset_text(name);
  return text.substr(2, text.find('\n') - 2);  // skips the leading "# "
}

YAML::Node apply_rover(const YAML::Node& root, ValidationErrors& errors) {
  const YAML::Node given = root["rover"];
  if (!given.IsDefined() || given.IsNull()) return root;
  const char* const text = given.IsScalar() ? classes.text(given.Scalar()) : nullptr;
  if (!text) {
    errors.add("rover", not_one_of(yaml::node_text(given), joined(classes.names())));
    return root;
  }
  YAML::Node whole = YAML::Clone(root), section(YAML::NodeType::Map);
  section["traversability"] = YAML::Load(text)["traversability"];
  yaml::merge_missing(whole, section);
  return whole;
}

}  // namespace desert_sim
