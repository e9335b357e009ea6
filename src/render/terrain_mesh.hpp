#pragma once
/// Meshes of one block of a surface: of the ground, or of water. Vertices are the centres of every 2^level-th
/// cell, so that those of a coarse level are among those of all finer ones; x and y are relative to the
/// corner of the grid, where floating-point numbers are fine enough.
///
/// Between blocks of different levels there would be cracks, because the finer one has vertices on the common
/// edge that the coarser one leaves out. Each block has skirts there: vertical strips from the edge down to
/// its lowest cell nearby. On both sides the drawn edge lies between the lowest and the highest cell there,
/// so that what is between the two is covered by the skirt of the one that is higher. Where the grid ends,
/// walls go down to a common base, as those of a block diagram, and hide the ends of skirts.

#include <functional>
#include <limits>

#include "src/render/block_layout.hpp"
#include "src/render/mesh.hpp"

namespace desert_sim::render {

/// The colour of a vertex: of cell (x, y), with the upward unit normal there.
using CellColour = std::function<PackedColour(int x, int y, float normal_x, float normal_y, float normal_z)>;

/// `surface` has the heights [m] of layout.needed_cells(block, level) at least. Unknown cells (NaN) are
/// holes: there is no triangle at them. Normals follow from central differences over 2^level cells on either
/// side, across the edges of blocks, and one-sided beside unknown cells and at the edge of the grid. The
/// walls end at the height `base` [m]; NaN: there are none. Nothing is drawn between the centres of the
/// outermost cells of `hole`.
Mesh build_block(const BlockLayout& layout, int block, int level, double cell_size, const CellWindow& surface,
                 const CellColour& colour, float base = std::numeric_limits<float>::quiet_NaN(),
                 const CellRectangle& hole = {});

/// The surface of water of this depth [m] above the ground, in the cells of `depth`, for build_block():
/// unknown where it is dry, except beside water, where it continues level into the ground, so that the
/// shore is where both surfaces meet.
CellWindow water_surface(const CellWindow& ground, const CellWindow& depth, int level);

/// Where water begins, for drawing [m].
constexpr float least_water_depth = 0.005f;

}  // namespace desert_sim::render
