#include "src/scenario/former_keys.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "src/core/error.hpp"
#include "src/core/quoted.hpp"
#include "src/scenario/yaml_text.hpp"

namespace desert_sim {

namespace {

struct FormerKey {
  const char* section;
  const char* key;
  std::string path() const { return std::string(section) + "." + key; }
};
/// The first that names a model counts: slabs and grains took the place of saltation.
constexpr FormerKey former_keys[] = {{"slab_model", "kind"}, {"particle", "kind"}, {"saltation", "model"}};

/// The section `micro_relief` was called `detail`.
constexpr const char *former_section = "detail", *present_section = "micro_relief";

/// The path of a parameter of that section, as it is now; empty for all others.
std::string renamed_path(const std::string& path) {
  const std::string prefix = std::string(former_section) + ".";
  return path.compare(0, prefix.size(), prefix) == 0
             ? std::string(present_section) + "." + path.substr(prefix.size())
             : "";
}

const FormerKey* find_former_key(const std::string& path) {
  const auto found = std::find_if(std::begin(former_keys), std::end(former_keys),
                                  [&](const FormerKey& former) { return former.path() == path; });
  return found == std::end(former_keys) ? nullptr : found;
}

/// What a scenario or a command says with former keys, in their order.
using FormerValues = std::array<std::optional<std::string>, std::size(former_keys)>;

/// The model that they name; none if they only say which do not move the sand.
std::optional<std::string> model_of(const FormerValues& values, const std::string& source) {
  const auto names_a_model = [](const std::optional<std::string>& value) {
    return value && *value != "none";
  };
  const auto& [slabs, grains, saltation] = values;
  if (names_a_model(slabs) && names_a_model(grains))
    throw ConfigError(source + ": particle.kind: " + *grains + " beside slab_model.kind = " + *slabs +
                      " (allowed: one model that moves the sand)");
  for (const auto& value : {slabs, grains})
    if (names_a_model(value)) return value;
  return saltation;
}

bool has_former_key(const YAML::Node& root, const FormerKey& former) {
  const YAML::Node section = root[former.section];
  return section.IsDefined() && section.IsMap() && section[former.key].IsDefined();
}

FormerValues values_in(const YAML::Node& root) {
  FormerValues values;
  for (std::size_t n = 0; n < values.size(); ++n)
    if (const FormerKey& former = former_keys[n]; has_former_key(root, former)) {
      const YAML::Node value = root[former.section][former.key];
      values[n] = value.IsScalar() ? value.Scalar() : "?";
    }
  return values;
}

/// The maps `set` of run.timeline.
std::vector<YAML::Node> timeline_settings(const YAML::Node& root) {
  std::vector<YAML::Node> maps;
  const YAML::Node run = root["run"];
  if (!run.IsDefined() || !run.IsMap() || !run["timeline"].IsDefined() || !run["timeline"].IsSequence())
    return maps;
  for (const YAML::Node& entry : run["timeline"])
    if (entry.IsMap() && entry["set"].IsDefined() && entry["set"].IsMap()) maps.push_back(entry["set"]);
  return maps;
}

/// Those of the former section among the paths of a map `set`.
std::vector<std::string> renamed_paths(const YAML::Node& settings) {
  std::vector<std::string> paths;
  for (const auto& entry : settings)
    if (!renamed_path(entry.first.Scalar()).empty()) paths.push_back(entry.first.Scalar());
  return paths;
}

bool is_none(const YAML::Node& value) { return value.IsScalar() && value.Scalar() == "none"; }

}  // namespace

std::string instead_of_former_key(const std::string& setting) {
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos) return "";
  if (const std::string now = renamed_path(setting.substr(0, equals)); !now.empty())
    return "is now " + now + "; write " + shortened(now + setting.substr(equals)) +
           "; desert_run --migrate FILE rewrites a file";
  if (!find_former_key(setting.substr(0, equals))) return "";
  const std::string value = setting.substr(equals + 1);
  return "is now sand.model; write sand.model=" + shortened(value == "none" ? "hops" : value) +
         " (in a file: sand: {model: " + shortened(value == "none" ? "hops" : value) +
         "}; desert_run --migrate FILE rewrites one)";
}

YAML::Node refuse_former_keys(const YAML::Node& given, ValidationErrors& errors) {
  const FormerValues values = values_in(given);
  YAML::Node root = given;
  for (std::size_t n = 0; n < values.size(); ++n) {
    if (!values[n]) continue;
    const FormerKey& former = former_keys[n];
    errors.add(former.path(), instead_of_former_key(former.path() + "=" + *values[n]));
    if (root == given) root.reset(YAML::Clone(given));
    root[former.section].remove(former.key);
  }
  if (!root[former_section].IsDefined()) return root;
  errors.add(former_section, std::string("is now the section ") + present_section +
                                 "; desert_run --migrate FILE rewrites a file");
  if (root == given) root.reset(YAML::Clone(given));
  root.remove(former_section);
  return root;
}

YAML::Node without_former_keys(const YAML::Node& given, const std::string& source) {
  YAML::Node root = YAML::Clone(given);
  if (!root.IsMap()) return root;
  const std::optional<std::string> model = model_of(values_in(root), source);
  for (const FormerKey& former : former_keys)
    if (has_former_key(root, former)) root[former.section].remove(former.key);
  if (model) root["sand"]["model"] = *model;
  if (root[former_section].IsDefined()) {
    if (root[present_section].IsDefined())
      throw ConfigError(source + ": " + former_section + ": is given beside " + present_section +
                        ", which is its present name (allowed: one of them)");
    root[present_section] = root[former_section];
    root.remove(former_section);
  }
  for (YAML::Node settings : timeline_settings(root)) {
    for (const std::string& path : renamed_paths(settings)) {
      settings[renamed_path(path)] = settings[path];
      settings.remove(path);
    }
    for (const FormerKey& former : former_keys) {
      const YAML::Node value = settings[former.path()];
      if (!value.IsDefined()) continue;
      settings["sand.model"] = is_none(value) ? YAML::Node("hops") : YAML::Clone(value);
      settings.remove(former.path());
    }
  }
  return root;
}

