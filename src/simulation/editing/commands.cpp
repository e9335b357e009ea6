#include "src/simulation/editing/commands.hpp"

#include <algorithm>
#include <tuple>

#include "src/core/error.hpp"
#include "src/core/number_text.hpp"
#include "src/scenario/live_parameters.hpp"
#include "src/scenario/range_checks.hpp"
#include "src/scenario/terrain_builder.hpp"
#include "src/scenario/wind_feature_lists.hpp"
#include "src/simulation/commands/edit_checks.hpp"
#include "src/simulation/commands/edited_layers.hpp"
#include "src/simulation/editing/plant_edit.hpp"
#include "src/simulation/editing/terrain_edit.hpp"
#include "src/simulation/memory/memory.hpp"
#include "src/simulation/pipeline/scenario_change.hpp"
#include "src/simulation/processes/processes.hpp"

namespace desert_sim {

/// A new command is an operator here.
struct Commands::Execution {
  Commands& commands;
  bool with_change;
  SimulationState& state = commands.state_;
  Pipeline& pipeline = commands.pipeline_;
  EditHistory& history = commands.history_;

  CommandResult operator()(const command::SetParameters& command) const;
  CommandResult operator()(const command::SetWind& command) const;
  CommandResult operator()(const command::SetWindSchedule& command) const;
  CommandResult operator()(const command::EditWind& command) const;
  CommandResult operator()(const command::EditTerrain& command) const;
  CommandResult operator()(const command::EditPlants& command) const;
  CommandResult operator()(const command::Undo& command) const {
    return turned(history.undo(command.stroke, with_change));
  }
  CommandResult operator()(const command::Redo& command) const {
    return turned(history.redo(command.stroke, with_change));
  }
  /// Lets a regime begin, which undo can take back.
  template <class Command>
  CommandResult set_regime(const WindRegime& regime, const Command& command) const {
    check_stroke_name(command.stroke, command.name);
    const EditHistory::Settings before = history.settings(SettingScope::wind);
    state.set_wind_regime(regime);
    history.paint(command.stroke, before);
    return {};
  }
  CommandResult turned(CommandResult result) const {
    if (!result.returned.settings.empty()) commands.read_timeline();
    return result;
  }
  template <class Replacing>
  CommandResult operator()(const Replacing& command) const {
    throw Error(std::string(command.name) + " replaces the simulation: a session applies it");
  }
};

CommandResult Commands::apply(const Command& command, bool with_change) {
  return std::visit(Execution{*this, with_change}, command);
}

namespace {

/// Plants that begin to live determine the layer vegetation, on which still ones may be painted.
void require_no_still_plants(const SimulationState& state, const Scenario& wanted, const std::string& what) {
  if (state.plants || !wanted.get<VegetationParameters>().enabled || !state.terrain.has(Layer::vegetation))
    return;
  const std::vector<float> still = state.terrain.values(Layer::vegetation);
  const auto cells = std::count_if(still.begin(), still.end(), [](float density) { return density > 0; });
  if (cells > 0)
    throw ConfigError(what + ": vegetation.enabled: still plants are on " + std::to_string(cells) +
                      " cells (allowed: none; edit_terrain can set the layer vegetation to 0)");
}

bool replaces_timeline(const std::vector<std::string>& settings) {
  return std::any_of(settings.begin(), settings.end(),
                     [](const std::string& setting) { return setting.rfind("run.timeline=", 0) == 0; });
}

/// What the timeline has until now has happened, or never will.
void require_future_timeline(const SimulationState& state, const Scenario& wanted) {
  const std::vector<TimelineEntry>& before = state.scenario.timeline;
  for (std::size_t n = 0; n < wanted.timeline.size(); ++n) {
    const TimelineEntry& entry = wanted.timeline[n];
    const auto is_same = [&entry](const TimelineEntry& old) {
      return std::tie(entry.time, entry.ramp, entry.every, entry.until, entry.settings, entry.command) ==
             std::tie(old.time, old.ramp, old.every, old.until, old.settings, old.command);
    };
    const bool ahead = entry.time >= state.time() && entry.time > state.timeline_time;
    if (!ahead && std::none_of(before.begin(), before.end(), is_same))
      throw ConfigError("set_parameters: run.timeline." + std::to_string(n) +
                        ".time: " + number_text(entry.time, 9) + " s is past (allowed: from " +
                        number_text(state.time(), 9) + " s, and entries that the timeline has)");
  }
}

/// Nothing that carries sand through the air may be there to let it fall again.
void require_carried(const command::EditTerrain& edit, const Scenario& scenario) {
  if (edit.layer != info(Layer::airborne_sand).name) return;
  const std::vector<Process>& all = process_table().processes;
  const bool carried = std::any_of(all.begin(), all.end(), [&](const Process& process) {
    return std::count(process.writes.begin(), process.writes.end(), Layer::airborne_sand) > 0 &&
           process_table().is_active(process, scenario);
  });
  if (!carried)
    throw ConfigError(
        "edit_terrain: layer: airborne_sand: nothing carries sand through the air here (allowed: with "
        "saltation.enabled, and sand.model hops, desertscape_2019 or continuum)");
}

}  // namespace

void Commands::require_scenario(const Scenario& wanted, const std::string& what) const {
  process_table().require_runnable(wanted);
  require_sea(wanted, state_.terrain.scale(), what);
  require_no_still_plants(state_, wanted, what);
  require_more_memory(state_, wanted);
}

CommandResult Commands::Execution::operator()(const command::SetParameters& command) const {
  check_stroke_name(command.stroke, command.name);
  if (!(command.ramp >= 0 && command.ramp <= command.longest_ramp))
    throw ConfigError("set_parameters: ramp: " + std::to_string(command.ramp) + " is not in [0, 1e+12] s");
  const Scenario present = state.present_scenario(), wanted = with_live_settings(present, command.settings);
  // Also what comes at the end of a ramp is refused now, not in the middle of the run:
  commands.require_scenario(wanted, command.name);
  std::vector<std::string> settings = command.settings;
  const std::vector<Ramp> before = state.ramps;
  const EditHistory::Settings settings_before = history.settings(SettingScope::all);
  commands.begin_ramps(settings, command.ramp);
  try {
    commands.set_parameters(settings);
  } catch (...) {
    state.ramps = before;
    throw;
  }
  history.paint(command.stroke, settings_before);
  return {};
}

void Commands::set_parameters(const std::vector<std::string>& settings) {
  if (settings.empty()) return;
  const Scenario changed = with_live_settings(state_.present_scenario(), settings);
  require_scenario(changed, "set_parameters");
  std::optional<std::vector<std::optional<Command>>> new_timeline;
  if (replaces_timeline(settings)) {
    require_future_timeline(state_, changed);
    new_timeline = read_timed_commands(changed);
  }
  take_scenario(state_, pipeline_, changed);
  if (new_timeline) timed_commands_ = std::move(*new_timeline);
  state_.wind_regime = state_.wind_regime.with(changed.wind_regime, state_.time());
}

CommandResult Commands::Execution::operator()(const command::SetWind& command) const {
  check_ranges(command, "set_wind");
  WindRegime regime;
  regime.direction_deg = command.direction_deg;
  regime.speed = command.speed;
  regime.ramp = command.ramp;
  return set_regime(regime, command);
}

void check_wind_schedule(const WindRegime& r, const std::string& what) {
  check_ranges(static_cast<const WindRegimeParameters&>(r), what);
  ValidationErrors errors(what);
  if (r.regime != WindRegimeKind::timeline && r.regime != WindRegimeKind::rose)
    errors.add("kind", "must be timeline or rose");
  check_wind_segments(r.regime, r.segments, "segments", errors);
  errors.throw_if_any();
  for (std::size_t n = 0; n < r.segments.size(); ++n)
    check_ranges(r.segments[n], what + ": segments." + std::to_string(n));
}

CommandResult Commands::Execution::operator()(const command::SetWindSchedule& command) const {
  check_wind_schedule(command.regime, command.name);
  return set_regime(command.regime, command);
}

void check_wind_feature(const WindFeature& feature) {
  check_ranges(static_cast<const WindFeatureParameters&>(feature), "edit_wind");
  for (std::size_t n = 0; n < feature.path.size(); ++n)
    check_ranges(feature.path[n], "edit_wind: path." + std::to_string(n));
  ValidationErrors errors("edit_wind");
  check_wind_feature(feature, "", errors);
  errors.throw_if_any();
}

namespace {

/// The features as the command leaves them. Throws ConfigError if it is refused.
std::vector<WindFeature> edited_features(const command::EditWind& command,
                                         std::vector<WindFeature> features) {
  check_ranges(command, "edit_wind");
  if (command.operation == WindEdit::clear) return {};
  const int id = command.feature.id;
  if (id < 1) throw ConfigError("edit_wind: id: " + std::to_string(id) + " must be 1 or more");
  const auto found =
      std::find_if(features.begin(), features.end(), [id](const WindFeature& f) { return f.id == id; });
  const bool known = found != features.end();
  if (known == (command.operation == WindEdit::add))
    throw ConfigError("edit_wind: id: " + std::to_string(id) +
                      (known ? " is already the id of another feature" : " is not the id of any feature"));
  if (command.operation == WindEdit::remove) {
    features.erase(found);
  } else {
    check_wind_feature(command.feature);
    if (known)
      *found = command.feature;
    else if (features.size() < max_wind_features)
      features.push_back(command.feature);
    else
      throw ConfigError("edit_wind: " + std::to_string(max_wind_features) +
                        " features already exist (allowed: at most " + std::to_string(max_wind_features) +
                        ")");
  }
  return features;
}

}  // namespace

CommandResult Commands::Execution::operator()(const command::EditWind& command) const {
  check_stroke_name(command.stroke, command.name);
  std::vector<WindFeature>& features = state.scenario.wind_features;
  std::vector<WindFeature> before = edited_features(command, features);
  const EditHistory::Settings settings_before = history.settings(SettingScope::features);
  std::swap(before, features);
  try {
    pipeline.adapt();  // features need memory
  } catch (...) {
    features = before;
    throw;
  }
  history.paint(command.stroke, settings_before);
  return {};
}

CommandResult Commands::Execution::operator()(const command::EditTerrain& command) const {
  check_stroke_name(command.stroke, "edit_terrain");
  require_still_plants(command, state.scenario);
  require_carried(command, state.scenario);
  pipeline.ground_changed();
  TerrainEdit edit(command, state.terrain, state.scenario.grid, state.ledger());
  const bool had_layer = state.terrain.has(edit.layer());
  const ProcessFlags flags = state.flags;
  history.begin_ground();
  pipeline.edited(edit.layer());
  try {
    pipeline.adapt();  // ground that is loose needs memory
    const bool undoable = edit_kind(edit.layer()) != EditKind::fleeting;
    const LayerEdit change = undoable && history.remembers() ? edit.change() : LayerEdit{};
    const CommandResult result = edit.commit(with_change);
    edit.loosen(state.scenario.get<LoosenessParameters>());
    if (undoable) history.paint(command.stroke, change, !had_layer && state.terrain.has(edit.layer()));
    return result;
  } catch (...) {
    state.flags = flags;
    throw;
  }
}

CommandResult Commands::Execution::operator()(const command::EditPlants& command) const {
  check_stroke_name(command.stroke, "edit_plants");
  check_plant_edit(command, state.scenario);
  const int before = state.plants.count;
  const Population::Edit edit = plant_edit(command, state.scenario, state.terrain, state.steps,
                                           state.plants.capacity, plants::words(state.plants));
  history.paint(command.stroke, edit);
  CommandResult result;
  result.plants = state.plants.count - before;
  return result;
}

}  // namespace desert_sim
