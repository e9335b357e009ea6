#include "src/simulation/commands/command_yaml.hpp"

#include <yaml-cpp/binary.h>

#include <cstring>

#include "src/core/base64.hpp"
#include "src/scenario/wind_feature_lists.hpp"
#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

namespace {

template <class Item>
YAML::Node required(const YAML::Node& node, const char* key, const Item& source) {
  if (!node.IsMap() || !node[key]) throw ConfigError(source + ": the key '" + key + "' is missing");
  return node[key];
}

template <class T>
T scalar(const YAML::Node& node, const char* key, const std::string& source) {
  T value{};
  const YAML::Node found = required(node, key, source);
  if (!found.IsScalar() || !YAML::convert<T>::decode(found, value))
    throw ConfigError(source + ": " + key + ": " + yaml::node_text(found) + " cannot be read");
  return value;
}

template <class P>
P read_all(const YAML::Node& node, const std::string& source) {
  ValidationErrors errors(source);
  P parameters;
  std::set<std::string> known;
  yaml::read_parameters(node, "", errors, parameters, known);
  errors.throw_if_any();
  return parameters;
}

}  // namespace

void emit_regime(YAML::Emitter& out, const WindRegime& r) {
  yaml::emit_parameters(out, static_cast<const WindRegimeParameters&>(r));
  out << YAML::Key << "start_time" << YAML::Value << r.start_time;
  out << YAML::Key << "from" << YAML::Value << YAML::Flow << YAML::BeginSeq << r.initial_wind.x
      << r.initial_wind.y << YAML::EndSeq;
  out << YAML::Key << "segments" << YAML::Value << YAML::BeginSeq;
  for (const WindSegment& segment : r.segments) {
    out << YAML::Flow << YAML::BeginMap;
    yaml::emit_parameters(out, segment);
    out << YAML::EndMap;
  }
  out << YAML::EndSeq;
}

WindRegime read_regime(const YAML::Node& node, const std::string& source) {
  WindRegime r{read_all<WindRegimeParameters>(node, source)};
  r.start_time = scalar<double>(node, "start_time", source);
  const YAML::Node from = required(node, "from", source);
  if (!from.IsSequence() || from.size() != 2 || !YAML::convert<float>::decode(from[0], r.initial_wind.x) ||
      !YAML::convert<float>::decode(from[1], r.initial_wind.y))
    throw ConfigError(source + ": from: must be two numbers");
  for (const YAML::Node& segment : required(node, "segments", source))
    r.segments.push_back(read_all<WindSegment>(segment, source));
  ValidationErrors errors(source);
  check_wind_segments(r.regime, r.segments, "segments", errors);
  errors.throw_if_any();
  return r;
}

namespace {

/// The corners as x, y, x, y …
void emit_points(YAML::Emitter& out, const std::vector<command::Point>& points) {
  if (points.empty()) return;
  out << YAML::Key << "points" << YAML::Value << YAML::Flow << YAML::BeginSeq;
  for (const command::Point& p : points) out << p.x << p.y;
  out << YAML::EndSeq;
}

/// x, y, x, y …, or a list of pairs, as a person writes it.
std::vector<command::Point> read_points(const YAML::Node& node, const std::string& source) {
  const YAML::Node points = node["points"];
  if (!points) return {};
  constexpr std::size_t most = command::EditTerrain::max_points;
  const bool pairs = points.IsSequence() && points.size() > 0 && points[0].IsSequence();
  const std::size_t count = pairs ? points.size() : points.size() / 2;
  if (!points.IsSequence() || (!pairs && points.size() % 2 != 0) || count > most)
    throw ConfigError(source + ": points: must be x, y of at most " + std::to_string(most) + " points");
  std::vector<command::Point> places(count);
  for (std::size_t n = 0; n < count; ++n) {
    if (pairs && !(points[n].IsSequence() && points[n].size() == 2))
      throw ConfigError(source + ": points[" + std::to_string(n) + "]: " + yaml::node_text(points[n]) +
                        " is not a pair [x, y]");
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const YAML::Node number = pairs ? points[n][axis] : points[2 * n + axis];
      if (!YAML::convert<double>::decode(number, axis ? places[n].y : places[n].x))
        throw ConfigError(source + ": points[" + std::to_string(pairs ? n : 2 * n + axis) +
                          "]: " + yaml::node_text(number) + " is not a number");
    }
  }
  return places;
}

