#pragma once
/// All meshes of one block of terrain, from its layers and the way in which it is to look.

#include <functional>
#include <string>

#include "src/render/overlay.hpp"
#include "src/render/terrain_mesh.hpp"

namespace desert_sim::render {

/// The values of a layer in a rectangle of cells; an empty window if there is no such layer. Layers have the
/// names of config/node_parameters.md, "Layers of maps".
using LayerWindow = std::function<CellWindow(const std::string& layer, const CellRectangle& cells)>;

/// What all blocks of a terrain have in common.
struct TerrainGrid {
  BlockLayout layout;
  double cell_size = 1;  ///< [m]
  float base = 0;        ///< height at which the walls at the edges end [m]; NaN: there are none
  int shadow_reach =
      0;  ///< over how many cells shadows are looked for (render::shadow_reach); 0: none are cast
};

struct TerrainLook {
  Overlay overlay;
  bool materials = true;  ///< else all ground has the colour of sand
  bool water = true;
  bool light = true;    ///< else colours are those of the materials, for who lights them anew
  bool shadows = true;  ///< cast by the ground; without, slopes that look away from the sun are dark alone
  /// The alpha of the ground's vertices says how much of wind ripples is seen there, 0…1; else it is 1.
  bool ripples = false;
  double vertical_exaggeration =
      1;  ///< of what is seen; the meshes have true heights, but the light is that of these
  double contour_interval = 0;  ///< [m]; 0: no contour lines
};

struct TerrainBlock {
  Mesh ground, water, contours;
};

/// How far walls at the edges reach below the lowest cell, over the longer side of the terrain.
constexpr double wall_share = 0.04;
/// The height [m] at which the walls at the edges of a terrain end: below its lowest cell there. It is chosen
/// once for a terrain, so that blocks need not be built anew when the ground moves. NaN if no cell is known.
float base_of_walls(const BlockLayout& layout, double cell_size, const LayerWindow& window);

/// The layers that a look needs beside the elevation, the overlay's included, if they are there.
std::vector<std::string> layers_for(const TerrainLook& look);

TerrainBlock build_terrain_block(const TerrainGrid& grid, int block, int level, const LayerWindow& window,
                                 const TerrainLook& look);

}  // namespace desert_sim::render
