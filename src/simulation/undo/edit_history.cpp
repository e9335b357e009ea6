#include "src/simulation/undo/edit_history.hpp"

#include <algorithm>

#include "src/core/error.hpp"
#include "src/simulation/undo/painted_layers.hpp"
#include "src/simulation/undo/painted_settings.hpp"

namespace desert_sim {

void check_stroke_name(const std::string& name, const std::string& what) {
  constexpr std::size_t longest = 255;
  if (name.size() > longest)
    throw ConfigError(what + ": stroke: has " + std::to_string(name.size()) + " bytes (allowed: at most " +
                      std::to_string(longest) + ")");
  if (!std::all_of(name.begin(), name.end(), [](char c) { return c >= ' ' && c <= '~'; }))
    throw ConfigError(what + ": stroke: has a byte that is not a printable character of ASCII");
}

EditHistory::EditHistory(SimulationState& state, Pipeline& pipeline, ScenarioCheck check)
    : state_(state),
      pipeline_(pipeline),
      check_(std::move(check)),
      loose_(state, pipeline),
      population_(state, pipeline) {}

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

/// Plants that are painted from now on may be of other species than those of the present strokes.
void EditHistory::close_plant_strokes() {
  for (const Stroke& stroke : strokes_)
    if (!stroke.species.empty()) close(stroke);
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
  stroke.species.clear();  // there may be more of them than at the edits before
  for (const Species& species : state_.scenario.species) stroke.species.push_back(species.name);
  recount(stroke, before);
  keep_to_memory();
}

EditHistory::Settings EditHistory::settings(SettingScope scope) const {
  if (!remembers() || !settings_remembered_) return {scope, {}, {}};
  return {scope, settings_of(state_, scope), state_.layers_in_use()};
}

void EditHistory::paint(const std::string& name, const Settings& before) {
  if (!remembers() || !settings_remembered_) return;
  std::vector<ChangedSetting> changed = changed_settings(before.texts, settings_of(state_, before.scope));
  if (changed.empty()) return;
  Stroke& stroke = stroke_to_paint(name);
  const std::size_t bytes = stroke.bytes();
  stroke.last_action = ++actions_;
  desert_sim::paint(strokes_, stroke, std::move(changed), actions_);
  for (Layer layer : state_.layers_in_use())
    if (info(layer).lifetime == Lifetime::persistent &&
        std::count(before.layers.begin(), before.layers.end(), layer) == 0)
      stroke.new_layers.push_back(layer);
  recount(stroke, bytes);
  keep_to_memory();
}

int EditHistory::redoable() const {
  return static_cast<int>(
      std::count_if(strokes_.begin(), strokes_.end(), [](const Stroke& s) { return s.undone; }));
}

}  // namespace desert_sim
