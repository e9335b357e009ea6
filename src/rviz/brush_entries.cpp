#include "src/rviz/brush_entries.hpp"

#include <yaml-cpp/yaml.h>

#include <cmath>

#include "src/core/shortest_decimal.hpp"
#include "src/rviz/timeline_entries.hpp"
#include "src/simulation/commands/command.hpp"

namespace desert_sim {

namespace {

double to_millimetres(double metres) { return std::round(metres * 1000) / 1000; }
/// A number of a property of rviz, which are floats.
double as_typed(double number) { return shortest_decimal(static_cast<float>(number)); }

/// The value of an enumeration by its name; the first one without a name, as the services have it.
template <class Enum, int N>
Enum choice(const std::string& name, const char* const (&names)[N]) {
  int n = 0;
  while (n < N && name != names[n]) ++n;
  return static_cast<Enum>(n < N ? n : 0);
}

/// Where, which both requests say alike.
template <class Request, class Edit>
void set_place(const Request& request, Edit& edit) {
  edit.shape = choice<BrushShape>(request.shape, brush_shapes);
  edit.radius = as_typed(request.radius);
  edit.x = to_millimetres(request.center.x);
  edit.y = to_millimetres(request.center.y);
  for (const geometry_msgs::Point& point : request.points)
    edit.points.push_back({to_millimetres(point.x), to_millimetres(point.y)});
}

/// What differs from the defaults, and all names that are given.
template <class P>
void emit_given(YAML::Emitter& out, const P& parameters) {
  const P defaults;
  const auto emit = [&](const auto& row) {
    const auto& value = parameters.*(row.member);
    using T = std::decay_t<decltype(value)>;
    bool given = value != defaults.*(row.member);
    if constexpr (std::is_same_v<T, std::string>) given = !value.empty();
    if (!given) return;
    out << YAML::Key << row.name << YAML::Value;
    if constexpr (std::is_enum_v<T>)
      out << row.choices[static_cast<int>(value)];
    else
      out << value;
  };
  std::apply([&](const auto&... rows) { (emit(rows), ...); }, table_of<P>());
}

template <class Parameters, class Edit>
std::string entry_text(const Brush::Later& later, double now, const Edit& edit) {
  YAML::Emitter out;
  out.SetDoublePrecision(12);
  out << YAML::Flow << YAML::BeginMap << YAML::Key << "time" << YAML::Value
      << (later.from_now ? now : 0) + later.time;
  if (later.every > 0) out << YAML::Key << "every" << YAML::Value << later.every;
  if (later.until > 0) out << YAML::Key << "until" << YAML::Value << later.until;
  out << YAML::Key << "command" << YAML::Value << Edit::name;
  emit_given(out, static_cast<const Parameters&>(edit));
  if (!edit.points.empty()) {
    out << YAML::Key << "points" << YAML::Value << YAML::BeginSeq;
    for (const command::Point& point : edit.points)
      out << YAML::BeginSeq << point.x << point.y << YAML::EndSeq;
    out << YAML::EndSeq;
  }
  out << YAML::EndMap;
  return out.c_str();
}

}  // namespace

std::string timeline_entry(const Brush::Later& later, double now, const EditTerrain::Request& request) {
  command::EditTerrain edit;
  set_place(request, edit);
  edit.layer = request.layer;
  edit.merge = choice<BrushMerge>(request.merge, brush_merges);
  edit.inner = as_typed(request.inner);
  edit.value = as_typed(request.value);
  if (edit.merge == BrushMerge::smooth) {
    edit.smooth_radius = as_typed(request.smooth_radius);
    edit.smooth_passes = request.smooth_passes;
  }
  return entry_text<command::EditParameters>(later, now, edit);
}

std::string timeline_entry(const Brush::Later& later, double now, const EditPlants::Request& request) {
  command::EditPlants edit;
  set_place(request, edit);
  edit.operation = choice<PlantEdit>(request.operation, plant_edits);
  edit.species = request.species;
  if (edit.operation == PlantEdit::plant) {
    edit.density = as_typed(request.density);
    edit.size = as_typed(request.size);
    edit.seed = request.seed;
  }
  return entry_text<command::EditPlantsParameters>(later, now, edit);
}

}  // namespace desert_sim
