#pragma once
/// Meshes of what messages say, whatever they say: without OGRE, which ends a program whose meshes are not
/// finite, and without ROS.

#include <desert_sim/Plants.h>
#include <desert_sim/WindField.h>

#include <optional>

#include "include/desert_sim/client/layer_map.hpp"
#include "src/render/mesh.hpp"
#include "src/render/plant_tiles.hpp"

namespace desert_sim {

/// At most `most` arrows on this ground, from the south-west corner of the ground [m]; none for a message
/// whose sizes do not fit together, or whose numbers no desert has.
std::optional<render::Mesh> wind_mesh(const WindField& wind, const LayerMap& ground, int most);

/// The plants, relative to the origin of the message, without those that no desert has.
render::PlantTiles plant_tiles(const Plants& plants);

}  // namespace desert_sim
