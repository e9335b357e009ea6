#include "src/scenario/scenario.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>

#include "kernels/field/layers.hpp"
#include "src/core/did_you_mean.hpp"
#include "src/core/input_file.hpp"
#include "src/core/joined.hpp"
#include "src/scenario/climate.hpp"
#include "src/scenario/former_keys.hpp"
#include "src/scenario/growth_curves.hpp"
#include "src/scenario/rover_presets.hpp"
#include "src/scenario/scenario_names.hpp"
#include "src/scenario/seed_parameter.hpp"
#include "src/scenario/wind_feature_lists.hpp"
#include "src/scenario/yaml_document.hpp"
#include "src/scenario/yaml_lists.hpp"
#include "src/scenario/yaml_text.hpp"

namespace desert_sim {

namespace {

/// Checks that `layer` of a terrain step names a persistent layer.
template <class Step>
void check_layer(const Step& step, const std::string& key, ValidationErrors& errors) {
  if constexpr (!std::is_same_v<Step, ObstacleStep>) {
    std::vector<std::string> known;
    for (const LayerInfo& layer : layer_table)
      if (layer.lifetime == Lifetime::persistent) known.emplace_back(layer.name);
    if (std::find(known.begin(), known.end(), step.layer) != known.end()) return;
    errors.add(key + ".layer", not_one_of(step.layer, joined(known)));
  }
}

template <std::size_t N = 0>
bool read_step(const std::string& name, const YAML::Node& node, const std::string& key,
               ValidationErrors& errors, std::vector<TerrainStep>& steps) {
  if constexpr (N < std::variant_size_v<TerrainStep>) {
    if (name != terrain_step_names[N]) return read_step<N + 1>(name, node, key, errors, steps);
    std::variant_alternative_t<N, TerrainStep> step;
    yaml::read_section(node, key, errors, step);
    check_layer(step, key, errors);
    steps.push_back(step);
    return true;
  }
  return false;
}

void read_terrain(const YAML::Node& list, ValidationErrors& errors, std::vector<TerrainStep>& steps) {
  if (!list.IsDefined() || list.IsNull()) return;
  if (!list.IsSequence())
    return errors.add("terrain", yaml::node_text(list) + " is given where a list of steps is expected");
  for (std::size_t n = 0; n < list.size(); ++n) {
    const std::string key = "terrain." + std::to_string(n);
    if (!list[n].IsMap() || list[n].size() != 1) {
      errors.add(key, "must be one step with its parameters, such as  - uniform: {layer: sand, value: 1}");
      continue;
    }
    const auto entry = *list[n].begin();
    const std::string name = entry.first.IsScalar() ? entry.first.Scalar() : "?";
    const std::string known = joined(terrain_step_names);
    if (!read_step(name, entry.second, key + "." + name, errors, steps))
      errors.add(key, "unknown step '" + name + "' (known: " + known + ")" + did_you_mean(name, known));
  }
}

void read_wind(const YAML::Node& node, ValidationErrors& errors, Scenario& s) {
  std::set<std::string> known{"segments", "features"};
  yaml::read_parameters(node, "wind.", errors, s.wind_regime, known);
  yaml::read_parameters(node, "wind.", errors, s.wind, known);
  yaml::reject_unknown_keys(node, "wind.", known, errors);
  if (!node.IsDefined() || !node.IsMap()) return;
  yaml::read_items(node["segments"], "wind.segments", max_wind_segments, errors, s.wind_segments);
  read_wind_features(node["features"], "wind.features", errors, s.wind_features);
}

void read_run(const YAML::Node& node, ValidationErrors& errors, Scenario& s) {
  std::set<std::string> known{"timeline"};
  yaml::read_parameters(node, "run.", errors, s.run, known);
  yaml::reject_unknown_keys(node, "run.", known, errors);
  if (node.IsDefined() && node.IsMap()) s.timeline = read_timeline(node["timeline"], "run.timeline", errors);
}

/// Checks conditions that involve more than one parameter.
void check_dependencies(const Scenario& s, ValidationErrors& errors) {
  if (s.wind.radii.count != s.wind.weights.count || s.wind.radii.count != s.wind.deflections.count)
    errors.add("wind.radii", "radii, weights and deflections must be lists of the same length");
  float weight = 0;
  for (int n = 0; n < s.wind.weights.count; ++n) weight += s.wind.weights.values[n];
  if (!(weight > 0)) errors.add("wind.weights", "must not all be 0");
  check_wind_segments(s.wind_regime.regime, s.wind_segments, "wind.segments", errors);
  if (s.wind_regime.regime == WindRegimeKind::series && s.wind_regime.series_file.empty())
    errors.add("wind.series_file", "is missing, which the regime 'series' needs");
  if (!s.run.start_from.empty() && !(s.terrain.empty() && s.grid.from_raster.empty()))
    errors.add(s.terrain.empty() ? "grid.from_raster" : "terrain",
               "is given, but run.start_from has the start (allowed: one of both)");
  std::set<int> ids;
  for (std::size_t n = 0; n < s.wind_features.size(); ++n)
    if (const int id = s.wind_features[n].id; id != 0 && !ids.insert(id).second)
      errors.add("wind.features." + std::to_string(n) + ".id",
                 std::to_string(id) + " is already the id of another feature");
  for (std::size_t n = 0; n < s.wind_features.size(); ++n)
    check_wind_feature(s.wind_features[n], "wind.features." + std::to_string(n) + ".", errors);
  for (std::size_t n = 0; n < s.terrain.size(); ++n)
    if (const auto* discs = std::get_if<DiscsStep>(&s.terrain[n]);
        discs && discs->radius_high < discs->radius_low)
      errors.add("terrain." + std::to_string(n) + ".discs.radius_high", "must not be below radius_low");
}

}  // namespace

void apply_setting(YAML::Node root, const std::string& setting) {
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos || equals == 0)
    throw ConfigError("setting '" + setting + "': must be path=value");
  const std::string path = setting.substr(0, equals);
  YAML::Node value;
  try {
    value = yaml::load_document(setting.substr(equals + 1));
  } catch (const YAML::Exception& e) {
    throw ConfigError("setting '" + setting + "': " + e.msg);
  }
  YAML::Node node = root;
  std::size_t begin = 0;
  while (true) {
    const std::size_t dot = path.find('.', begin);
    const std::string key = path.substr(begin, dot == std::string::npos ? dot : dot - begin);
    const bool numeric = !key.empty() && key.find_first_not_of("0123456789") == std::string::npos;
    if (node.IsSequence() && (!numeric || key.size() > 6 || std::stoul(key) > node.size()))
      throw ConfigError("setting '" + setting + "': '" + key + "' is not an index into a list of " +
                        std::to_string(node.size()));
    if (node.IsScalar())
      throw ConfigError("setting '" + setting + "': there is no key below '" +
                        path.substr(0, begin ? begin - 1 : 0) + "'");
    YAML::Node next = node.IsSequence() ? node[std::stoul(key)] : node[key];
    if (dot == std::string::npos) {
      next = value;
      return;
    }
    node.reset(next);
    begin = dot + 1;
  }
}