Settings without_former_keys(const Settings& settings, SandModel present, const std::string& source) {
  FormerValues values;
  Settings kept;
  for (const std::string& setting : settings) {
    const std::size_t equals = std::min(setting.find('='), setting.size());
    const std::string path = setting.substr(0, equals), now = renamed_path(path);
    if (const FormerKey* former = find_former_key(path))
      values[static_cast<std::size_t>(former - former_keys)] =
          setting.substr(std::min(equals + 1, setting.size()));
    else
      kept.push_back(now.empty() ? setting : now + setting.substr(equals));
  }
  if (kept.size() == settings.size()) return kept;
  const FormerValues before{is_slab_model(present) ? name_of(present) : "none",
                            present == SandModel::wang ? name_of(present) : "none",
                            name_of(is_saltation(present) ? present : SandModel::hops)};
  for (std::size_t n = 0; n < values.size(); ++n)
    if (!values[n]) values[n] = before[n];
  kept.push_back("sand.model=" + *model_of(values, source));
  return kept;
}

// ---- The text of a file.

namespace {

using yaml_text::Change;
using yaml_text::key_of;
using yaml_text::MarkedText;

/// What makes a section of its only entry.
std::vector<Change> renaming(const MarkedText& text, const YAML::Node& root, const FormerKey& former,
                             const std::string& model) {
  const YAML::Node section = root[former.section];
  const std::size_t name = text.at(key_of(root, former.section).Mark()),
                    key = text.at(key_of(section, former.key).Mark()),
                    value = text.at(section[former.key].Mark());
  const std::size_t length = section[former.key].Scalar().size();
  return {{name, name + std::string(former.section).size(), "sand"},
          {key, key + std::string(former.key).size(), "model"},
          {value, value + length, model}};
}

std::vector<Change> changes_of(const MarkedText& text, const YAML::Node& root, const std::string& source) {
  std::vector<Change> changes;
  std::optional<std::string> model = model_of(values_in(root), source);
  const bool has_section = root["sand"].IsDefined();
  for (const FormerKey& former : former_keys) {
    if (!has_former_key(root, former)) continue;
    const YAML::Node section = root[former.section];
    const std::size_t name = text.at(key_of(root, former.section).Mark());
    const bool counts = model && section[former.key].Scalar() == *model && !has_section;
    if (section.size() == 1 && counts) {
      for (const Change& change : renaming(text, root, former, *model)) changes.push_back(change);
      model.reset();
      continue;
    }
    if (section.size() == 1) {  // it switches off what nothing else is said of
      changes.push_back(yaml_text::without_line(text, name, text.at(section[former.key].Mark())));
      continue;
    }
    changes.push_back(yaml_text::removal(text, section, former.key));
    if (!counts) continue;
    const bool flow = root.Style() == YAML::EmitterStyle::Flow;
    const std::string end = flow ? ", " : "\n" + yaml_text::indentation(text, name);
    changes.push_back({name, name, "sand: {model: " + *model + "}" + end});
    model.reset();
  }
  const auto rename = [&](const YAML::Node& map, const std::string& key, const std::string& now) {
    const std::size_t at = text.at(key_of(map, key).Mark());
    changes.push_back({at, at + key.size(), now});
  };
  if (root[former_section].IsDefined()) rename(root, former_section, present_section);
  for (const YAML::Node& settings : timeline_settings(root)) {
    for (const std::string& path : renamed_paths(settings)) rename(settings, path, renamed_path(path));
    for (const FormerKey& former : former_keys) {
      if (!settings[former.path()].IsDefined()) continue;
      rename(settings, former.path(), "sand.model");
      const YAML::Node value = settings[former.path()];
      const std::size_t at = text.at(value.Mark());
      if (is_none(value)) changes.push_back({at, at + value.Scalar().size(), "hops"});
    }
  }
  return changes;
}

/// Sections that have become empty say nothing.
YAML::Node without_empty_sections(const YAML::Node& root) {
  YAML::Node kept(YAML::NodeType::Map);
  for (const auto& entry : root)
    if (!(entry.second.IsMap() && entry.second.size() == 0)) kept[entry.first.Scalar()] = entry.second;
  return kept;
}

}  // namespace

std::string migrated(const std::string& given, const std::string& source) {
  const std::string byte_order_mark = "\xEF\xBB\xBF";
  const bool marked = given.compare(0, byte_order_mark.size(), byte_order_mark) == 0;
  const MarkedText text(marked ? given.substr(byte_order_mark.size()) : given);
  const YAML::Node root = yaml_text::parse(text.text(), source);
  if (!root.IsMap()) return given;
  const std::string changed = text.with(changes_of(text, root, source));
  const YAML::Node wanted = without_empty_sections(without_former_keys(root, source));
  if (!yaml_text::same(wanted, without_empty_sections(yaml_text::parse(changed, source))))
    throw ConfigError(
        source +
        ": cannot be rewritten; write sand: {model: ...} in the place of "
        "slab_model.kind, particle.kind and saltation.model, and micro_relief in that of detail, "
        "by hand");
  return (marked ? byte_order_mark : "") + changed;
}

}  // namespace desert_sim
