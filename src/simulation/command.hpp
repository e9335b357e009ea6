#pragma once
/// Commands: what changes a running simulation from outside. They are applied between steps, refused whole or
/// applied whole, and journalled. Positions are in the terrain's frame [m].

#include <string>
#include <variant>
#include <vector>

#include "desert_sim/kernels/brush.hpp"
#include "desert_sim/kernels/layers.hpp"
#include "desert_sim/simulation/wind_regime.hpp"

namespace desert_sim {

enum class BrushShape : int { circle, ellipse };
constexpr const char* brush_shapes[] = {"circle", "ellipse"};

/// The commands themselves; a namespace of their own because the ROS services have the same names.
namespace command {

/// The high-altitude wind from now on: constant, reached over `ramp` seconds.
struct SetWind {
  float direction_deg = 0;
  float speed = 0;
  float ramp = 0;
};
constexpr auto parameter_table(const SetWind*) {
  using P = SetWind;
  return std::make_tuple(parameter("direction_deg", &P::direction_deg, -360, 360, "deg",
                                   "Where the wind blows to, counter-clockwise from +x."),
                         parameter("speed", &P::speed, 0, 100, "m/s", "Speed high above the ground."),
                         parameter("ramp", &P::ramp, 0, 1e12, "s", "Time in which the wind changes."));
}
static_assert(table_is_complete<SetWind>());

/// A timeline or rose from now on (`regime.kind` says which; `start_time` and `from` are filled in when
/// applied).
struct SetWindSchedule {
  WindRegime regime;
};

/// Brush on `layer` (sand or bedrock). Weight is 1 within `inner` of the shape and falls linearly to 0 at its
/// edge; add and sub move the layer by weight·value, the others blend towards value (or its min, max, mean
/// with what is there) by the weight. For sand, `value` is a depth [m]; for bedrock an elevation [m], or with
/// add/sub a change.
struct EditTerrain {
  std::string layer = "sand";
  BrushShape shape = BrushShape::circle;
  BrushMerge merge = BrushMerge::add;
  double x = 0, y = 0;
  double radius = 1;
  double radius_y = 1;
  double angle_deg = 0;
  double inner = 0;
  double value = 0;
};
constexpr auto parameter_table(const EditTerrain*) {
  using P = EditTerrain;
  return std::make_tuple(
      parameter("layer", &P::layer, "sand or bedrock."),
      parameter("shape", &P::shape, brush_shapes, "Shape of the brush."),
      parameter("merge", &P::merge, brush_merges, "How the brush meets what is there."),
      parameter("x", &P::x, -1e7, 1e7, "m", "Centre, in the terrain's frame."),
      parameter("y", &P::y, -1e7, 1e7, "m", "Centre, in the terrain's frame."),
      parameter("radius", &P::radius, 1e-3, 1e6, "m", "Radius; of an ellipse the semi-axis along its angle."),
      parameter("radius_y", &P::radius_y, 1e-3, 1e6, "m", "Of an ellipse the semi-axis across."),
      parameter("angle_deg", &P::angle_deg, -360, 360, "deg",
                "Direction of an ellipse's first axis, counter-clockwise from +x."),
      parameter("inner", &P::inner, 0, 1, "1", "Share of the radius within which the brush has full weight."),
      parameter("value", &P::value, -1e5, 1e5, "m", "Height or depth of the brush; see merge."));
}
static_assert(table_is_complete<EditTerrain>());

/// Parameters that can change while a simulation runs (live_parameters.hpp), each "path=value"; all or none.
struct SetParameters {
  std::vector<std::string> settings;
};

/// Back to the scenario's start: terrain, parameters, wind, clock.
struct Reset {};

/// Continue from a checkpoint of a terrain of any shape. `path` as the process can open it.
struct LoadCheckpoint {
  std::string path;
  std::uint64_t hash = 0;  ///< state hash after loading; 0 if not known yet. A replay refuses another one.
};

}  // namespace command

using Command = std::variant<command::SetWind, command::SetWindSchedule, command::EditTerrain,
                             command::SetParameters, command::Reset, command::LoadCheckpoint>;

/// Cells that a command changed: x0 ≤ x < x1, y0 ≤ y < y1 (empty if x1 ≤ x0).
struct CellRectangle {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

struct CommandResult {
  double volume_m3 = 0;  ///< material added (+) or removed (−) by an edit
  CellRectangle touched;
};

}  // namespace desert_sim
