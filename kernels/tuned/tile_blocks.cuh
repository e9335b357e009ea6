#pragma once
/// What a pass over tiles makes of their cells when these are done, so that no pass of its own reads them
/// again: coarse levels, or heights. The law of each is beside its generic pass (Restrict,
/// surface::MeasureBlock); the bits are the same.
///
/// Tiles begin at multiples of four cells, so that blocks of 4 × 4 lie in one tile, in four lines of a warp:
///
///     lanes  x    x+1  x+2  x+3
///            c . . c . . c . . c .   line 3   | a lane sums two lines twice, keeps one sum, hands the other
///            c . . c . . c . . c .   line 2   | to the lane beside it: even lanes make the southern cell of
///            c . . c . . c . . c .   line 1   | the coarse level, odd ones the northern. Four lanes have
///            c . . c . . c . . c .   line 0   | what the next level takes.

#include "desert_sim/kernels/surface.hpp"
#include "desert_sim/kernels/tuned/tile_cells.cuh"

namespace desert_sim::avalanching::tuned {

/// Lines of a block.
constexpr int block_lines = surface::block_side;
static_assert(block_lines == 4);

inline bool blocks_share_tiles(const Tiles& tiles) {
  return tiles.offset % block_lines == 0 && tiles.grid.width % block_lines == 0 &&
         tiles.grid.height % block_lines == 0;
}

/// Nothing more.
struct Nothing {
  static constexpr bool anything = false;
  template <bool whole, int strip>
  __device__ void operator()(const RelaxTile&, const Shared<strip>&) const {}
};

/// Of two cells: sums, which are exact, and the steeper angle.
struct PairOfCells {
  static constexpr Quanta wall = -2147483647 - 1;  ///< as the sum of grounds, which is never so low
  Quanta ground;
  std::uint32_t sand;
  float steepest;

  __device__ PairOfCells(const LevelCell& a, const LevelCell& b)
      : ground(a.ground >= wall_height || b.ground >= wall_height ? wall : a.ground + b.ground),
        sand(static_cast<std::uint32_t>(a.sand) + static_cast<std::uint32_t>(b.sand)),
        steepest(maximum(a.repose, b.repose)) {}
  /// Of the lane `mask` beside this one.
  __device__ PairOfCells from_lane(int mask) const {
    PairOfCells there = *this;
    there.ground = __shfl_xor_sync(whole_warp, ground, mask);
    there.sand = __shfl_xor_sync(whole_warp, sand, mask);
    there.steepest = __shfl_xor_sync(whole_warp, steepest, mask);
    return there;
  }
  /// What coarse_cell() makes of the four.
  __device__ LevelCell with(const PairOfCells& b) const {
    const Quanta halves = (ground >> 1) + (b.ground >> 1) + (ground & b.ground & 1);
    const std::uint32_t sands = (sand >> 1) + (b.sand >> 1) + (sand & b.sand & 1);
    return {ground == wall || b.ground == wall ? wall_height : halves >> 1, static_cast<Quanta>(sands >> 1),
            maximum(steepest, b.steepest)};
  }
};

/// Fills the coarse levels.
struct ThenRestrict {
  static constexpr bool anything = true;
  Restrict law;

  template <bool whole, int strip>
  __device__ void operator()(const RelaxTile& tile, const Shared<strip>& shared) const {
    const Cells<strip, whole> cells(tile, shared);
#pragma unroll
    for (int n = 0; n < strip; n += block_lines) block(cells, n);
  }

 private:
  template <bool whole, int strip>
  __device__ void block(const Cells<strip, whole>& cells, int n) const {
    const bool odd = threadIdx.x % 2 != 0, there = whole || cells[n] >= 0;
    LevelCell line[block_lines] = {};
    if (there)
#pragma unroll
      for (int k = 0; k < block_lines; ++k) line[k] = law.fine_cell(cells[n + k]);
    const PairOfCells south(line[0], line[1]), north(line[2], line[3]);
    const PairOfCells kept = odd ? north : south, handed = odd ? south : north;
    const LevelCell first = kept.with(handed.from_lane(1));
    const int x = cells.x >> 1, y = (cells.row(n) >> 1) + (odd ? 1 : 0);
    if (there) law.first.put(x, y, first);
    if (law.second.grid.width == 0) return;
    // Lanes x and x + 1 have the two cells of one coarse column.
    LevelCell other;
    other.ground = __shfl_xor_sync(whole_warp, first.ground, 1);
    other.sand = __shfl_xor_sync(whole_warp, first.sand, 1);
    other.repose = __shfl_xor_sync(whole_warp, first.repose, 1);
    const PairOfCells column(first, other);
    const LevelCell second = column.with(column.from_lane(2));
    if (there && threadIdx.x % block_lines == 0) law.second.put(x >> 1, y >> 1, second);
  }
};

/// Writes the heights, and the highest of each block.
struct ThenMeasure {
  static constexpr bool anything = true;
  surface::MeasureBlock law;

  template <bool whole, int strip>
  __device__ void operator()(const RelaxTile& tile, const Shared<strip>& shared) const {
    const Cells<strip, whole> cells(tile, shared);
#pragma unroll
    for (int n = 0; n < strip; n += block_lines) {
      const bool there = whole || cells[n] >= 0;
      float top = -static_cast<float>(wall_height);
      if (there)
#pragma unroll
        for (int k = 0; k < block_lines; ++k) top = maximum(top, law.measure(cells[n + k]));
      top = maximum(top, __shfl_xor_sync(whole_warp, top, 1));
      top = maximum(top, __shfl_xor_sync(whole_warp, top, 2));
      if (there && threadIdx.x % block_lines == 0)
        law.highest[law.blocks.index(cells.x / block_lines, cells.row(n) / block_lines)] = top;
    }
  }
};

}  // namespace desert_sim::avalanching::tuned
