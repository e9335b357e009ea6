/// EditHistory: undo and redo.
#include <algorithm>
#include <optional>

#include "src/core/error.hpp"
#include "src/core/quoted.hpp"
#include "src/simulation/undo/changed_cells.hpp"
#include "src/simulation/undo/edit_history.hpp"
#include "src/simulation/undo/material_return.hpp"
#include "src/simulation/undo/painted_layers.hpp"
#include "src/simulation/undo/painted_settings.hpp"

namespace desert_sim {

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

namespace {

const char* verb_of(const Stroke& stroke) { return stroke.undone ? "redo" : "undo"; }

}  // namespace

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

/// Throws ConfigError if the terrain would not have what the stroke changes. `scenario`: under which its
/// plants are to live.
void EditHistory::require_possible(const Stroke& stroke, const Scenario& scenario) const {
  const std::string what = verb_of(stroke);
  for (const MaterialChange& change : stroke.materials)
    if (!state_.terrain.has(change.layer) &&
        std::count(stroke.new_layers.begin(), stroke.new_layers.end(), change.layer) == 0)
      throw ConfigError(
          what + ": " + info(change.layer).name +
          ": is not in use here any more (allowed: after the redo of what brought it into use)");
  require_species(stroke, scenario);
}

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

/// The plants that come back can be what they were: there are their species.
void EditHistory::require_species(const Stroke& stroke, const Scenario& scenario) const {
  if (stroke.plants.removed.empty()) return;
  const std::string what = verb_of(stroke);
  if (!scenario.get<VegetationParameters>().enabled)
    throw ConfigError(
        what + ": vegetation.enabled: plants would come back (allowed: after the edit that cleared them)");
  const std::vector<Species>& present = scenario.species;
  for (const ChangedPlant& plant : stroke.plants.removed) {
    const std::size_t kind = plant.words[static_cast<std::size_t>(plants::Column::species)];
    if (kind >= present.size() || present[kind].name != stroke.species[kind])
      throw ConfigError(what + ": species." + std::to_string(kind) + ": is not " +
                        desert_sim::in_quotes(stroke.species[kind]) + " any more, of which plants are");
  }
}

/// A terrain that did not have a painted layer before its strokes does not have it when all are undone.
void EditHistory::release_layers() {
  for (auto layer = new_layers_.begin(); layer != new_layers_.end();) {
    if (is_used(*layer)) {
      ++layer;
      continue;
    }
    state_.exec().synchronise();  // steps in flight work with it
    state_.terrain.set_allocated(*layer, false);
    layer = new_layers_.erase(layer);
  }
}

bool EditHistory::is_used(Layer layer) const {
  return std::any_of(strokes_.begin(), strokes_.end(),
                     [layer](const Stroke& s) { return !s.undone && s.changed(layer); });
}

/// Nor does it have what settings brought into use, unless material lies there now.
void EditHistory::release_layers_of_settings(const Stroke& stroke) {
  std::vector<Layer> unused;
  for (Layer layer : stroke.new_layers) {
    if (!state_.terrain.has(layer) || pipeline_.writes(layer) || is_used(layer)) continue;
    const std::vector<std::uint32_t> words = state_.terrain.raw_words(layer);
    if (info(layer).storage == Storage::quanta && layer != Layer::burial &&
        std::any_of(words.begin(), words.end(), [](std::uint32_t word) { return word != 0; }))
      return;
    unused.push_back(layer);
  }
  if (unused.empty()) return;
  state_.exec().synchronise();
  for (Layer layer : unused) state_.terrain.set_allocated(layer, false);
  pipeline_.prepare();
}

CommandResult EditHistory::turn(Stroke& stroke, bool with_change) {
  const std::size_t before = stroke.bytes();
  const bool redo = stroke.undone;
  SettingsTurn settings(strokes_, stroke,
                        stroke.settings.empty() ? SettingTexts() : settings_of(state_, SettingScope::all));
  CommandResult result;
  // Whatever can be refused, or needs memory, comes first, so that nothing is half done.
  std::optional<SettingsReturn> returned;
  if (!settings.changes().empty())
    returned.emplace(state_, pipeline_, settings.changes(), check_,
                     redo ? std::vector<int>() : population_.leaving(stroke.plants), verb_of(stroke));
  // Plants come back after settings are redone, and before they are undone.
  const Scenario& of_plants = redo && returned ? returned->scenario() : state_.scenario;
  if (!stroke.plants.empty() && !of_plants.get<VegetationParameters>().enabled)
    throw ConfigError(std::string(verb_of(stroke)) +
                      ": plants: none live here any more (vegetation.enabled)");
  require_possible(stroke, of_plants);
  if (returned) require_possible(stroke, returned->scenario());
  bool settings_set = false;
  std::optional<MaterialTurn> materials;
  std::vector<CellList> painted;
  bool plants_turned = false;
  const auto turn_plants = [&] {
    result.returned.missing_plants = population_.turn_back(stroke.plants);
    plants_turned = true;
  };
  try {
    if (!redo) turn_plants();  // plants are there only while their species are
    if (returned) returned->set();
    settings_set = true;
    prepare(stroke);
    materials.emplace(stroke.materials, state_);
    for (const PaintedLayer& layer : stroke.painted) painted.emplace_back(state_.exec(), cells_of(layer));
    if (redo) turn_plants();
  } catch (...) {
    if (returned && settings_set) returned->roll_back();
    if (plants_turned) population_.turn_back(stroke.plants);
    release_layers();
    throw;
  }
  settings.commit();
  result.returned.settings = describe_settings(settings.changes());
  if (!stroke.settings.empty()) close_plant_strokes();
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
  loose_.returned(stroke, tell(stroke, moved, result), stroke.loose);
  stroke.undone = !stroke.undone;
  stroke.last_action = ++actions_;
  result.returned.name = stroke.name;
  result.changed_cells = cells.rectangle();
  if (with_change) result.changes = cells.changes();
  close(stroke);
  release_layers();
  if (stroke.undone) release_layers_of_settings(stroke);
  recount(stroke, before);
  keep_to_memory();
  result.undoable = undoable();
  result.redoable = redoable();
  return result;
}

/// Tells what was moved of each material. Returns whether nothing was missing.
bool EditHistory::tell(const Stroke& stroke, const MaterialReturns& moved, CommandResult& result) const {
  const double cell = state_.scenario.grid.cell_size,
               quantum = state_.terrain.scale().quantum() * cell * cell;
  const auto volume = [quantum](long long quanta) { return static_cast<double>(quanta) * quantum; };
  bool complete = true;
  for (const MaterialChange& change : stroke.materials) {
    const auto m = static_cast<std::size_t>(material_of(change.layer));
    result.returned.materials[m] = {volume(moved[m].added), volume(moved[m].removed),
                                    volume(moved[m].missing)};
    complete = complete && moved[m].missing == 0;
  }
  return complete;
}

}  // namespace desert_sim