// ---- A command without its name. One whose table is complete needs nothing here.

template <class C>
struct Type {};

template <class C>
void emit(YAML::Emitter& out, const C& command) {
  yaml::emit_parameters(out, command);
}
template <class C>
C read(Type<C>, const YAML::Node& node, const std::string& source) {
  return read_all<C>(node, source);
}

/// Journals of versions before 3 have none.
std::string read_stroke(const YAML::Node& node, const std::string& source) {
  return node["stroke"] ? scalar<std::string>(node, "stroke", source) : "";
}
void emit_stroke(YAML::Emitter& out, const std::string& stroke) {
  out << YAML::Key << "stroke" << YAML::Value << YAML::DoubleQuoted << stroke;
}

void emit(YAML::Emitter& out, const command::SetWindSchedule& schedule) {
  emit_regime(out, schedule.regime);
  emit_stroke(out, schedule.stroke);
}
command::SetWindSchedule read(Type<command::SetWindSchedule>, const YAML::Node& node,
                              const std::string& source) {
  return {read_regime(node, source), read_stroke(node, source)};
}

/// Only what the operation uses: no other field has been checked.
void emit(YAML::Emitter& out, const command::EditWind& edit) {
  yaml::emit_parameters(out, edit);
  if (edit.operation == WindEdit::remove)
    out << YAML::Key << "id" << YAML::Value << edit.feature.id;
  else if (edit.operation != WindEdit::clear)
    emit_wind_feature(out, edit.feature);
}

WindFeature read_feature(const YAML::Node& node, const std::string& source) {
  WindFeature feature{read_all<WindFeatureParameters>(node, source), {}};
  ValidationErrors errors(source);
  read_wind_path(node["path"], "path", errors, feature.path);
  errors.throw_if_any();
  return feature;
}

command::EditWind read(Type<command::EditWind>, const YAML::Node& node, const std::string& source) {
  auto edit = read_all<command::EditWind>(node, source);
  if (edit.operation == WindEdit::remove)
    edit.feature.id = scalar<int>(node, "id", source);
  else if (edit.operation != WindEdit::clear)
    edit.feature = read_feature(node, source);
  return edit;
}

void emit(YAML::Emitter& out, const command::EditTerrain& edit) {
  yaml::emit_parameters(out, static_cast<const command::EditParameters&>(edit));
  emit_points(out, edit.points);
  if (!edit.patch.values.empty()) emit_patch(out, edit.patch);
}

command::Patch read_patch(const YAML::Node& node, const std::string& source) {
  command::Patch patch;
  patch.columns = scalar<int>(node, "patch_columns", source);
  patch.rows = scalar<int>(node, "patch_rows", source);
  const std::vector<unsigned char> bytes =
      decode_base64(scalar<std::string>(node, "patch", source), source + ": patch");
  if (patch.columns < 1 || patch.rows < 1 || patch.columns > command::Patch::max_pixels / patch.rows)
    throw ConfigError(source + ": patch: cannot have " + std::to_string(patch.columns) + " x " +
                      std::to_string(patch.rows) + " values");
  patch.values.resize(static_cast<std::size_t>(patch.columns) * static_cast<std::size_t>(patch.rows));
  if (bytes.size() != patch.values.size() * sizeof(float))
    throw ConfigError(source + ": patch: is not " + std::to_string(patch.values.size()) +
                      " values of 4 bytes in base64");
  std::memcpy(patch.values.data(), bytes.data(), bytes.size());
  return patch;
}

command::EditTerrain read(Type<command::EditTerrain>, const YAML::Node& node, const std::string& source) {
  command::EditTerrain edit{read_all<command::EditParameters>(node, source), {}, {}};
  edit.points = read_points(node, source);
  if (node["patch"]) edit.patch = read_patch(node, source);
  return edit;
}

void emit(YAML::Emitter& out, const command::EditPlants& edit) {
  yaml::emit_parameters(out, static_cast<const command::EditPlantsParameters&>(edit));
  emit_points(out, edit.points);
}
command::EditPlants read(Type<command::EditPlants>, const YAML::Node& node, const std::string& source) {
  return {read_all<command::EditPlantsParameters>(node, source), read_points(node, source)};
}

