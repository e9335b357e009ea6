#include "desert_sim/simulation/command_yaml.hpp"

#include "desert_sim/scenario/yaml_parameters.hpp"

namespace desert_sim {

namespace {

template <class Item>
YAML::Node required(const YAML::Node& node, const char* key, const Item& source) {
  if (!node.IsMap() || !node[key]) throw ConfigError(source + ": there is no '" + key + "'");
  return node[key];
}

template <class T>
T scalar(const YAML::Node& node, const char* key, const std::string& source) {
  T value{};
  const YAML::Node found = required(node, key, source);
  if (!found.IsScalar() || !YAML::convert<T>::decode(found, value))
    throw ConfigError(source + ": " + key + ": " + yaml::shown(found) + " cannot be read");
  return value;
}

template <class P>
P read_all(const YAML::Node& node, const std::string& source) {
  Faults faults(source);
  P parameters;
  std::set<std::string> known;
  yaml::read_parameters(node, "", faults, parameters, known);
  faults.throw_if_any();
  return parameters;
}

command::SetParameters read_settings(const YAML::Node& node, const std::string& source) {
  command::SetParameters command;
  const YAML::Node settings = required(node, "settings", source);
  if (!settings.IsSequence()) throw ConfigError(source + ": settings: must be a list of path=value");
  for (const YAML::Node& setting : settings) {
    if (!setting.IsScalar()) throw ConfigError(source + ": settings: must be a list of path=value");
    command.settings.push_back(setting.Scalar());
  }
  return command;
}

}  // namespace

void emit_regime(YAML::Emitter& out, const WindRegime& r) {
  yaml::emit_parameters(out, static_cast<const WindRegimeParameters&>(r));
  out << YAML::Key << "start_time" << YAML::Value << r.start_time;
  out << YAML::Key << "from" << YAML::Value << YAML::Flow << YAML::BeginSeq << r.from.x << r.from.y
      << YAML::EndSeq;
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
  if (!from.IsSequence() || from.size() != 2 || !YAML::convert<float>::decode(from[0], r.from.x) ||
      !YAML::convert<float>::decode(from[1], r.from.y))
    throw ConfigError(source + ": from: must be two numbers");
  for (const YAML::Node& segment : required(node, "segments", source))
    r.segments.push_back(read_all<WindSegment>(segment, source));
  if (r.regime != WindRegimeKind::constant && r.segments.empty())
    throw ConfigError(source + ": segments: there is none");
  return r;
}

void emit_command(YAML::Emitter& out, const Command& command) {
  const auto name = [&](const char* text) { out << YAML::Key << "command" << YAML::Value << text; };
  if (const auto* set_wind = std::get_if<command::SetWind>(&command)) {
    name("set_wind");
    yaml::emit_parameters(out, *set_wind);
  } else if (const auto* schedule = std::get_if<command::SetWindSchedule>(&command)) {
    name("set_wind_schedule");
    emit_regime(out, schedule->regime);
  } else if (const auto* edit = std::get_if<command::EditTerrain>(&command)) {
    name("edit_terrain");
    yaml::emit_parameters(out, *edit);
  } else if (const auto* parameters = std::get_if<command::SetParameters>(&command)) {
    name("set_parameters");
    out << YAML::Key << "settings" << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (const std::string& setting : parameters->settings) out << YAML::DoubleQuoted << setting;
    out << YAML::EndSeq;
  } else if (std::holds_alternative<command::Reset>(command)) {
    name("reset");
  } else if (const auto* load = std::get_if<command::LoadCheckpoint>(&command)) {
    name("load_checkpoint");
    out << YAML::Key << "path" << YAML::Value << YAML::DoubleQuoted << load->path;
    out << YAML::Key << "hash" << YAML::Value << load->hash;
  }
}

Command read_command(const YAML::Node& node, const std::string& source) {
  const auto name = scalar<std::string>(node, "command", source);
  if (name == "set_wind") return read_all<command::SetWind>(node, source);
  if (name == "set_wind_schedule") return command::SetWindSchedule{read_regime(node, source)};
  if (name == "edit_terrain") return read_all<command::EditTerrain>(node, source);
  if (name == "set_parameters") return read_settings(node, source);
  if (name == "reset") return command::Reset{};
  if (name == "load_checkpoint")
    return command::LoadCheckpoint{scalar<std::string>(node, "path", source),
                                   scalar<std::uint64_t>(node, "hash", source)};
  throw ConfigError(source + ": unknown command '" + name + "'");
}

}  // namespace desert_sim
