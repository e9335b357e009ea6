#pragma once
/// The maps of a client as the values that meshes are made of.

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "include/desert_sim/client/layer_map.hpp"
#include "src/render/terrain_block.hpp"

namespace desert_sim {

using LayerMaps = std::map<std::string, std::shared_ptr<const LayerMap>>;  ///< by layer

/// A layer that is computed here as ~costmap is.
constexpr const char* cost_layer = "cost";
/// The layer that a node has to send for this one.
std::string source_of_layer(const std::string& layer);

/// Forgets the maps of all other layers: one that is chosen again later begins with a new keyframe.
void keep_layers(const std::vector<std::string>& layers, LayerMaps& maps);

/// A copy of the cells of a rectangle, which must lie in the grid.
std::vector<float> values_in(const LayerMap& map, const render::CellRectangle& cells);

/// The layers of these maps, and those that are computed from them: costs, and the change of the elevation
/// since `reference` (may be null). Maps are immutable and live as long as the function does. Those of
/// another grid than the elevation's, for a moment after a terrain was loaded, do not count.
render::LayerWindow windows_of(const LayerMaps& maps, const std::shared_ptr<const LayerMap>& reference);

}  // namespace desert_sim
