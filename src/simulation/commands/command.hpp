#pragma once
/// Commands: what changes a running simulation from outside. They are applied between steps, refused whole or
/// applied whole, and journalled. Positions are in the terrain's frame [m].

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "kernels/edit/brush.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/wind/wind_features.hpp"
#include "src/scenario/wind_regime.hpp"

namespace desert_sim {

enum class WindEdit : int { add, change, remove, clear };
constexpr const char* wind_edits[] = {"add", "change", "remove", "clear"};

enum class PlantEdit : int { plant, clear };
constexpr const char* plant_edits[] = {"plant", "clear"};

/// The commands themselves, each with its name in the journal; a namespace of their own because the ROS
/// services have the same names.
namespace command {

/// The high-altitude wind from now on: constant, reached over `ramp` seconds.
struct SetWind {
  static constexpr const char* name = "set_wind";
  float direction_deg = 0;
  float speed = 0;
  float ramp = 0;
  std::string stroke{};
};
constexpr auto parameter_table(const SetWind*) {
  using P = SetWind;
  return std::make_tuple(parameter("direction_deg", &P::direction_deg, -360, 360, "deg",
                                   "Where the wind blows to, counter-clockwise from +x."),
                         parameter("speed", &P::speed, 0, 100, "m/s", "Speed high above the ground."),
                         parameter("ramp", &P::ramp, 0, 1e12, "s", "Time in which the wind changes."),
                         parameter("stroke", &P::stroke, "As of edit_terrain."));
}
static_assert(table_is_complete<SetWind>());

/// A timeline or rose from now on (`regime.kind` says which; `start_time` and `initial_wind` are set when the
/// command is applied).
struct SetWindSchedule {
  static constexpr const char* name = "set_wind_schedule";
  WindRegime regime;
  std::string stroke{};
};

/// Adds, changes, removes one local feature of the wind, which `feature.id` names, or removes all (`clear`).
/// A scenario holds at most max_wind_features.
struct EditWind {
  static constexpr const char* name = "edit_wind";
  WindEdit operation = WindEdit::add;
  WindFeature feature{};  ///< of remove only `id`, of clear nothing
  std::string stroke{};
};
constexpr auto parameter_table(const EditWind*) {
  using P = EditWind;
  return std::make_tuple(
      parameter("operation", &P::operation, wind_edits, "What is done with the feature of this id."),
      parameter("stroke", &P::stroke, "As of edit_terrain."));
}

struct EditParameters {
  std::string layer = "sand";
  BrushShape shape = BrushShape::circle;
  BrushMerge merge = BrushMerge::add;
  double x = 0, y = 0;
  double radius = 1;
  double radius_y = 1;
  double angle_deg = 0;
  double inner = 0;
  double falloff = 0;
  double value = 0;
  PatchUse patch_use = PatchUse::heights;
  double smooth_radius = 1;
  int smooth_passes = 1;
  bool conserve = false;
  double ring_width = 1;
  std::string stroke;
};
constexpr auto parameter_table(const EditParameters*) {
  using P = EditParameters;
  return std::make_tuple(
      parameter("layer", &P::layer,
                "sand, bedrock, soil, water, moisture, airborne_sand, obstacle, vegetation, "
                "erosion_resistance, humus, "
                "grass, mesquite, shrub, snow_density or looseness."),
      parameter("shape", &P::shape, brush_shapes, "Shape of the brush."),
      parameter("merge", &P::merge, brush_merges, "How the brush meets what is there."),
      parameter("x", &P::x, -1e7, 1e7, "m", "Centre, in the terrain's frame."),
      parameter("y", &P::y, -1e7, 1e7, "m", "Centre, in the terrain's frame."),
      parameter(
          "radius", &P::radius, 1e-3, 1e6, "m",
          "Radius; of an ellipse the semi-axis and of a rectangle or patch half the side along its angle."),
      parameter("radius_y", &P::radius_y, 1e-3, 1e6, "m", "The semi-axis or half the side across."),
      parameter("angle_deg", &P::angle_deg, -360, 360, "deg",
                "Direction of the first axis, counter-clockwise from +x."),
      parameter(
          "inner", &P::inner, 0, 1, "1",
          "Share of the radius (of a rectangle, of half its sides) within which the brush has full weight."),
      parameter("falloff", &P::falloff, 0, 1e6, "m",
                "Of a polygon or patch: how far inside its edge the brush has full weight."),
      parameter(
          "value", &P::value, -1e5, 1e5, "m",
          "Height or depth of the brush; see merge. Of what is no material a value of the layer, in its "
          "unit."),
      parameter("patch_use", &P::patch_use, patch_uses,
                "Whether a patch holds heights that are added to value, or weights."),
      parameter("smooth_radius", &P::smooth_radius, 1e-3, 1e6, "m",
                "Half the width of the square over which smooth takes means, at most 64 cells."),
      parameter("smooth_passes", &P::smooth_passes, 1, 16, "1", "How often smooth takes means."),
      parameter("conserve", &P::conserve,
                "Take from, or give to, a ring around the shape what the edit adds or removes."),
      parameter("ring_width", &P::ring_width, 1e-3, 1e6, "m", "Width of that ring."),
      parameter("stroke", &P::stroke, "Edits of one name are undone together; empty: this one alone."));
}
static_assert(table_is_complete<EditParameters>());

/// A place in the terrain's frame [m].
struct Point {
  double x = 0, y = 0;
};

/// A picture of heights [m] or weights (0 … 1), row-major; its top row first, as in an image.
struct Patch {
  static constexpr int max_pixels = 1 << 20;
  int columns = 0, rows = 0;
  std::vector<float> values;
};

/// A brush on `layer`, one of edited_layers. The weight of the shape and what a merge does with it are in
/// kernels/edit/brush_shape.hpp and brush.hpp. For materials `value` is a depth [m]; for bedrock an elevation
/// [m], or with add and sub a change. With `conserve`, the material comes from, or goes to, the cells within
/// `ring_width` of the shape: what is taken in proportion to what they have, of bedrock and what is given in
/// equal parts. The sum of all changes is then 0, to the quantum. What is no material (vegetation is the
/// density of plants that do not live) has values in the layer's range, cannot be conserved, and is kept in
/// steps of 2⁻²⁰, of snow_density of 2⁻¹⁴, of humus in quanta.
/// Edits of looseness are no strokes that undo knows, because the sand that moves changes it besides.
struct EditTerrain : EditParameters {
  static constexpr const char* name = "edit_terrain";
  static constexpr std::size_t max_points = 512;
  std::vector<Point> points;  ///< of a polygon its corners, of a capsule the two ends of its axis
  Patch patch;
};

struct EditPlantsParameters {
  PlantEdit operation = PlantEdit::plant;
  std::string species;
  BrushShape shape = BrushShape::circle;
  double x = 0, y = 0;
  double radius = 1;
  double radius_y = 1;
  double angle_deg = 0;
  double density = 0.1;
  double size = 0.05;
  std::uint64_t seed = 0;
  std::string stroke;
};
constexpr auto parameter_table(const EditPlantsParameters*) {
  using P = EditPlantsParameters;
  return std::make_tuple(
      parameter("operation", &P::operation, plant_edits, "What is done in the region."),
      parameter("species", &P::species, "By name; to clear, empty means all."),
      parameter("shape", &P::shape, brush_shapes, "Shape of the region; not patch."),
      parameter("x", &P::x, -1e7, 1e7, "m", "Centre, in the terrain's frame."),
      parameter("y", &P::y, -1e7, 1e7, "m", "Centre, in the terrain's frame."),
      parameter("radius", &P::radius, 1e-3, 1e6, "m", "As of edit_terrain."),
      parameter("radius_y", &P::radius_y, 1e-3, 1e6, "m", "The semi-axis or half the side across."),
      parameter("angle_deg", &P::angle_deg, -360, 360, "deg",
                "Direction of the first axis, counter-clockwise from +x."),
      parameter("density", &P::density, 0, 1000, "1/m^2", "Plants that are put on a square metre."),
      parameter("size", &P::size, 1e-3, 1, "1",
                "Their radius as a share of the widest that there is room for."),
      parameter("seed", &P::seed, 0, highest_uint64, "1", "Of their places; added to the scenario's."),
      parameter("stroke", &P::stroke, "As of edit_terrain."));
}
static_assert(table_is_complete<EditPlantsParameters>());

/// Puts healthy plants of a species at random places of a region, or takes plants away that stand there. None
/// are put on bare rock or on obstacles; whether they can live there is not asked.
struct EditPlants : EditPlantsParameters {
  static constexpr const char* name = "edit_plants";
  std::vector<Point> points;  ///< of a polygon its corners, of a capsule the two ends of its axis
};

/// Takes back what a stroke of edits and settings changed: of the stroke of that name, or, if it is empty, of
/// the one that was painted or redone last. See EditHistory. Where there is none, and the name is empty, it
/// takes back the reset or load that came last (see FormerScenes).
struct Undo {
  static constexpr const char* name = "undo";
  std::string stroke;
};
constexpr auto parameter_table(const Undo*) {
  return std::make_tuple(parameter("stroke", &Undo::stroke, "Name; empty: the newest."));
}
static_assert(table_is_complete<Undo>());

/// Takes back an undo: of the stroke of that name, or, if it is empty, of the one that was undone last; where
/// there is none, of a reset or load.
struct Redo {
  static constexpr const char* name = "redo";
  std::string stroke;
};
constexpr auto parameter_table(const Redo*) {
  return std::make_tuple(parameter("stroke", &Redo::stroke, "Name; empty: the one undone last."));
}
static_assert(table_is_complete<Redo>());

/// Parameters that can change while a simulation runs (live_parameters.hpp), each "path=value"; all or none.
/// Over `ramp` seconds numbers go to their values (see Ramp); all else changes at once.
struct SetParameters {
  static constexpr const char* name = "set_parameters";
  static constexpr double longest_ramp = 1e12;
  std::vector<std::string> settings;
  double ramp = 0;
  std::string stroke{};
};

/// Back to the scenario's start: terrain, parameters, wind, clock.
struct Reset {
  static constexpr const char* name = "reset";
};

/// Continue from a checkpoint of a terrain of any shape; a reset goes back to the start of its scenario from
/// then on. `path` as the process can open it.
struct LoadCheckpoint {
  static constexpr const char* name = "load_checkpoint";
  std::string path;
  std::uint64_t hash = 0;  ///< state hash after loading; 0 if not known yet. A replay refuses another one.
};

/// Another scenario from its start; with `terrain_only`, only its grid and terrain under the physics and wind
/// of the present one. A reset goes back to it from then on. `path` as the process can open it; with
/// `terrain_only` it may be a bag (see scenario_from_bands()), whose gaps `fill_nodata` fills. `hash` as in
/// LoadCheckpoint. `settings` ("grid.width=512") override keys of it. `yaml`, if it is not empty, is what the
/// file would have: then there is none, and `path` only says where files that it names begin, and its name.
struct LoadScenario {
  static constexpr const char* name = "load_scenario";
  std::string path;
  bool terrain_only = false;
  std::uint64_t hash = 0;
  bool fill_nodata = false;
  std::vector<std::string> settings{};
  std::string yaml{};
  /// The file lies below this folder instead of the one that Session::confine_commands() was told; empty: it
  /// does not. A journal does not have it, because a replay is not confined.
  std::string folder{};
};

}  // namespace command

using Command =
    std::variant<command::SetWind, command::SetWindSchedule, command::EditWind, command::EditTerrain,
                 command::EditPlants, command::Undo, command::Redo, command::SetParameters, command::Reset,
                 command::LoadCheckpoint, command::LoadScenario>;

/// Cells that a command changed: x0 ≤ x < x1, y0 ≤ y < y1 (empty if x1 ≤ x0).
struct CellRectangle {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

/// What an edit changed in a layer, cell by cell.
struct LayerChange {
  std::string layer;
  double x = 0, y = 0, cell_size = 0;  ///< lower left corner and cells of the rectangle [m]
  std::vector<float> values;           ///< new − old [unit of the layer], row-major
};

/// What an undo or redo did.
struct ReturnedStroke {
  struct Volumes {
    double added_m3 = 0, removed_m3 = 0;  ///< over the cells that got some, and those that lost some
    double missing_m3 = 0;                ///< what cells did not have any more, or had no room for
  };
  std::string name;
  std::array<std::optional<Volumes>, material_count> materials;  ///< of those that the stroke had changed
  long long missing_plants = 0;  ///< that have died or were cleared since, or for which there was no room
  std::vector<std::string> settings;  ///< "path=value" or "path removed" of what was set
};

struct CommandResult {
  double volume_m3 = 0;  ///< material added (+) or removed (−) by an edit
  double moved_m3 =
      0;  ///< instead of it, of an edit that conserves: from the ring into the shape (+), or back
  long long plants = 0;           ///< put (+) or taken away (−)
  bool replaces_terrain = false;  ///< perhaps by one of another shape
  CellRectangle changed_cells;
  std::vector<LayerChange> changes;  ///< in `changed_cells`; of an undo one a layer; empty if nobody asked
  ReturnedStroke returned;           ///< of an undo or redo
  int undoable = 0, redoable = 0;    ///< of an undo or redo: strokes that can be undone, and redone, after it
};

}  // namespace desert_sim