void emit_settings(YAML::Emitter& out, const std::vector<std::string>& settings) {
  out << YAML::Key << "settings" << YAML::Value << YAML::Flow << YAML::BeginSeq;
  for (const std::string& setting : settings) out << YAML::DoubleQuoted << setting;
  out << YAML::EndSeq;
}

std::vector<std::string> read_settings(const YAML::Node& node, const std::string& source) {
  const YAML::Node list = required(node, "settings", source);
  const char* const what = ": settings: must be a list of path=value";
  if (!list.IsSequence()) throw ConfigError(source + what);
  std::vector<std::string> settings;
  for (const YAML::Node& setting : list) {
    if (!setting.IsScalar()) throw ConfigError(source + what);
    settings.push_back(setting.Scalar());
  }
  return settings;
}

void emit(YAML::Emitter& out, const command::SetParameters& parameters) {
  emit_settings(out, parameters.settings);
  out << YAML::Key << "ramp" << YAML::Value << parameters.ramp;
  emit_stroke(out, parameters.stroke);
}
command::SetParameters read(Type<command::SetParameters>, const YAML::Node& node, const std::string& source) {
  return {read_settings(node, source), scalar<double>(node, "ramp", source), read_stroke(node, source)};
}

void emit(YAML::Emitter&, const command::Reset&) {}
command::Reset read(Type<command::Reset>, const YAML::Node&, const std::string&) { return {}; }

void emit(YAML::Emitter& out, const command::LoadCheckpoint& load) {
  out << YAML::Key << "path" << YAML::Value << YAML::DoubleQuoted << load.path;
  out << YAML::Key << "hash" << YAML::Value << load.hash;
}
command::LoadCheckpoint read(Type<command::LoadCheckpoint>, const YAML::Node& node,
                             const std::string& source) {
  return {scalar<std::string>(node, "path", source), scalar<std::uint64_t>(node, "hash", source)};
}

void emit(YAML::Emitter& out, const command::LoadScenario& load) {
  out << YAML::Key << "path" << YAML::Value << YAML::DoubleQuoted << load.path;
  out << YAML::Key << "terrain_only" << YAML::Value << load.terrain_only;
  out << YAML::Key << "hash" << YAML::Value << load.hash;
  out << YAML::Key << "fill_nodata" << YAML::Value << load.fill_nodata;
  if (!load.settings.empty()) emit_settings(out, load.settings);
  if (!load.yaml.empty()) out << YAML::Key << "yaml" << YAML::Value << YAML::DoubleQuoted << load.yaml;
}
command::LoadScenario read(Type<command::LoadScenario>, const YAML::Node& node, const std::string& source) {
  command::LoadScenario load{
      scalar<std::string>(node, "path", source), scalar<bool>(node, "terrain_only", source),
      scalar<std::uint64_t>(node, "hash", source), scalar<bool>(node, "fill_nodata", source)};
  if (node["settings"]) load.settings = read_settings(node, source);
  if (node["yaml"]) load.yaml = scalar<std::string>(node, "yaml", source);
  return load;
}

template <std::size_t N = 0>
Command read_named(const std::string& name, const YAML::Node& node, const std::string& source) {
  if constexpr (N < std::variant_size_v<Command>) {
    using C = std::variant_alternative_t<N, Command>;
    return name == C::name ? Command(read(Type<C>(), node, source)) : read_named<N + 1>(name, node, source);
  }
  throw ConfigError(source + ": unknown command '" + name + "'");
}

}  // namespace

void emit_patch(YAML::Emitter& out, const command::Patch& patch) {
  out << YAML::Key << "patch_columns" << YAML::Value << patch.columns;
  out << YAML::Key << "patch_rows" << YAML::Value << patch.rows;
  out << YAML::Key << "patch" << YAML::Value << YAML::DoubleQuoted
      << YAML::EncodeBase64(reinterpret_cast<const unsigned char*>(patch.values.data()),
                            patch.values.size() * sizeof(float));
}

void emit_command(YAML::Emitter& out, const Command& command) {
  std::visit(
      [&](const auto& one) {
        out << YAML::Key << "command" << YAML::Value << one.name;
        emit(out, one);
      },
      command);
}

Command read_command(const YAML::Node& node, const std::string& source) {
  return read_named(scalar<std::string>(node, "command", source), node, source);
}

}  // namespace desert_sim
