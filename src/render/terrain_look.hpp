#pragma once
/// A terrain's layers as they are drawn, and the way in which they are to look.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "src/render/block_layout.hpp"
#include "src/render/overlay.hpp"
#include "src/render/palette.hpp"

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
  CellRectangle hole{};  ///< between the centres of its outermost cells there is no ground: near_ground.hpp
};

/// What brightens and darkens the ground.
enum class Shading {
  sun,           ///< that of sunlight.hpp
  illumination,  ///< the layer `illumination`: the mean light of a day, 1 in the open
  both           ///< their product
};

struct TerrainLook {
  Overlay overlay;
  Overlay second;  ///< lies on the first one
  /// If given, the overlays stand side by side instead: the first one in this share of the terrain's width
  /// from the west, the second one in the rest.
  std::optional<double> divide;
  Palette palette;
  Shading shading = Shading::sun;
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

/// The layers that a look needs beside the elevation, the overlay's included, if they are there.
std::vector<std::string> layers_for(const TerrainLook& look);

}  // namespace desert_sim::render