Scenario parse_with_settings(const std::string& text, const std::string& source, const std::string& folder,
                             const Settings& settings) {
  YAML::Node root = yaml_text::parse(text, source);
  if (root.IsNull()) root = YAML::Node(YAML::NodeType::Map);
  if (root.IsMap())
    for (const std::string& setting : settings) apply_setting(root, setting);
  return parse_scenario(root, source, folder);
}

/// Of a key beside the sections that is a parameter's own, or has another sign for the dot: its path.
std::string path_that_is_meant(const std::string& key) {
  std::set<std::string> paths, with_this_key;
  for (const auto& section : YAML::Load(dump_scenario(Scenario()))) {
    if (!section.second.IsMap()) continue;
    for (const auto& entry : section.second) {
      const std::string path = section.first.Scalar() + "." + entry.first.Scalar();
      paths.insert(path);
      if (entry.first.Scalar() == key) with_this_key.insert(path);
    }
  }
  if (with_this_key.empty()) return did_you_mean(key, joined(paths));
  return with_this_key.size() > 3 ? "" : "; did you mean " + joined(with_this_key) + "?";
}

std::string parent_folder(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? "." : path.substr(0, slash + 1);
}

std::string base_name(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  const std::string file = slash == std::string::npos ? path : path.substr(slash + 1);
  return file.substr(0, file.rfind('.'));
}

