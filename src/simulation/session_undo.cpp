/// Session: what undo and redo do where resets and loads have put an end to a simulation.
#include "src/simulation/checkpoint.hpp"
#include "src/simulation/session.hpp"

namespace desert_sim {

void Session::undo_edits_alone() {
  undo_edits_alone_ = true;
  scenes_.forget();
  simulation_->commands().history().remember_settings(false);
}

bool Session::can_keep_scene() const {
  const SimulationState& s = simulation_->state();
  std::size_t bytes = static_cast<std::size_t>(s.plants.count) * plants::column_count * sizeof(std::uint32_t);
  for (const LayerInfo& row : layer_table)
    if (s.is_part(row.layer))
      bytes += static_cast<std::size_t>(s.terrain.grid().cells()) * sizeof(std::uint32_t);
  return !undo_edits_alone_ && bytes < undo_memory_;
}

FormerScenes::Scene Session::present_scene() const { return {checkpoint_bytes(*simulation_), start_folder_}; }

void Session::begin_scene(std::unique_ptr<Simulation> simulation, const std::string& start_folder) {
  if (!can_keep_scene())
    scenes_.forget();
  else if (FormerScenes::Scene scene = present_scene();
           simulation->steps() != simulation_->steps() || checkpoint_bytes(*simulation) != scene.checkpoint)
    scenes_.end(std::move(scene));  // a reset at the start is none
  replace_simulation(std::move(simulation));
  start_folder_ = start_folder;
}

CommandResult Session::turn_scene(bool redo) {
  const FormerScenes::Scene next = scenes_.next(redo);
  auto simulation = simulation_from_bytes(next.checkpoint, *exec_, redo ? "redo" : "undo");
  if (can_keep_scene())
    scenes_.turn(redo, present_scene());
  else
    scenes_.forget();
  replace_simulation(std::move(simulation));
  start_folder_ = next.start_folder;
  CommandResult result;
  result.replaces_terrain = true;
  return result;
}

/// Of strokes first, because all of them came after the reset or load that the simulation began with.
template <class Turn>
CommandResult Session::turn(const Turn& command, bool redo, bool with_change) {
  const EditHistory& history = simulation_->commands().history();
  const int strokes = redo ? history.redoable() : history.undoable(),
            scenes = redo ? scenes_.redoable() : scenes_.undoable();
  CommandResult result = strokes == 0 && scenes > 0 && command.stroke.empty()
                             ? turn_scene(redo)
                             : simulation_->apply(command, with_change);
  result.undoable = undoable();
  result.redoable = redoable();
  return result;
}

CommandResult Session::execute(const command::Undo& command, bool with_change, Command&) {
  return turn(command, false, with_change);
}

CommandResult Session::execute(const command::Redo& command, bool with_change, Command&) {
  return turn(command, true, with_change);
}

}  // namespace desert_sim
