#include "src/simulation/editing/timed_commands.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>

#include "src/core/did_you_mean.hpp"
#include "src/core/joined.hpp"
#include "src/core/number_text.hpp"
#include "src/core/validation_errors.hpp"
#include "src/scenario/range_checks.hpp"
#include "src/scenario/yaml_parameters.hpp"
#include "src/simulation/commands/command_yaml.hpp"
#include "src/simulation/commands/edit_checks.hpp"
#include "src/simulation/commands/timed_command_names.hpp"
#include "src/simulation/editing/commands.hpp"
#include "src/simulation/editing/plant_edit.hpp"

namespace desert_sim {

namespace {

void require_timed(const YAML::Node& given) {
  const std::string name = given["command"].IsScalar() ? given["command"].Scalar() : "?";
  const auto is = [&name](const char* known) { return name == known; };
  if (std::any_of(std::begin(timed_command_names), std::end(timed_command_names), is)) return;
  throw ConfigError("command: " + not_one_of(name, joined(timed_command_names)) +
                    (name == command::SetParameters::name ? "; write set: {path: value}" : ""));
}

/// Adds an error for each key of `given` that a command as it is written does not have, lists of maps
/// included.
void reject_keys_not_in(const YAML::Node& written, const YAML::Node& given, const std::string& path,
                        ValidationErrors& errors) {
  if (given.IsMap() && written.IsMap()) {
    std::set<std::string> known;
    for (const auto& entry : written) known.insert(entry.first.Scalar());
    yaml::reject_unknown_keys(given, path, known, errors);
    for (const auto& entry : given)
      if (const YAML::Node other = written[entry.first.Scalar()]; other.IsDefined())
        reject_keys_not_in(other, entry.second, path + entry.first.Scalar() + ".", errors);
  } else if (given.IsSequence() && written.IsSequence()) {
    for (std::size_t n = 0; n < std::min(given.size(), written.size()); ++n)
      reject_keys_not_in(written[n], given[n], path + std::to_string(n) + ".", errors);
  }
}

/// When a regime begins, and from which wind, is known when it is due.
YAML::Node with_beginning(YAML::Node given) {
  if (given["command"].Scalar() != command::SetWindSchedule::name) return given;
  for (const char* const key : {"start_time", "from"})
    if (given[key]) throw ConfigError(std::string(key) + ": is not a key of a command at a time");
  given["start_time"] = 0;
  given["from"] = std::vector<float>{0, 0};
  return given;
}

/// What can be asked of a command before it is due.
struct Check {
  const Scenario& scenario;
  void operator()(const command::EditTerrain& c) const {
    check_edit(c);
    require_still_plants(c, scenario);
  }
  void operator()(const command::EditPlants& c) const { check_plant_edit(c, scenario); }
  void operator()(const command::EditWind& c) const {
    if (c.operation == WindEdit::add || c.operation == WindEdit::change) check_wind_feature(c.feature);
  }
  void operator()(const command::SetWindSchedule& c) const { check_wind_schedule(c.regime, c.name); }
  template <class Other>
  void operator()(const Other&) const {}  // its table says it all
};

Command read_timed_command(const Scenario& scenario, const std::string& text, const std::string& source) {
  const YAML::Node given = YAML::Load(text);
  require_timed(given);
  const YAML::Node whole = with_beginning(YAML::Clone(given));
  const Command command = read_command(whole, given["command"].Scalar());
  YAML::Emitter written;
  written << YAML::BeginMap;
  emit_command(written, command);
  written << YAML::EndMap;
  ValidationErrors errors(source);
  reject_keys_not_in(YAML::Load(written.c_str()), whole, "", errors);
  errors.throw_if_any();
  std::visit(Check{scenario}, command);
  return command;
}

}  // namespace

std::vector<std::optional<Command>> read_timed_commands(const Scenario& scenario) {
  ValidationErrors errors(scenario.name);
  std::vector<std::optional<Command>> commands(scenario.timeline.size());
  for (std::size_t n = 0; n < commands.size() && !errors.is_full(); ++n) {
    const TimelineEntry& entry = scenario.timeline[n];
    if (entry.command.empty()) continue;
    try {
      commands[n] = read_timed_command(scenario, entry.command, "command");
    } catch (const ConfigError& e) {
      errors.add("run.timeline." + std::to_string(n) + " (at " + number_text(entry.time, 9) + " s)",
                 e.what());
    }
  }
  errors.throw_if_any();
  return commands;
}

}  // namespace desert_sim
