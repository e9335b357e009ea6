#pragma once
/// A session: a simulation with its backend, its journal, its start and its checkpoints. What the node and
/// desert_run both drive. One thread at a time.

#include <memory>
#include <set>
#include <string>

#include "src/simulation/former_scenes.hpp"
#include "src/simulation/journal.hpp"
#include "src/simulation/simulation.hpp"

namespace desert_sim {

/// XXH3-64 of what the scenario sets otherwise than by default; a journal names the scenario it belongs to by
/// it.
std::uint64_t scenario_hash(const Scenario& scenario);

class Session {
 public:
  /// `journal_path` may be empty. `backend`: auto, cpu, cuda. `undo_memory`: for what undo can bring back
  /// [bytes]; see EditHistory. A replay must have that of its journal. Throws ConfigError.
  Session(const Scenario& scenario, const RasterLoader& load_raster, const std::string& backend, int threads,
          const std::string& journal_path = "", std::size_t undo_memory = default_undo_memory);
  ~Session();
  /// Begins with a checkpoint, and with the scenario in it.
  static std::unique_ptr<Session> from_checkpoint(const std::string& checkpoint,
                                                  const RasterLoader& load_raster, const std::string& backend,
                                                  int threads, std::size_t undo_memory = default_undo_memory);
  /// Throws ConfigError if the journal was written for another scenario; `path` names it in the message. Of a
  /// journal of version 1 that is not known, which is a warning.
  void require_journal_of_this_scenario(const Journal& journal, const std::string& path) const;

  Simulation& simulation() { return *simulation_; }
  const std::string& backend_choice() const { return backend_choice_; }  ///< which backend, and why

  /// From now on, commands read scenarios and checkpoints below `folder` only, as InputFile does. Which
  /// rasters may be read is for the raster loader to decide.
  void confine_commands(const std::string& folder) { folder_ = folder; }
  /// From now on, undo knows strokes of edits alone: neither settings nor resets and loads. What a journal of
  /// version 1 or 2 was written with.
  void undo_edits_alone();

  /// Logs a process's warning (Process::warning) once for each simulation, when it begins.
  void step();
  /// Applies a command and journals it. A refused command throws ConfigError and changes nothing.
  /// `with_change`: the result of an edit, undo or redo tells it cell by cell.
  CommandResult apply(const Command& command, bool with_change = false);
  /// Likewise for a command of a journal, which an earlier version may have written.
  CommandResult replay(const Command& recorded);
  /// How many strokes, resets and loads can be undone, and redone, now.
  int undoable() const { return simulation_->commands().history().undoable() + scenes_.undoable(); }
  int redoable() const { return simulation_->commands().history().redoable() + scenes_.redoable(); }
  /// Steps done in this session, through resets and loads; what the journal counts in.
  std::uint64_t ticks() const { return ticks_; }

  /// The journal, and the checkpoints, scenarios and terrains that it loads; none without a journal.
  std::vector<std::string> journal_files() const;
  /// Throws ConfigError if `path` is one of journal_files(): the journal could not be replayed if another
  /// file took its place.
  void require_not_of_journal(const std::string& path) const;
  /// Likewise if the journal needs a checkpoint that a scenario in `folder` begins with, which the next one
  /// to be saved there would replace.
  void require_no_start_of_journal(const std::string& folder) const;
  /// Writes a checkpoint by write_file(). Throws ConfigError also as require_not_of_journal() does.
  void save_checkpoint(const std::string& path);

 private:
  Session(const RasterLoader& load_raster, const std::string& backend, int threads, std::size_t undo_memory);
  /// The history ends with the simulation that it belongs to.
  void replace_simulation(std::unique_ptr<Simulation> simulation);
  /// Likewise where a reset or load replaces it, which undo can take back.
  void begin_scene(std::unique_ptr<Simulation> simulation, const std::string& start_folder);
  /// Whether the present simulation can be kept for undo.
  bool can_keep_scene() const;
  FormerScenes::Scene present_scene() const;
  CommandResult turn_scene(bool redo);
  CommandResult execute(const command::Undo& command, bool with_change, Command& journalled);
  CommandResult execute(const command::Redo& command, bool with_change, Command& journalled);
  template <class Turn>
  CommandResult turn(const Turn& command, bool redo, bool with_change);
  /// Each replaces what the journal will have by what a replay needs to find the same again.
  CommandResult execute(const command::Reset& command, bool with_change, Command& journalled);
  CommandResult execute(const command::LoadCheckpoint& command, bool with_change, Command& journalled);
  CommandResult execute(const command::LoadScenario& command, bool with_change, Command& journalled);
  template <class Other>
  CommandResult execute(const Other& command, bool with_change, Command&) {
    return simulation_->apply(command, with_change);
  }
  Scenario read_scenario(const command::LoadScenario& command, const std::string& folder) const;
  /// Keeps the checkpoint that the scenario begins with for a replay.
  void note_start();
  /// Returns the state hash at the new scenario's start.
  std::uint64_t load_scenario(const command::LoadScenario& command);

  RasterLoader load_raster_;
  std::string folder_;        ///< that commands read files below; empty: they read any file
  std::string start_folder_;  ///< likewise the checkpoint of the start, when a reset goes back to it
  std::size_t undo_memory_;   ///< for strokes, and again for former scenes [bytes]
  bool undo_edits_alone_ = false;
  FormerScenes scenes_;
  std::string backend_choice_;
  std::unique_ptr<Exec> exec_;
  std::unique_ptr<Simulation> simulation_;
  std::unique_ptr<JournalWriter> journal_;
  std::string journal_path_;
  std::set<std::string> loaded_files_;       ///< that the journal loads
  std::set<std::string> starts_of_journal_;  ///< checkpoints that its scenarios begin with
  std::set<std::string> warned_;             ///< processes whose warning has been logged
  std::uint64_t ticks_ = 0;
};

}  // namespace desert_sim
