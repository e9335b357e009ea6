#pragma once
/// The ground near the camera with what lies between the centres of cells: ripples, and heaps at plants, as
/// wheels and beams feel them. It takes the place of what the blocks of the terrain leave out there
/// (TerrainGrid::hole).

#include <vector>

#include "src/render/mesh.hpp"
#include "src/render/terrain_look.hpp"

namespace desert_sim::render {

/// Heights [m] at points between the centres of cells.
struct NearGround {
  CellRectangle cells;         ///< the centres of its outermost cells are the corners
  int divisions = 1;           ///< steps between the centres of neighbouring cells
  bool ripples = true;         ///< points are close enough to show ripples as shapes
  std::vector<float> heights;  ///< row-major from the south-west corner; NaN: unknown

  bool empty() const { return heights.empty(); }
  int columns() const { return (cells.width - 1) * divisions + 1; }
  int rows() const { return (cells.height - 1) * divisions + 1; }
};

/// Points farther apart than this [m] show nothing that cells do not.
constexpr double coarsest_near_ground = 0.1;

/// Where fine ground is worth drawing: cells around a place, and their divisions. `detail`: the size [m] that
/// is just seen there.
struct NearWindow {
  CellRectangle cells;
  int divisions = 1;
  bool ripples = true;  ///< as in NearGround

  bool empty() const { return cells.empty(); }
  bool operator==(const NearWindow& o) const { return cells == o.cells && divisions == o.divisions; }
};
/// Points lie as far apart as an odd share of a cell, so that the centres of cells are among them; some 160
/// in a row, at least half a centimetre apart, and close enough for ripples of this wavelength [m; 0: there
/// are none] where that takes no more than 2.5 times as many. Empty where they would be farther apart than
/// coarsest_near_ground, or than cells are, and on grids of less than 4 x 4 cells. The window moves in steps
/// of a quarter of its size.
NearWindow near_window(const BlockLayout& layout, double cell_size, double x, double y, double detail,
                       double ripple_wavelength = 0);

/// The mesh of fine ground, with colours between those of the cells around. Towards the edge of the window
/// what is between cells fades, so that its edge is that of the hole in the blocks, to the bit of a float.
/// `grid`, `window` and `look` are those of the blocks. With look.ripples the alpha says where ripples are
/// but a picture: towards the edge, or everywhere if points are too far apart, and then heights are smoothed,
/// so that no waves appear that are none.
Mesh near_ground_mesh(const NearGround& near, const TerrainGrid& grid, const LayerWindow& window,
                      const TerrainLook& look);

}  // namespace desert_sim::render
