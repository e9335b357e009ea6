#include "src/simulation/session.hpp"

#include <xxhash.h>

#include "src/core/error.hpp"
#include "src/core/files.hpp"
#include "src/core/log.hpp"
#include "src/scenario/band_terrain.hpp"
#include "src/scenario/former_keys.hpp"
#include "src/scenario/live_parameters.hpp"
#include "src/scenario/raster_grid.hpp"
#include "src/scenario/wind_series_file.hpp"
#include "src/scenario/yaml_parameters.hpp"
#include "src/simulation/checkpoint.hpp"
#include "src/simulation/editing/timeline_rasters.hpp"
#include "src/simulation/processes/settings_without_effect.hpp"
#include "src/simulation/start.hpp"

namespace desert_sim {

namespace {

void warn_of_settings_without_effect(const Scenario& scenario) {
  for (const std::string& line : settings_without_effect(scenario))
    log_warning("scenario " + scenario.name + ": " + line);
}

}  // namespace

std::uint64_t scenario_hash(const Scenario& scenario) {
  std::string text;
  for (const auto& [path, value] : changed_parameters(Scenario(), scenario))
    text += path + "=" + value + "\n";
  if (scenario.wind_series) text += scenario.wind_series->text();
  return XXH3_64bits(text.data(), text.size());
}

Session::Session(const Scenario& scenario, const RasterLoader& load_raster, const std::string& backend,
                 int threads, const std::string& journal_path, std::size_t undo_memory)
    : load_raster_(load_raster), undo_memory_(undo_memory), scenes_(undo_memory) {
  Scenario resolved = scenario;
  resolve_grid(resolved, load_raster_);
  read_wind_series(resolved);
  read_timeline_rasters(resolved, load_raster_);
  exec_ = make_exec(backend, threads, &backend_choice_);
  replace_simulation(simulation_at_start(*exec_, resolved, load_raster_));
  warn_of_settings_without_effect(resolved);
  if (journal_path.empty()) return;
  note_start();
  journal_path_ = journal_path;
  journal_ =
      std::make_unique<JournalWriter>(journal_path, scenario_hash(resolved), exec_->backend(), undo_memory);
}

Session::Session(const RasterLoader& load_raster, const std::string& backend, int threads,
                 std::size_t undo_memory)
    : load_raster_(load_raster),
      undo_memory_(undo_memory),
      scenes_(undo_memory),
      exec_(make_exec(backend, threads, &backend_choice_)) {}

std::unique_ptr<Session> Session::from_checkpoint(const std::string& checkpoint,
                                                  const RasterLoader& load_raster, const std::string& backend,
                                                  int threads, std::size_t undo_memory) {
  std::unique_ptr<Session> session(new Session(load_raster, backend, threads, undo_memory));
  session->replace_simulation(load_checkpoint(checkpoint, *session->exec_));
  return session;
}

void Session::replace_simulation(std::unique_ptr<Simulation> simulation) {
  simulation->commands().history().set_memory(undo_memory_);
  simulation->commands().history().remember_settings(!undo_edits_alone_);
  simulation_ = std::move(simulation);
  warned_.clear();
}

void Session::require_journal_of_this_scenario(const Journal& journal, const std::string& path) const {
  const Scenario& start = simulation_->state().start;
  if (journal.version == 1)
    return log_warning(path +
                       ": is of an earlier version, which hashed scenarios otherwise: whether it is the "
                       "journal of " +
                       start.name + " is not known");
  if (journal.scenario_hash != scenario_hash(start))
    throw ConfigError(path + ": is the journal of a scenario other than " + start.name +
                      ", or of other settings");
}

Session::~Session() {
  if (!journal_) return;
  try {
    journal_->end(ticks_);
  } catch (const Error& e) {
    log_error(e.what());
  }
}

void Session::step() {
  simulation_->step();
  ++ticks_;
  for (const auto& [process, text] : simulation_->pipeline().warnings())
    if (warned_.insert(process).second)
      log_warning("step " + std::to_string(simulation_->steps()) + ": " + process + ": " + text);
}

Scenario Session::read_scenario(const command::LoadScenario& command, const std::string& folder) const {
  if (command.terrain_only && is_bag(command.path))
    return scenario_from_bands(command.path, load_raster_, command.fill_nodata);
  if (command.yaml.empty()) return desert_sim::load_scenario(command.path, command.settings, folder);
  return parse_scenario_text(command.yaml, base_name(command.path), command.settings,
                             parent_folder(command.path));
}

namespace {

CommandResult replaced_terrain() {
  CommandResult result;
  result.replaces_terrain = true;
  return result;
}

}  // namespace

std::uint64_t Session::load_scenario(const command::LoadScenario& command) {
  const std::string& folder = command.folder.empty() ? folder_ : command.folder;
  Scenario next = read_scenario(command, folder);
  if (command.terrain_only) {
    Scenario merged = simulation_->state().start;
    merged.grid = next.grid;
    merged.terrain = next.terrain;
    merged.folder = next.folder;
    merged.projection.clear();
    merged.run.start_from.clear();
    ValidationErrors errors(command.path);
    if (!next.run.start_from.empty())
      errors.add("run.start_from",
                 "has a state, of which the terrain cannot be taken alone (allowed: terrain)");
    check_sections(merged, errors);  // which the terrain's vegetation must not meet
    errors.throw_if_any();
    next = std::move(merged);
  }
  resolve_grid(next, load_raster_);
  read_wind_series(next, folder);
  read_timeline_rasters(next, load_raster_);
  auto simulation = simulation_at_start(*exec_, next, load_raster_, folder);
  const std::uint64_t hash = simulation->state().hash();
  if (command.hash != 0 && command.hash != hash)
    throw ConfigError(command.path +
                      ": is not the scenario that the journal recorded (its state hash differs)");
  begin_scene(std::move(simulation), folder);
  if (!command.terrain_only) warn_of_settings_without_effect(simulation_->state().start);
  return hash;
}

CommandResult Session::execute(const command::Reset&, bool, Command&) {
  begin_scene(simulation_at_start(*exec_, simulation_->state().start, load_raster_, start_folder_),
              start_folder_);
  return replaced_terrain();
}

CommandResult Session::execute(const command::LoadCheckpoint& load, bool, Command& journalled) {
  std::unique_ptr<Simulation> loaded = load_checkpoint(load.path, *exec_, folder_);
  const std::uint64_t hash = loaded->state().hash();
  if (load.hash != 0 && load.hash != hash)
    throw ConfigError(load.path +
                      ": is not the checkpoint that the journal recorded (its state hash differs)");
  begin_scene(std::move(loaded), folder_);
  journalled = command::LoadCheckpoint{load.path, hash};
  return replaced_terrain();
}

CommandResult Session::execute(const command::LoadScenario& load, bool, Command& journalled) {
  command::LoadScenario loaded = load;
  loaded.hash = load_scenario(load);
  loaded.folder.clear();
  journalled = loaded;
  return replaced_terrain();
}

namespace {

/// The file that a command loads; null if it loads none.
const std::string* loaded_file(const Command& command) {
  if (const auto* load = std::get_if<command::LoadCheckpoint>(&command)) return &load->path;
  if (const auto* load = std::get_if<command::LoadScenario>(&command); load && load->yaml.empty())
    return &load->path;
  return nullptr;
}

}  // namespace

CommandResult Session::apply(const Command& command, bool with_change) {
  Command journalled = command;
  const CommandResult result =
      std::visit([&](const auto& c) { return execute(c, with_change, journalled); }, command);
  if (!journal_) return result;
  journal_->write(ticks_, journalled);
  if (const std::string* loaded = loaded_file(journalled)) loaded_files_.insert(*loaded);
  note_start();
  return result;
}

void Session::note_start() {
  const Scenario& start = simulation_->state().start;
  if (!start.run.start_from.empty()) starts_of_journal_.insert(raster_path(start, start.run.start_from));
}

CommandResult Session::replay(const Command& recorded) {
  const auto* settings = std::get_if<command::SetParameters>(&recorded);
  if (!settings) return apply(recorded);
  return apply(command::SetParameters{
      without_former_keys(settings->settings, simulation_->scenario().get<SandParameters>().model,
                          "a recorded command"),
      settings->ramp, settings->stroke});
}

std::vector<std::string> Session::journal_files() const {
  if (!journal_) return {};
  std::vector<std::string> files{journal_path_};
  files.insert(files.end(), loaded_files_.begin(), loaded_files_.end());
  files.insert(files.end(), starts_of_journal_.begin(), starts_of_journal_.end());
  return files;
}

void Session::require_not_of_journal(const std::string& path) const {
  for (const std::string& needed : journal_files())
    if (same_file(path, needed))
      throw ConfigError(path + ": cannot be saved: the journal " + journal_path_ +
                        " needs this file to be replayed (allowed: another name)");
}

void Session::require_no_start_of_journal(const std::string& folder) const {
  for (const std::string& start : starts_of_journal_)
    if (journal_ && same_file(folder, parent_folder(start)))
      throw ConfigError(folder + ": cannot be saved to: the journal " + journal_path_ + " needs " + start +
                        " to be replayed (allowed: another folder)");
}

void Session::save_checkpoint(const std::string& path) {
  require_not_of_journal(path);
  desert_sim::save_checkpoint(path, *simulation_);
}

}  // namespace desert_sim