Scenario load_scenario(const std::string& path, const Settings& settings, const std::string& folder) {
  const InputFile file(path, folder);
  if (file.size() > max_scenario_bytes)
    throw ConfigError(path + ": has " + std::to_string(file.size()) + " bytes (allowed: at most " +
                      std::to_string(max_scenario_bytes) + ")");
  const std::string text = file.read_all();
  const auto begins_with = [&text](const char* start) { return text.rfind(start, 0) == 0; };
  const bool saved = begins_with(saved_terrain_comment) || begins_with(saved_scenario_comment);
  Scenario s = parse_with_settings(saved ? migrated(text, path) : text, path, parent_folder(path), settings);
  s.name = base_name(path);
  // All files of scenarios that were saved with their state have one name; those of their folders differ.
  if (begins_with(saved_scenario_comment) && std::filesystem::path(path).filename() == saved_scenario_file)
    s.name = std::filesystem::absolute(path).lexically_normal().parent_path().filename().string();
  return s;
}

Scenario parse_scenario_text(const std::string& yaml, const std::string& name, const Settings& settings,
                             const std::string& folder) {
  return parse_with_settings(yaml, name, folder, settings);
}

Scenario parse_scenario(const YAML::Node& given, const std::string& name, const std::string& folder) {
  ValidationErrors errors(name);
  Scenario s;
  s.name = name;
  s.folder = folder;
  if (!given.IsMap()) {
    errors.add("top level",
               yaml::node_text(given) + " is given where the sections of a scenario are expected");
    errors.throw_if_any();
  }
  const YAML::Node root = refuse_former_keys(apply_rover(apply_climate(given, errors), errors), errors);
  std::set<std::string> known{"climate", "rover",   "grid",        "terrain",      "wind",
                              "run",     "species", "competition", "growth_curves"};
  yaml::read_section(root["grid"], "grid", errors, s.grid);
  for (Section* section : s.sections.all()) {
    known.insert(section->name());
    section->read(root[section->name()], errors);
  }
  SeedParameter seed{s.seed};
  yaml::read_parameters(root, "", errors, seed, known);
  s.seed = seed.seed;
  yaml::reject_unknown_keys(root, "", known, errors, path_that_is_meant);
  read_terrain(root["terrain"], errors, s.terrain);
  read_wind(root["wind"], errors, s);
  read_run(root["run"], errors, s);
  read_species(root, errors, s);
  s.growth_curves = read_growth_curves(root, errors);
  check_dependencies(s, errors);
  check_species(s, errors);
  check_sections(s, errors);
  errors.throw_if_any();
  check_timeline(s, s.timeline, "run.timeline", errors);  // it applies settings, which needs a valid scenario
  errors.throw_if_any();
  return s;
}

std::string dump_scenario(const Scenario& s) {
  YAML::Emitter out;
  yaml::set_full_precision(out);
  out << YAML::BeginMap;
  yaml::emit_parameters(out, SeedParameter{s.seed});
  out << YAML::Key << "grid" << YAML::Value << YAML::BeginMap;
  yaml::emit_parameters(out, s.grid);
  out << YAML::EndMap;
  for (const Section* section : s.sections.all()) section->emit(out);
  out << YAML::Key << "terrain" << YAML::Value << YAML::BeginSeq;
  for (const TerrainStep& step : s.terrain) {
    out << YAML::Flow << YAML::BeginMap << YAML::Key << terrain_step_names[step.index()] << YAML::Value
        << YAML::BeginMap;
    std::visit([&](const auto& parameters) { yaml::emit_parameters(out, parameters); }, step);
    out << YAML::EndMap << YAML::EndMap;
  }
  out << YAML::EndSeq << YAML::Key << "wind" << YAML::Value << YAML::BeginMap;
  yaml::emit_parameters(out, s.wind_regime);
  yaml::emit_parameters(out, s.wind);
  yaml::emit_items(out, "segments", s.wind_segments);
  emit_wind_features(out, s.wind_features);
  out << YAML::EndMap << YAML::Key << "run" << YAML::Value << YAML::BeginMap;
  yaml::emit_parameters(out, s.run);
  emit_timeline(out, s.timeline);
  out << YAML::EndMap;
  emit_species(out, s);
  emit_growth_curves(out, s.growth_curves);
  out << YAML::EndMap;
  return out.c_str();
}

Grid Scenario::make_grid() const {
  const bool periodic = grid.boundary == Boundary::periodic;
  return Grid{grid.width, grid.height, static_cast<float>(grid.cell_size), periodic, periodic};
}

}  // namespace desert_sim
