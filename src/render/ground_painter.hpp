#pragma once
/// The colour and the light of the ground at the vertices of a mesh.

#include "src/render/terrain_colours.hpp"
#include "src/render/terrain_look.hpp"

namespace desert_sim::render {

/// The layers that make the colour of the ground. A terrain of which only the elevation is known is drawn as
/// sand.
class MaterialWindows {
 public:
  MaterialWindows() = default;
  MaterialWindows(const LayerWindow& window, const CellRectangle& cells);

  /// How much of what is below the sand of a cell hides, 0…1.
  float sand_cover(int x, int y) const;
  /// `cover`: that of sand there.
  Colour at(int x, int y, float cover, const Palette& palette) const;

 private:
  CellWindow sand_, soil_;  ///< cover
  CellWindow moisture_, vegetation_, obstacle_, resistance_;
};

/// An overlay on some cells; on none if it is not active, or its layer is not there.
class OverlayOnCells {
 public:
  OverlayOnCells(const Overlay& overlay, const LayerWindow& window, const CellRectangle& cells);
  Colour on(const Colour& ground, int x, int y, float normal_z) const;

 private:
  const Overlay& overlay_;
  bool slope_;
  CellWindow values_;
};

/// How much of ripples is seen, 0…1: on sand that the sun reaches, and not on slip faces, where sand slides.
float ripples_on(float sand_cover, float normal_z, float sun);

class GroundPainter {
 public:
  /// For vertices in the centres of these cells. `elevation` has the heights of cells_that_shade() them, as
  /// far as the grid goes. `look` must outlive the painter.
  GroundPainter(const TerrainGrid& grid, const CellRectangle& vertices, const CellWindow& elevation,
                const LayerWindow& window, const TerrainLook& look);

  float sand_cover(int x, int y) const { return materials_.sand_cover(x, y); }
  /// The colour of a cell without light, with the overlays. `cover`: sand_cover() there.
  Colour colour(int x, int y, float normal_z, float cover) const;
  Colour colour(int x, int y, float normal_z) const { return colour(x, y, normal_z, sand_cover(x, y)); }
  /// The share of the sun that reaches a cell, and the light of a day there.
  float sun(int x, int y) const { return sun_.empty() ? 1.0f : sun_.at(x, y); }
  float day(int x, int y) const { return day_.empty() ? 1.0f : day_.at(x, y); }
  /// The light on a surface of true heights with this upward unit normal.
  Colour light(float normal_x, float normal_y, float normal_z, float sun, float day) const;

 private:
  const TerrainLook& look_;
  const MaterialWindows materials_;
  const OverlayOnCells first_, second_;
  float divide_;  ///< column from which on the second overlay stands alone; NaN: they lie on each other
  CellWindow sun_, day_;
};

}  // namespace desert_sim::render
