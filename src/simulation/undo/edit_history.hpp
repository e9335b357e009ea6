#pragma once
/// The history of edits and settings: what undo and redo bring back. doc/robotics/undo.md says what they mean
/// in a world that moves. It belongs to a simulation and ends with it; checkpoints do not have it.

#include <deque>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "src/simulation/commands/command.hpp"
#include "src/simulation/undo/loose_ground.hpp"
#include "src/simulation/undo/material_return.hpp"
#include "src/simulation/undo/population.hpp"
#include "src/simulation/undo/settings.hpp"
#include "src/simulation/undo/stroke.hpp"

namespace desert_sim {

/// Memory for the history [bytes], unless somebody says how much.
constexpr std::size_t default_undo_memory = 64'000'000;

/// Throws ConfigError, in the name of `what`, unless the name of a stroke has at most 255 bytes, all of them
/// printable ASCII.
void check_stroke_name(const std::string& name, const std::string& what);

class EditHistory {
 public:
  /// `check`: of a scenario that an undo or redo would bring back.
  EditHistory(SimulationState& state, Pipeline& pipeline, ScenarioCheck check);
  EditHistory(const EditHistory&) = delete;
  EditHistory& operator=(const EditHistory&) = delete;

  /// What strokes may take [bytes]; the oldest are forgotten first. 0: none is kept.
  void set_memory(std::size_t bytes);
  bool remembers() const { return memory_ > 0; }
  /// Whether settings are remembered, too, as they are unless somebody says otherwise.
  void remember_settings(bool on) { settings_remembered_ = on; }
  std::size_t bytes() const;
  /// How many strokes can be undone, and redone, now.
  int undoable() const { return static_cast<int>(strokes_.size()) - redoable(); }
  int redoable() const;

  // ---- Painting. A name that is not empty and belongs to a stroke which nobody has undone or redone
  // continues that stroke.

  /// Before an edit changes the ground.
  void begin_ground() { loose_.begin(); }
  /// `new_layer`: the edit has brought its layer into use.
  void paint(const std::string& stroke, const LayerEdit& edit, bool new_layer);
  void paint(const std::string& stroke, const Population::Edit& plants);

  /// Before a command sets something: what could change.
  struct Settings {
    SettingScope scope;
    SettingTexts texts;         ///< none if nothing is remembered
    std::vector<Layer> layers;  ///< in use
  };
  Settings settings(SettingScope scope) const;
  /// After it has. A command that changes no setting is no stroke.
  void paint(const std::string& stroke, const Settings& before);

  /// Of the stroke of that name, or, if it is empty, of the one that was painted or redone (undone) last.
  /// Throws ConfigError if there is none. `with_change`: the result tells what changed, cell by cell.
  CommandResult undo(const std::string& stroke, bool with_change);
  CommandResult redo(const std::string& stroke, bool with_change);

 private:
  Stroke& find(const std::string& name, bool undone, const std::string& what);
  CommandResult turn(Stroke& stroke, bool with_change);
  Stroke& stroke_to_paint(const std::string& name);
  void prepare(const Stroke& stroke);
  void require_possible(const Stroke& stroke, const Scenario& scenario) const;
  void require_species(const Stroke& stroke, const Scenario& scenario) const;
  bool is_used(Layer layer) const;
  bool tell(const Stroke& stroke, const MaterialReturns& moved, CommandResult& result) const;
  void release_layers();
  void release_layers_of_settings(const Stroke& stroke);
  void close(const Stroke& stroke);
  void close_plant_strokes();
  void forget_oldest();
  void keep_to_memory();
  /// The sizes of strokes are counted again after each change.
  void recount(const Stroke& stroke, std::size_t before) { stroke_bytes_ += stroke.bytes() - before; }

  SimulationState& state_;
  Pipeline& pipeline_;
  const ScenarioCheck check_;
  bool settings_remembered_ = true;
  LooseGround loose_;
  Population population_;
  std::deque<Stroke> strokes_;                     ///< the oldest first
  std::unordered_map<std::string, Stroke*> open_;  ///< those that further edits belong to
  std::uint64_t actions_ = 0;                      ///< edits, undos and redos so far
  std::set<Layer> new_layers_;                     ///< painted ones, in use because of these strokes alone
  std::size_t memory_ = 0, stroke_bytes_ = 0;
};

}  // namespace desert_sim
