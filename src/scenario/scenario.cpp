#include "src/scenario/scenario.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "src/core/did_you_mean.hpp"
#include "src/core/input_file.hpp"
#include "src/core/joined.hpp"
#include "src/scenario/climate.hpp"
#include "src/scenario/former_keys.hpp"
#include "src/scenario/growth_curves.hpp"
#include "src/scenario/range_checks.hpp"
#include "src/scenario/rover_class.hpp"
#include "src/scenario/sections.hpp"
#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

namespace {

constexpr std::uint64_t max_scenario_bytes = std::uint64_t{1} << 24;

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

template <class Item>
void read_items(const YAML::Node& list, const std::string& key, std::size_t most, ValidationErrors& errors,
                std::vector<Item>& items) {
  if (!list.IsDefined() || list.IsNull()) return;
  if (!list.IsSequence())
    return errors.add(key, yaml::node_text(list) + " is given where a list is expected");
  if (list.size() > most)
    return errors.add(key, std::to_string(list.size()) + " entries are given (allowed: at most " +
                               std::to_string(most) + ")");
  for (std::size_t n = 0; n < list.size(); ++n) {
    items.emplace_back();
    yaml::read_section(list[n], key + "." + std::to_string(n), errors, items.back());
  }
}

void read_wind(const YAML::Node& node, ValidationErrors& errors, Scenario& s) {
  std::set<std::string> known{"segments", "features"};
  yaml::read_parameters(node, "wind.", errors, s.wind_regime, known);
  yaml::read_parameters(node, "wind.", errors, s.wind, known);
  yaml::reject_unknown_keys(node, "wind.", known, errors);
  if (!node.IsDefined() || !node.IsMap()) return;
  read_items(node["segments"], "wind.segments", max_wind_segments, errors, s.wind_segments);
  read_items(node["features"], "wind.features", max_wind_features, errors, s.wind_features);
}

void read_water(const YAML::Node& node, ValidationErrors& errors, Scenario& s) {
  std::set<std::string> known{"springs"};
  yaml::read_parameters(node, "water.", errors, s.water, known);
  yaml::reject_unknown_keys(node, "water.", known, errors);
  if (node.IsDefined() && node.IsMap())
    read_items(node["springs"], "water.springs", max_springs, errors, s.springs);
}

void read_run(const YAML::Node& node, ValidationErrors& errors, Scenario& s) {
  std::set<std::string> known{"timeline"};
  yaml::read_parameters(node, "run.", errors, s.run, known);
  yaml::reject_unknown_keys(node, "run.", known, errors);
  if (node.IsDefined() && node.IsMap()) s.timeline = read_timeline(node["timeline"], errors);
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
  std::set<int> ids;
  for (std::size_t n = 0; n < s.wind_features.size(); ++n)
    if (const int id = s.wind_features[n].id; id != 0 && !ids.insert(id).second)
      errors.add("wind.features." + std::to_string(n) + ".id",
                 "= " + std::to_string(id) + " is already the id of another feature");
  if (s.wind_shadow.full_deg < s.wind_shadow.start_deg)
    errors.add("wind_shadow.full_deg", "must not be below start_deg");
  if (s.echo_dunes.sticky_reach < s.echo_dunes.erosion_reach)
    errors.add("echo_dunes.sticky_reach", "must not be below erosion_reach");
  for (std::size_t n = 0; n < s.terrain.size(); ++n)
    if (const auto* discs = std::get_if<DiscsStep>(&s.terrain[n]);
        discs && discs->radius_high < discs->radius_low)
      errors.add("terrain." + std::to_string(n) + ".discs.radius_high", "must not be below radius_low");
  constexpr double most_influx = 100;  // [m a step]; a few hundred of them would leave the range of heights
  const double cell = s.grid.cell_size > 0 ? static_cast<double>(s.grid.cell_size) : 1.0;
  const double influx = static_cast<double>(s.saltation.influx) * static_cast<double>(s.run.time_step) / cell;
  if (influx > most_influx) {
    std::ostringstream text;
    text << "= " << s.saltation.influx << " m^2/s brings " << influx
         << " m of sand to a cell of the edge in a step of " << s.run.time_step << " s (allowed: at most "
         << most_influx << " m)";
    errors.add("saltation.influx", text.str());
  }
}

void apply_setting(YAML::Node root, const std::string& setting) {
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos || equals == 0)
    throw ConfigError("--set '" + setting + "': must be path=value");
  const std::string path = setting.substr(0, equals);
  YAML::Node value;
  try {
    value = YAML::Load(setting.substr(equals + 1));
  } catch (const YAML::Exception& e) {
    throw ConfigError("--set '" + setting + "': " + e.msg);
  }
  YAML::Node node = root;
  std::size_t begin = 0;
  while (true) {
    const std::size_t dot = path.find('.', begin);
    const std::string key = path.substr(begin, dot == std::string::npos ? dot : dot - begin);
    const bool numeric = !key.empty() && key.find_first_not_of("0123456789") == std::string::npos;
    if (node.IsSequence() && (!numeric || key.size() > 6 || std::stoul(key) > node.size()))
      throw ConfigError("--set '" + setting + "': '" + key + "' is not an index into a list of " +
                        std::to_string(node.size()));
    if (node.IsScalar())
      throw ConfigError("--set '" + setting + "': there is no key below '" +
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

std::string parent_folder(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? "." : path.substr(0, slash + 1);
}

std::string base_name(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  const std::string file = slash == std::string::npos ? path : path.substr(slash + 1);
  return file.substr(0, file.rfind('.'));
}

}  // namespace

namespace {

Scenario parse_with_settings(const std::string& text, const std::string& source, const std::string& folder,
                             const Settings& settings) {
  YAML::Node root;
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.size() > 1)
      throw ConfigError(source + ": has " + std::to_string(documents.size()) +
                        " YAML documents, separated by --- (allowed: one)");
    if (!documents.empty()) root = documents.front();
  } catch (const YAML::Exception& e) {
    throw ConfigError(source + ": line " + std::to_string(e.mark.line + 1) + ": " + e.msg);
  }
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

}  // namespace

Scenario load_scenario(const std::string& path, const Settings& settings, const std::string& folder) {
  const InputFile file(path, folder);
  if (file.size() > max_scenario_bytes)
    throw ConfigError(path + ": has " + std::to_string(file.size()) + " bytes (allowed: at most " +
                      std::to_string(max_scenario_bytes) + ")");
  const std::string text = file.read_all();
  const bool saved = text.compare(0, std::strlen(saved_terrain_comment), saved_terrain_comment) == 0;
  Scenario s = parse_with_settings(saved ? migrated(text, path) : text, path, parent_folder(path), settings);
  s.name = base_name(path);
  return s;
}

Scenario parse_scenario_text(const std::string& yaml, const std::string& name, const Settings& settings) {
  return parse_with_settings(yaml, name, "", settings);
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
  std::set<std::string> known{"climate", "rover",   "terrain",     "wind",         "water",
                              "run",     "species", "competition", "growth_curves"};
  for_each_section(s, [&](const char* section, auto& parameters) {
    known.insert(section);
    yaml::read_section(root[section], section, errors, parameters);
  });
  for (const auto& [section, parameters] : s.process_sections.all()) {
    known.insert(section);
    parameters->read(root[section], section, errors);
  }
  SeedParameter seed{s.seed};
  yaml::read_parameters(root, "", errors, seed, known);
  s.seed = seed.seed;
  yaml::reject_unknown_keys(root, "", known, errors, path_that_is_meant);
  read_terrain(root["terrain"], errors, s.terrain);
  read_wind(root["wind"], errors, s);
  read_water(root["water"], errors, s);
  read_run(root["run"], errors, s);
  read_species(root, errors, s);
  s.growth_curves = read_growth_curves(root, errors);
  check_dependencies(s, errors);
  check_plants(s, errors);
  errors.throw_if_any();
  check_timeline(s, errors);  // it applies settings, which needs a valid scenario
  errors.throw_if_any();
  return s;
}

std::string dump_scenario(const Scenario& s) {
  YAML::Emitter out;
  yaml::set_full_precision(out);
  out << YAML::BeginMap;
  yaml::emit_parameters(out, SeedParameter{s.seed});
  for_each_section(s, [&](const char* section, const auto& parameters) {
    out << YAML::Key << section << YAML::Value << YAML::BeginMap;
    yaml::emit_parameters(out, parameters);
    out << YAML::EndMap;
  });
  for (const auto& [section, parameters] : s.process_sections.all()) {
    out << YAML::Key << section << YAML::Value << YAML::BeginMap;
    parameters->emit(out);
    out << YAML::EndMap;
  }
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
  const auto items = [&](const char* key, const auto& list) {
    out << YAML::Key << key << YAML::Value << YAML::BeginSeq;
    for (const auto& item : list) {
      out << YAML::Flow << YAML::BeginMap;
      yaml::emit_parameters(out, item);
      out << YAML::EndMap;
    }
    out << YAML::EndSeq;
  };
  items("segments", s.wind_segments);
  items("features", s.wind_features);
  out << YAML::EndMap << YAML::Key << "water" << YAML::Value << YAML::BeginMap;
  yaml::emit_parameters(out, s.water);
  items("springs", s.springs);
  out << YAML::EndMap << YAML::Key << "run" << YAML::Value << YAML::BeginMap;
  yaml::emit_parameters(out, s.run);
  emit_timeline(out, s.timeline);
  out << YAML::EndMap;
  emit_species(out, s);
  emit_growth_curves(out, s.growth_curves);
  out << YAML::EndMap;
  return out.c_str();
}

bool Scenario::has_water() const {
  return water.enabled || rain.rate > 0 || hydraulic_erosion.enabled || moisture.enabled || !springs.empty();
}

Grid Scenario::make_grid() const {
  const bool periodic = grid.boundary == Boundary::periodic;
  return Grid{grid.width, grid.height, static_cast<float>(grid.cell_size), periodic, periodic};
}

RasterField no_raster_loader(const RasterRequest& request) {
  throw ConfigError(request.path + ": this build cannot read rasters (it was built without GDAL)");
}

namespace {

/// The size of a grid that follows from its raster.
int cells_of(const char* key, double cells, const Scenario& s) {
  if (!(cells < max_grid_extent + 0.5))
    throw ConfigError(s.name + ": grid." + key + ": = " + std::to_string(std::llround(cells)) +
                      " cells by the raster " + s.grid.from_raster + ", is not in [1, " +
                      std::to_string(max_grid_extent) + "]; grid.cell_size makes it smaller");
  return std::max(1, static_cast<int>(std::lround(cells)));
}

}  // namespace

void resolve_grid(Scenario& s, const RasterLoader& load_raster) {
  GridParameters& g = s.grid;
  if (!g.from_raster.empty()) {
    RasterRequest request;
    request.path = raster_path(s, g.from_raster);
    const bool resampled = g.cell_size > 0;
    const RasterField raster = load_raster(request);
    const double cell = resampled ? g.cell_size : raster.cell_size;
    const double extent_x = raster.width * raster.cell_size, extent_y = raster.height * raster.cell_size;
    const bool sized = g.width > 0 || g.height > 0;
    if (g.width == 0) g.width = cells_of("width", extent_x / cell, s);
    if (g.height == 0) g.height = cells_of("height", extent_y / cell, s);
    if (g.origin_x == 0 && g.origin_y == 0) {
      // A grid whose size the scenario gives is centred on the raster.
      g.origin_x = raster.origin_x + (sized ? 0.5 * (extent_x - g.width * cell) : 0.0);
      g.origin_y = raster.origin_y + (sized ? 0.5 * (extent_y - g.height * cell) : 0.0);
    }
    g.cell_size = cell;
    s.projection = raster.projection;
  }
  if (g.width == 0) g.width = 256;
  if (g.height == 0) g.height = 256;
  if (g.cell_size == 0) g.cell_size = 1;
  const bool placed_by_raster = !g.from_raster.empty() && s.projection.empty();  // in degrees, perhaps
  check_ranges(g, s.name + ": grid" +  // a raster can have any size and place
                      (placed_by_raster ? " of " + g.from_raster + ", which declares no projection" : ""));
}

std::string raster_path(const Scenario& s, const std::string& file) {
  if (file.empty() || file[0] == '/') return file;
  const std::string beside =
      s.folder.empty() || s.folder.back() == '/' ? s.folder + file : s.folder + "/" + file;
  std::error_code error;
  return std::filesystem::exists(beside, error) ? beside : file;
}

std::vector<std::string> raster_paths(const Scenario& s) {
  std::vector<std::string> paths;
  if (!s.grid.from_raster.empty()) paths.push_back(raster_path(s, s.grid.from_raster));
  for (const TerrainStep& step : s.terrain)
    if (const auto* raster = std::get_if<RasterStep>(&step); raster && !raster->file.empty())
      paths.push_back(raster_path(s, raster->file));
  return paths;
}

}  // namespace desert_sim
