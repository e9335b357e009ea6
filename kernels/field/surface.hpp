#pragma once
/// The solid surface that wind, wind shadow and echo dunes use:
///
///   h = b + e + s        (bedrock, soil, sand)
///
/// A step works with its heights as floats [quanta above the datum], because a conversion costs a GPU as much
/// as four additions, and with the highest one in each block of 4 × 4 cells. The layer `elevation` has the
/// same heights in whole quanta; nothing in a step reads it.

#include "kernels/backend/buffer.hpp"
#include "kernels/field/layers.hpp"

namespace desert_sim::surface {

template <class E>
void fill_elevation(E& exec, const TerrainView& terrain);

template <class E>
void fill_water_surface(E& exec, const TerrainView& t, int first, int rows);

/// Width of a block [cells].
constexpr int block_side = 4;

/// Heights of all cells, and the highest of each block.
struct Heights {
  Grid blocks;  ///< those at the far edges may have fewer cells
  Buffer<float> cell_heights, highest;
};

/// The blocks as a coarser grid.
Grid blocks_of(const Grid& grid);

Heights make_heights(Exec& exec, const Grid& grid);

template <class E>
void compute_heights(E& exec, const TerrainView& t, Heights& heights);

}  // namespace desert_sim::surface
