#include "src/simulation/commands/edit_checks.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>

#include "src/core/did_you_mean.hpp"
#include "src/core/elementary.hpp"
#include "src/core/joined.hpp"
#include "src/scenario/range_checks.hpp"
#include "src/simulation/commands/edited_layers.hpp"

namespace desert_sim {

namespace {

using command::EditTerrain;
using command::Patch;
using command::Point;

constexpr double max_coordinate = 1e7;   // [m], as of a centre
constexpr double max_pixel_value = 1e5;  // [m], as of a value

void check_layer(const EditTerrain& edit, ValidationErrors& errors) {
  if (find_edited_layer(edit.layer)) return;
  std::vector<std::string> known;
  for (const EditedLayer& row : edited_layers) known.emplace_back(info(row.layer).name);
  errors.add("layer", not_one_of(edit.layer, joined(known)));
}

/// Whether all points lie on one line, or in one place.
bool has_no_area(const std::vector<Point>& points) {
  const Point& first = points.front();
  const auto distance = [&](const Point& p) { return elementary::hypot(p.x - first.x, p.y - first.y); };
  const Point& far = *std::max_element(points.begin(), points.end(), [&](const Point& p, const Point& q) {
    return distance(p) < distance(q);
  });
  const double length = distance(far);
  return std::all_of(points.begin(), points.end(), [&](const Point& p) {
    const double off = (far.x - first.x) * (p.y - first.y) - (far.y - first.y) * (p.x - first.x);
    return std::abs(off) <= 1e-9 * length * length;
  });
}

}  // namespace

void check_points(BrushShape shape, const std::vector<Point>& points, ValidationErrors& errors) {
  const std::size_t given = points.size();
  const bool polygon = shape == BrushShape::polygon, capsule = shape == BrushShape::capsule;
  const std::size_t least = polygon ? 3 : (capsule ? 2 : 0),
                    most = polygon ? EditTerrain::max_points : (capsule ? 2 : 0);
  if (given < least || given > most) {
    errors.add("points", std::to_string(given) + " are given (allowed for this shape: " +
                             (least == most ? std::to_string(least)
                                            : std::to_string(least) + " to " + std::to_string(most)) +
                             ")");
    return;
  }
  for (std::size_t n = 0; n < given; ++n)
    for (const double v : {points[n].x, points[n].y})
      if (!(std::abs(v) <= max_coordinate)) {
        std::ostringstream text;
        text << v << " is not in [" << -max_coordinate << ", " << max_coordinate << "] m";
        errors.add("points[" + std::to_string(n) + "]", text.str());
        return;
      }
  if (polygon && has_no_area(points)) errors.add("points", "all lie on one line, so the polygon has no area");
}

namespace {

void check_patch(const EditTerrain& edit, ValidationErrors& errors) {
  const Patch& patch = edit.patch;
  if (edit.shape != BrushShape::patch) {
    if (!patch.values.empty()) errors.add("patch", "is given, but the shape is not patch");
    return;
  }
  const auto pixels = static_cast<long long>(patch.columns) * patch.rows;
  if (patch.columns < 1 || patch.rows < 1 || pixels > Patch::max_pixels ||
      static_cast<std::size_t>(pixels) != patch.values.size()) {
    errors.add("patch", std::to_string(patch.columns) + " x " + std::to_string(patch.rows) + " with " +
                            std::to_string(patch.values.size()) + " values (allowed: 1 to " +
                            std::to_string(Patch::max_pixels) + " of them, as many as its size says)");
    return;
  }
  const bool mask = edit.patch_use == PatchUse::mask;
  const double low = mask ? 0 : -max_pixel_value, high = mask ? 1 : max_pixel_value;
  for (std::size_t n = 0; n < patch.values.size(); ++n)
    if (!(patch.values[n] >= low && patch.values[n] <= high)) {
      const auto columns = static_cast<std::size_t>(patch.columns);
      std::ostringstream text;
      text << "column " << n % columns << ", row " << n / columns << ": " << patch.values[n] << " is not in ["
           << low << ", " << high << "]" << (mask ? "" : " m");
      errors.add("patch", text.str());
      return;
    }
}

/// What is no material has a range, and so has what a brush says of it; what add and sub change it by is at
/// most its width, and of a patch may be negative.
void check_number(const EditTerrain& edit, const LayerInfo& layer, ValidationErrors& errors) {
  if (edit.conserve) errors.add("conserve", edit.layer + " is no material that a ring could give or take");
  if (edit.merge == BrushMerge::smooth) return;
  const bool heights = edit.shape == BrushShape::patch && edit.patch_use == PatchUse::heights;
  const bool shift = edit.merge == BrushMerge::add || edit.merge == BrushMerge::sub;
  const double width = layer.highest - layer.lowest;
  const double least = !shift ? layer.lowest : (heights ? -width : 0), most = shift ? width : layer.highest;
  double lowest = edit.value, highest = edit.value;
  if (heights && !edit.patch.values.empty()) {
    const auto [low, high] = std::minmax_element(edit.patch.values.begin(), edit.patch.values.end());
    lowest += *low, highest += *high;
  }
  if (lowest >= least && highest <= most) return;
  std::ostringstream text;
  text << (highest > most ? highest : lowest) << (heights ? " with the patch's values" : "")
       << " is not a value of " << edit.layer << " (allowed: [" << least << ", " << most << "])";
  errors.add("value", text.str());
}

/// Depths are not negative. The heights of a patch may be with add and sub: they take what add gives.
void check_depth(const EditTerrain& edit, ValidationErrors& errors) {
  if (edit.layer == "bedrock" || edit.merge == BrushMerge::smooth) return;
  const bool heights = edit.shape == BrushShape::patch && edit.patch_use == PatchUse::heights;
  const bool shift = edit.merge == BrushMerge::add || edit.merge == BrushMerge::sub;
  if (heights && shift) return;
  double lowest = edit.value;
  if (heights && !edit.patch.values.empty())
    lowest += *std::min_element(edit.patch.values.begin(), edit.patch.values.end());
  if (lowest < 0)
    errors.add("value", std::to_string(lowest) + (heights ? " with the patch's lowest height" : "") +
                            " is not a depth of " + edit.layer + " (allowed: [0, 100000] m)");
}

}  // namespace

void require_layer(const EditTerrain& edit, const Terrain& terrain) {
  const EditedLayer& row = *find_edited_layer(edit.layer);
  if (row.scenarios && !terrain.has(row.layer))
    throw ConfigError("edit_terrain: layer: " + edit.layer + ": this terrain has no layer " + edit.layer +
                      " (a scenario " + row.scenarios + " has)");
}

void require_still_plants(const EditTerrain& edit, const Scenario& scenario) {
  if (edit.layer == info(Layer::vegetation).name && scenario.get<VegetationParameters>().enabled)
    throw ConfigError(
        "edit_terrain: layer: vegetation is what the living plants cover (vegetation.enabled); edit_plants "
        "plants and clears them");
}

void check_edit(const EditTerrain& edit) {
  check_ranges(static_cast<const command::EditParameters&>(edit), "edit_terrain");
  ValidationErrors errors("edit_terrain");
  check_layer(edit, errors);
  check_points(edit.shape, edit.points, errors);
  check_patch(edit, errors);
  errors.throw_if_any();
  const EditedLayer& row = *find_edited_layer(edit.layer);
  if (row.kind != EditKind::material)
    check_number(edit, info(row.layer), errors);
  else
    check_depth(edit, errors);
  errors.throw_if_any();
}

}  // namespace desert_sim
