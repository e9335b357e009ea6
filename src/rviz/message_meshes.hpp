#pragma once
/// Meshes of what messages say, whatever they say: without OGRE, which ends a program whose meshes are not
/// finite, and without ROS.

#include <desert_sim/Plants.h>
#include <desert_sim/WindField.h>

#include <cstddef>
#include <optional>

#include "include/desert_sim/client/layer_map.hpp"
#include "src/render/mesh.hpp"

namespace desert_sim {

/// At most `most` arrows on this ground, from the south-west corner of the ground [m]; none for a message
/// whose sizes do not fit together, or whose numbers no desert has.
std::optional<render::Mesh> wind_mesh(const WindField& wind, const LayerMap& ground, int most);

struct PlantsMesh {
  render::Mesh mesh;
  std::size_t plants = 0;  ///< that are in it
};
/// The widest `most` plants, without those that no desert has. `corner_x`, `corner_y`: where the origin of
/// the mesh lies in the terrain's frame [m].
PlantsMesh plants_mesh(const Plants& plants, double corner_x, double corner_y, double vertical_exaggeration,
                       int most);

}  // namespace desert_sim
