#pragma once
/// The layers that edit_terrain takes, and what kind of number each has.

#include <algorithm>
#include <iterator>
#include <string>

#include "kernels/field/layers.hpp"

namespace desert_sim {

enum class EditKind {
  material,  ///< a depth or, of bedrock, an elevation [m], in whole quanta; the ledger books what an edit
             ///< brings or takes
  painted,   ///< a number in the layer's range: a cell is what the newest stroke says, unless a process has
             ///< changed it since; an undo brings back what was there before the stroke
  fleeting   ///< likewise, but its edits cannot be undone
};

struct EditedLayer {
  Layer layer;
  EditKind kind;
  /// Which scenarios have the layer, where an edit does not bring it into use; null: it does, or all have it.
  const char* scenarios;
};

constexpr EditedLayer edited_layers[] = {
    {Layer::sand, EditKind::material, nullptr},
    {Layer::bedrock, EditKind::material, nullptr},
    {Layer::soil, EditKind::material, "with a step that fills soil"},
    {Layer::water, EditKind::material, "with rain, springs, a sea or a step that fills water"},
    {Layer::moisture, EditKind::material, "with moisture.enabled or a step that fills moisture"},
    {Layer::airborne_sand, EditKind::material, nullptr},
    {Layer::obstacle, EditKind::painted, nullptr},
    {Layer::vegetation, EditKind::painted, nullptr},
    {Layer::erosion_resistance, EditKind::painted, nullptr},
    {Layer::humus, EditKind::painted, "with vegetation.enabled or a step that fills humus"},
    {Layer::grass, EditKind::painted, "with sand.model nield_baas"},
    {Layer::mesquite, EditKind::painted, "with sand.model nield_baas"},
    {Layer::shrub, EditKind::painted, "with sand.model nield_baas"},
    {Layer::snow_density, EditKind::painted, "with sand.model snow"},
    {Layer::looseness, EditKind::fleeting, "with looseness.enabled or a step that fills looseness"},
};

/// Null if the layer cannot be edited.
inline const EditedLayer* find_edited_layer(const std::string& name) {
  const auto* const found =
      std::find_if(std::begin(edited_layers), std::end(edited_layers),
                   [&](const EditedLayer& row) { return name == info(row.layer).name; });
  return found == std::end(edited_layers) ? nullptr : found;
}
inline EditKind edit_kind(Layer layer) { return find_edited_layer(info(layer).name)->kind; }

/// Steps in which a brush edits a layer of real numbers: powers of two, of which floats represent every
/// multiple in the layer's range.
constexpr double steps_per_unit(Layer layer) { return layer == Layer::snow_density ? 1 << 14 : 1 << 20; }

}  // namespace desert_sim
