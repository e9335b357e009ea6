#pragma once
/// All meshes of one block of terrain, from its layers and the way in which it is to look.

#include "src/render/terrain_look.hpp"
#include "src/render/terrain_mesh.hpp"

namespace desert_sim::render {

struct TerrainBlock {
  Mesh ground, water, contours;
};

/// How far walls at the edges reach below the lowest cell, over the longer side of the terrain.
constexpr double wall_share = 0.04;
/// The height [m] at which the walls at the edges of a terrain end: below its lowest cell there. It is chosen
/// once for a terrain, so that blocks need not be built anew when the ground moves. NaN if no cell is known.
float base_of_walls(const BlockLayout& layout, double cell_size, const LayerWindow& window);

TerrainBlock build_terrain_block(const TerrainGrid& grid, int block, int level, const LayerWindow& window,
                                 const TerrainLook& look);

}  // namespace desert_sim::render
