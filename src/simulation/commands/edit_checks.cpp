#include "src/simulation/commands/edit_checks.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "src/core/quoted.hpp"
#include "src/simulation/commands/command_checks.hpp"

namespace desert_sim {

namespace {

using command::EditTerrain;
using command::Patch;
using command::Place;

constexpr double farthest = 1e7;       // [m], as of a centre
constexpr double highest_pixel = 1e5;  // [m], as of a value

void check_layer(const EditTerrain& edit, const Terrain& terrain, Faults& faults) {
  if (edit.layer != "sand" && edit.layer != "soil" && edit.layer != "bedrock" && edit.layer != "water")
    faults.add("layer", quoted(edit.layer) + " is not one of: sand, bedrock, soil, water");
  if (edit.layer == "water" && !terrain.has(Layer::water))
    faults.add("layer",
               "water: this terrain has none (a scenario with rain, springs, a sea or the layer water has)");
  if (edit.layer == "soil" && !terrain.has(Layer::soil))
    faults.add("layer", "soil: this terrain has none (a scenario that fills the layer soil has)");
}

/// Whether all points lie on one line, or in one place.
bool without_area(const std::vector<Place>& points) {
  const Place& first = points.front();
  const auto distance = [&](const Place& p) { return std::hypot(p.x - first.x, p.y - first.y); };
  const Place& far = *std::max_element(points.begin(), points.end(), [&](const Place& p, const Place& q) {
    return distance(p) < distance(q);
  });
  const double length = distance(far);
  return std::all_of(points.begin(), points.end(), [&](const Place& p) {
    const double off = (far.x - first.x) * (p.y - first.y) - (far.y - first.y) * (p.x - first.x);
    return std::abs(off) <= 1e-9 * length * length;
  });
}

}  // namespace

void check_points(BrushShape shape, const std::vector<Place>& points, Faults& faults) {
  const std::size_t given = points.size();
  const bool polygon = shape == BrushShape::polygon, capsule = shape == BrushShape::capsule;
  const std::size_t least = polygon ? 3 : (capsule ? 2 : 0),
                    most = polygon ? EditTerrain::max_points : (capsule ? 2 : 0);
  if (given < least || given > most) {
    faults.add("points", std::to_string(given) + " are given (allowed for this shape: " +
                             (least == most ? std::to_string(least)
                                            : std::to_string(least) + " to " + std::to_string(most)) +
                             ")");
    return;
  }
  for (std::size_t n = 0; n < given; ++n)
    for (const double v : {points[n].x, points[n].y})
      if (!(std::abs(v) <= farthest)) {
        std::ostringstream text;
        text << "= " << v << " is not in [" << -farthest << ", " << farthest << "] m";
        faults.add("points[" + std::to_string(n) + "]", text.str());
        return;
      }
  if (polygon && without_area(points)) faults.add("points", "all lie on one line: no area is inside");
}

namespace {

void check_patch(const EditTerrain& edit, Faults& faults) {
  const Patch& patch = edit.patch;
  if (edit.shape != BrushShape::patch) {
    if (!patch.values.empty()) faults.add("patch", "is given to another shape");
    return;
  }
  const auto pixels = static_cast<long long>(patch.columns) * patch.rows;
  if (patch.columns < 1 || patch.rows < 1 || pixels > Patch::max_pixels ||
      static_cast<std::size_t>(pixels) != patch.values.size()) {
    faults.add("patch", std::to_string(patch.columns) + " x " + std::to_string(patch.rows) + " with " +
                            std::to_string(patch.values.size()) + " values (allowed: 1 to " +
                            std::to_string(Patch::max_pixels) + " of them, as many as its size says)");
    return;
  }
  const bool mask = edit.patch_use == PatchUse::mask;
  const double low = mask ? 0 : -highest_pixel, high = mask ? 1 : highest_pixel;
  for (std::size_t n = 0; n < patch.values.size(); ++n)
    if (!(patch.values[n] >= low && patch.values[n] <= high)) {
      const auto columns = static_cast<std::size_t>(patch.columns);
      std::ostringstream text;
      text << "column " << n % columns << ", row " << n / columns << ": = " << patch.values[n]
           << " is not in [" << low << ", " << high << "]" << (mask ? "" : " m");
      faults.add("patch", text.str());
      return;
    }
}

/// Depths are not negative. The heights of a patch may be with add and sub: they take what add gives.
void check_depth(const EditTerrain& edit, Faults& faults) {
  if (edit.layer == "bedrock" || edit.merge == BrushMerge::smooth) return;
  const bool heights = edit.shape == BrushShape::patch && edit.patch_use == PatchUse::heights;
  const bool shift = edit.merge == BrushMerge::add || edit.merge == BrushMerge::sub;
  if (heights && shift) return;
  double lowest = edit.value;
  if (heights && !edit.patch.values.empty())
    lowest += *std::min_element(edit.patch.values.begin(), edit.patch.values.end());
  if (lowest < 0)
    faults.add("value", "= " + std::to_string(lowest) + (heights ? " with the patch's lowest height" : "") +
                            " is not a depth of " + edit.layer + " (allowed: [0, 100000] m)");
}

}  // namespace

void check_edit(const EditTerrain& edit, const Terrain& terrain) {
  check_ranges(static_cast<const command::EditParameters&>(edit), "edit_terrain");
  Faults faults("edit_terrain");
  check_layer(edit, terrain, faults);
  check_points(edit.shape, edit.points, faults);
  check_patch(edit, faults);
  faults.throw_if_any();
  check_depth(edit, faults);
  faults.throw_if_any();
}

}  // namespace desert_sim
