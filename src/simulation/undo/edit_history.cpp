#include "src/simulation/undo/edit_history.hpp"

#include <algorithm>
#include <optional>

#include "src/core/error.hpp"
#include "src/core/quoted.hpp"
#include "src/simulation/undo/changed_cells.hpp"
#include "src/simulation/undo/material_return.hpp"
#include "src/simulation/undo/painted_layers.hpp"

namespace desert_sim {

void check_stroke_name(const std::string& name, const std::string& what) {
  constexpr std::size_t longest = 255;
  if (name.size() > longest)
    throw ConfigError(what + ": stroke: has " + std::to_string(name.size()) + " bytes (allowed: at most " +
                      std::to_string(longest) + ")");
  if (!std::all_of(name.begin(), name.end(), [](char c) { return c >= ' ' && c <= '~'; }))
    throw ConfigError(what + ": stroke: has a byte that is not a printable character of ASCII");
}

EditHistory::EditHistory(SimulationState& state, Pipeline& pipeline)
    : state_(state), pipeline_(pipeline), loose_(state, pipeline), population_(state, pipeline) {}

// ---- memory

std::size_t EditHistory::bytes() const { return stroke_bytes_ + population_.bytes(); }

void EditHistory::set_memory(std::size_t bytes) {
  memory_ = bytes;
  keep_to_memory();
}

void EditHistory::keep_to_memory() {
  while (bytes() > memory_ && !strokes_.empty()) {
    Stroke& oldest = strokes_.front();
    close(oldest);
    if (!oldest.undone)  // what it has painted stays for ever
      for (const PaintedLayer& painted : oldest.painted) new_layers_.erase(painted.layer);
    stroke_bytes_ -= oldest.bytes();
    strokes_.pop_front();
  }
  if (strokes_.empty()) population_.forget();
}

/// Further edits of its name begin another stroke.
void EditHistory::close(const Stroke& stroke) {
  const auto at = open_.find(stroke.name);
  if (at != open_.end() && at->second == &stroke) open_.erase(at);
}

// ---- painting

Stroke& EditHistory::stroke_to_paint(const std::string& name) {
  const auto at = open_.find(name);
  if (!name.empty() && at != open_.end()) return *at->second;
  Stroke& stroke = strokes_.emplace_back();
  stroke.name = name;
  stroke_bytes_ += stroke.bytes();
  if (!name.empty()) open_[name] = &stroke;
  return stroke;
}

void EditHistory::paint(const std::string& name, const LayerEdit& edit, bool new_layer) {
  if (!remembers()) return;
  const auto open = open_.find(name);
  if (open != open_.end() && !open->second->has_room(edit.layer, edit.cells)) open_.erase(open);
  Stroke& stroke = stroke_to_paint(name);
  const std::size_t before = stroke.bytes();
  stroke.last_action = ++actions_;
  if (edit_kind(edit.layer) == EditKind::painted) {
    if (new_layer) new_layers_.insert(edit.layer);
    std::vector<PaintedCell> cells = edit.painted;
    for (PaintedCell& c : cells) c.order = actions_;
    desert_sim::paint(strokes_, stroke, edit.layer, cells);
  } else {
    stroke.add(edit.layer, edit.cells, edit.conserve);
    loose_.painted(edit.layer, stroke.loose);
  }
  recount(stroke, before);
  keep_to_memory();
}

void EditHistory::paint(const std::string& name, const Population::Edit& plants) {
  PlantChange change = population_.paint(plants, remembers());
  if (!remembers()) return;
  Stroke& stroke = stroke_to_paint(name);
  const std::size_t before = stroke.bytes();
  stroke.last_action = ++actions_;
  population_.merge(stroke.plants, std::move(change));
  recount(stroke, before);
  keep_to_memory();
}

// ---- undo and redo

Stroke& EditHistory::find(const std::string& name, bool undone, const std::string& what) {
  check_stroke_name(name, what);
  Stroke *found = nullptr, *newest = nullptr;
  for (Stroke& stroke : strokes_) {
    if (stroke.undone != undone) continue;
    if (!newest || stroke.last_action > newest->last_action) newest = &stroke;
    const bool named = name.empty() || stroke.name == name;
    if (named && (!found || stroke.last_action > found->last_action)) found = &stroke;
  }
  if (found) return *found;
  const std::string verb = undone ? "redone" : "undone";
  if (!remembers()) throw ConfigError(what + ": no stroke is kept, because undo_memory is 0");
  if (!newest)
    throw ConfigError(what + ": there is no stroke that can be " + verb +
                      " (a load and a reset forget all strokes)");
  throw ConfigError(what + ": stroke: " + desert_sim::in_quotes(name) +
                    " is not the name of a stroke that can be " + verb +
                    (newest->name.empty() ? " (the newest has no name)"
                                          : " (the newest is " + desert_sim::in_quotes(newest->name) + ")"));
}

CommandResult EditHistory::undo(const std::string& name, bool with_change) {
  return turn(find(name, false, "undo"), with_change);
}

CommandResult EditHistory::redo(const std::string& name, bool with_change) {
  return turn(find(name, true, "redo"), with_change);
}

namespace {

std::vector<int> cells_of(const PaintedLayer& painted) {
  std::vector<int> cells;
  cells.reserve(painted.cells.size());
  for (const PaintedCell& c : painted.cells) cells.push_back(c.cell);
  return cells;
}

}  // namespace

/// Brings the memory into use that the stroke needs. Throws ConfigError, and has changed nothing, if there is
/// none.
void EditHistory::prepare(const Stroke& stroke) {
  loose_.begin();
  for (const PaintedLayer& painted : stroke.painted) {
    if (state_.terrain.has(painted.layer)) continue;
    state_.terrain.allocate(painted.layer);
    new_layers_.insert(painted.layer);
  }
  const ProcessFlags flags = state_.flags;
  for (Layer layer : {Layer::bedrock, Layer::soil})
    if (stroke.changed(layer)) pipeline_.edited(layer);
  try {
    pipeline_.adapt();  // ground that is loose needs memory
  } catch (...) {
    state_.flags = flags;
    release_layers();
    throw;
  }
  state_.flags = flags;
}

/// A terrain that did not have a painted layer before its strokes does not have it when all are undone.
void EditHistory::release_layers() {
  for (auto layer = new_layers_.begin(); layer != new_layers_.end();) {
    if (std::any_of(strokes_.begin(), strokes_.end(),
                    [&](const Stroke& s) { return !s.undone && s.changed(*layer); })) {
      ++layer;
      continue;
    }
    state_.exec().synchronise();  // steps in flight work with it
    state_.terrain.set_allocated(*layer, false);
    layer = new_layers_.erase(layer);
  }
}

CommandResult EditHistory::turn(Stroke& stroke, bool with_change) {
  // Whatever needs memory comes first, so that nothing is half done if there is none.
  prepare(stroke);
  const std::size_t before = stroke.bytes();
  std::optional<MaterialTurn> materials;
  std::vector<CellList> painted;
  CommandResult result;
  try {
    materials.emplace(stroke.materials, state_);
    for (const PaintedLayer& layer : stroke.painted) painted.emplace_back(state_.exec(), cells_of(layer));
    result.returned.missing_plants = population_.turn_back(stroke.plants);
  } catch (...) {
    release_layers();
    throw;
  }
  pipeline_.ground_changed();
  const MaterialReturns moved = materials->commit();
  ChangedCells cells(state_);
  for (const MaterialChange& change : stroke.materials) cells.add(change);
  for (std::size_t n = 0; n < painted.size(); ++n)
    cells.add(stroke.painted[n],
              desert_sim::turn(strokes_, stroke, stroke.painted[n], painted[n], state_.terrain));
  cells.add(stroke.plants);
  result.plants = static_cast<long long>(stroke.plants.added.size()) -
                  static_cast<long long>(stroke.plants.removed.size());
  bool complete = true;
  for (const MaterialChange& change : stroke.materials) {
    const auto m = static_cast<std::size_t>(material_of(change.layer));
    const double cell = state_.scenario.grid.cell_size,
                 quantum = state_.terrain.scale().quantum() * cell * cell;
    const auto volume = [&](long long quanta) { return static_cast<double>(quanta) * quantum; };
    result.returned.materials[m] = {volume(moved[m].added), volume(moved[m].removed),
                                    volume(moved[m].missing)};
    complete = complete && moved[m].missing == 0;
  }
  loose_.returned(stroke, complete, stroke.loose);
  stroke.undone = !stroke.undone;
  stroke.last_action = ++actions_;
  result.returned.name = stroke.name;
  result.changed_cells = cells.rectangle();
  if (with_change) result.changes = cells.changes();
  close(stroke);
  release_layers();
  recount(stroke, before);
  keep_to_memory();
  result.undoable = undoable();
  result.redoable = redoable();
  return result;
}

int EditHistory::redoable() const {
  return static_cast<int>(
      std::count_if(strokes_.begin(), strokes_.end(), [](const Stroke& s) { return s.undone; }));
}

}  // namespace desert_sim
