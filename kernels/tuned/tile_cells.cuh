#pragma once
/// How the threads of a tile (tuned/avalanching_tile.cu) get its cells from the grid, and back to it.

#include <cuda_runtime.h>

#include "desert_sim/kernels/avalanching_tile.hpp"

namespace desert_sim::avalanching::tuned {

constexpr int side = Tiles::side;
constexpr unsigned whole_warp = 0xffffffffu;

/// What the warps of a tile share. Line and column 0 and side + 1 are walls.
template <int strip>
struct Shared {
  static constexpr int strips = side / strip;
  float h[side + 2][side + 2];
  float loaded[side][side];                                        ///< the heights that the tile began with
  float northward[strips + 1][side], southward[strips + 1][side];  ///< over the border below strip n
  int gave[strips + 2];  ///< in the last sweep: nothing, something, much; strip n at n + 1
  int lowest[strips], highest[strips];
  int row[side];  ///< the grid's, or −1
};

/// A thread's column of its warp's strip.
template <int strip>
struct Column {
  float h[strip], ground[strip], drop[strip];
};

/// The grid's cells under a thread's column. `whole`: the tile's cells are all there, side by side.
template <int strip, bool whole>
struct Cells {
  const Shared<strip>& shared;
  int x;      ///< the grid's column, or −1
  int y;      ///< the strip's first row; of the grid if `whole`, else of the tile
  int width;  ///< of the grid
  int first;  ///< if `whole`: the strip's first cell

  __device__ Cells(const RelaxTile& law, const Shared<strip>& s)
      : shared(s), y(static_cast<int>(threadIdx.y) * strip), width(law.level.grid.width), first(0) {
    const int column = static_cast<int>(blockIdx.x), lane = static_cast<int>(threadIdx.x);
    if (whole) {
      x = column * side - law.tiles.offset + lane;
      y += static_cast<int>(blockIdx.y) * side - law.tiles.offset;
      first = y * width + x;
    } else {
      x = law.grid_x(column, lane);
    }
  }
  /// The grid's row of line n, or −1.
  __device__ int row(int n) const { return whole ? y + n : shared.row[y + n]; }
  /// The grid's cell on line n, or −1.
  __device__ int operator[](int n) const {
    if (whole) return first + n * width;
    const int there = row(n);
    return x < 0 || there < 0 ? -1 : there * width + x;
  }
};

/// Lowest and highest of all values in the block.
template <int strip>
__device__ void reduce_in_block(Shared<strip>& shared, int& lowest, int& highest) {
  for (int step = 16; step > 0; step /= 2) {
    lowest = min(lowest, __shfl_xor_sync(whole_warp, lowest, step));
    highest = max(highest, __shfl_xor_sync(whole_warp, highest, step));
  }
  if (threadIdx.x == 0) {
    shared.lowest[threadIdx.y] = lowest;
    shared.highest[threadIdx.y] = highest;
  }
  __syncthreads();
  for (int n = 0; n < Shared<strip>::strips; ++n) {
    lowest = min(lowest, shared.lowest[n]);
    highest = max(highest, shared.highest[n]);
  }
}

/// Registers from the grid; the tile's units. Fetches all before it uses any.
template <bool whole, int strip>
__device__ Units load(const RelaxTile& law, Shared<strip>& shared, Column<strip>& c) {
  const LevelView& level = law.level;
  const Cells<strip, whole> cells(law, shared);
  Quanta height[strip], sand[strip];
#pragma unroll
  for (int n = 0; n < strip; ++n) {
    const int i = cells[n];
    const bool there = whole || i >= 0;
    height[n] = there ? level.ground[i] : wall_height;
    sand[n] = there ? level.sand[i] : 0;
    c.drop[n] = there ? level.repose[i] : 0.0f;
  }
  if (level.soil)
#pragma unroll
    for (int n = 0; n < strip; ++n)
      if (const int i = cells[n]; whole || i >= 0) height[n] += level.soil[i];
  if (level.obstacle)
#pragma unroll
    for (int n = 0; n < strip; ++n)
      if (const int i = cells[n]; (whole || i >= 0) && level.obstacle[i] > 0.0f) height[n] = wall_height;

  int top = height[0];
#pragma unroll
  for (int n = 1; n < strip; ++n) top = max(top, height[n]);
  const bool walls = top >= wall_height;
  int lowest = wall_height, highest = -wall_height;
  if (walls) {
#pragma unroll
    for (int n = 0; n < strip; ++n) {
      height[n] = height[n] < wall_height ? height[n] + sand[n] : wall_height;
      lowest = min(lowest, height[n]);
      highest = max(highest, height[n] < wall_height ? height[n] : -wall_height);
    }
  } else {
#pragma unroll
    for (int n = 0; n < strip; ++n) {
      height[n] += sand[n];
      lowest = min(lowest, height[n]);
      highest = max(highest, height[n]);
    }
  }
  reduce_in_block(shared, lowest, highest);
  const Units units(lowest, highest, level.quanta_per_cell);
  const int y = static_cast<int>(threadIdx.y) * strip, x = static_cast<int>(threadIdx.x);
#pragma unroll
  for (int n = 0; n < strip; ++n) {
    c.h[n] = units.height(height[n]);
    c.ground[n] = c.h[n] - units.depth_over_film(sand[n]);
    c.drop[n] = units.drop(c.drop[n], level.quanta_per_cell);
    if (walls && height[n] >= wall_height) {
      c.h[n] = Units::wall;
      c.ground[n] = Units::wall_ground;
    }
    shared.loaded[y + n][x] = c.h[n];
  }
  return units;
}

/// What the columns have gained, to the grid.
template <bool whole, int strip>
__device__ void store(const RelaxTile& law, const Shared<strip>& shared, const Units& units,
                      const Column<strip>& c) {
  const Cells<strip, whole> cells(law, shared);
  const int y = static_cast<int>(threadIdx.y) * strip, x = static_cast<int>(threadIdx.x);
  Quanta* sand = law.level.sand;
#pragma unroll
  for (int n = 0; n < strip; ++n) {
    const int i = cells[n];
    const Quanta gain = units.gain(shared.loaded[y + n][x], c.h[n]);
    if (gain != 0 && (whole || i >= 0)) sand[i] += gain;
  }
}

}  // namespace desert_sim::avalanching::tuned
