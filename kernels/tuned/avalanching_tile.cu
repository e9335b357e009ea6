/// RelaxTile for GPUs: the same laws and the same bits, with a patch of 4 × 4 cells in a thread's registers.
///
/// A tile is a block of 64 threads, which have its patches, east by east and then north:
///
// clang-format off
///      global memory   16 bytes a row of a patch: ground, sand, tangents
///           |
///      registers       heights and depths in the tile's units; what falls to the patch from the coarse level
///           |
///      shared memory   heights, drop at repose, top of the ground if   <---+
///           |          the tile is not deep                                |
///           |   by patches, elsewhere in each sweep                        | heights
///      registers       the pairs of a patch, one after the other       ----+
///           |
///      global memory   sand, 16 bytes a row of a patch; and what is made of a block of 4 × 4 cells
// clang-format on
///
/// Between two sweeps is one barrier: a thread writes the cells that it has read.

#include "desert_sim/kernels/avalanching_tile.hpp"
#include "desert_sim/kernels/for_each_cuda.cuh"

namespace desert_sim::avalanching {

namespace tuned {
namespace {

constexpr int side = Tiles::side, patches = RelaxTile::patches, threads = patches * patches;
constexpr int warps = threads / 32;
/// Tiles of a multiprocessor: leaves a thread 128 registers, of which it takes 113. With ten, and 96, fewer
/// pairs lie side by side, and a pass takes a sixth longer.
constexpr int tiles_at_once = 8;

/// One value of each cell of a tile. Columns 0, 4, 8 … lie apart from columns 1, 5, 9 … and so on, rows so
/// that the cells which the threads of a warp fetch at once lie in 32 banks, wherever patches are.
struct PerCell {
  static constexpr int stride = patches + 2;
  float values[Patch::side][side * stride];
  __device__ float& at(int x, int y) { return values[x % Patch::side][y * stride + x / Patch::side]; }
};

struct Shared {
  PerCell h, ground, drop;
  Four<Quanta> base[Patch::side][threads];  ///< of a cell's sand what does not change with its height
  float share[side + Patch::side];          ///< of the gaps, as ShareOfGap counts them
  Range range[warps];
  int moved[2][warps];  ///< nothing, something, much; of sweeps in turns
};

/// A value of each cell of a patch.
template <class T>
struct OfPatch {
  Four<T> rows[Patch::side];
  __device__ T& operator[](int n) { return rows[n / Patch::side].values[n % Patch::side]; }
};

/// A thread's patch in the grid. `whole`: width and height of the grid are multiples of four, as tiles'
/// offsets are, so that patches lie in the grid as a whole, their rows aligned, or not at all.
template <bool whole>
struct Place {
  const RelaxTile& law;
  int x, y;  ///< of its first cell; if `whole`, in the grid, −1 if it is not there; else in the tile

  __device__ explicit Place(const RelaxTile& tile)
      : law(tile),
        x(static_cast<int>(threadIdx.x) % patches * Patch::side),
        y(static_cast<int>(threadIdx.x) / patches * Patch::side) {
    if (!whole) return;
    x = grid_x(x);
    y = grid_y(y);
  }
  __device__ bool there() const { return x >= 0 && y >= 0; }  ///< if `whole`
  __device__ bool there(int n) const { return whole ? there() : cell(n / Patch::side, n % Patch::side) >= 0; }
  /// The grid's cell, or −1.
  __device__ int cell(int row, int column) const {
    const int width = law.level.grid.width;
    if (whole) return there() ? (y + row) * width + x + column : -1;
    const int there_x = grid_x(x + column), there_y = grid_y(y + row);
    return there_x < 0 || there_y < 0 ? -1 : there_y * width + there_x;
  }
  /// The coarse cell of which this and the three beside and above it are the children, or −1.
  __device__ int parent(int row, int column) const {
    const Grid& coarse = law.from_coarse.coarse;
    const int there_x = whole ? x + column : grid_x(x + column), there_y = whole ? y + row : grid_y(y + row);
    if ((whole && !there()) || there_x < 0 || there_y < 0) return -1;
    return coarse.inside(there_x / 2, there_y / 2) ? coarse.index(there_x / 2, there_y / 2) : -1;
  }

  /// What stands for cells that are not there is of no account: their heights are walls'.
  template <class T>
  __device__ void fetch(const T* from, OfPatch<T>& to) const {
#pragma unroll
    for (int row = 0; row < Patch::side; ++row) {
      if constexpr (whole) {
        to.rows[row] = four_at(from + (there() ? cell(row, 0) : 0));
      } else {
#pragma unroll
        for (int n = 0; n < Patch::side; ++n) {
          const int i = cell(row, n);
          to.rows[row].values[n] = from[i < 0 ? 0 : i];
        }
      }
    }
  }
  __device__ void put_row(Quanta* to, int row, const Four<Quanta>& four) const {
    if constexpr (whole) {
      if (there()) put_four(to + cell(row, 0), four);
    } else {
#pragma unroll
      for (int n = 0; n < Patch::side; ++n)
        if (const int i = cell(row, n); i >= 0) to[i] = four.values[n];
    }
  }

 private:
  __device__ int grid_x(int n) const { return law.grid_x(static_cast<int>(blockIdx.x), n); }
  __device__ int grid_y(int n) const { return law.grid_y(static_cast<int>(blockIdx.y), n); }
};

/// Of all values in a warp.
__device__ int lowest_of_warp(int value) {
#if __CUDA_ARCH__ >= 800
  return __reduce_min_sync(0xffffffffu, value);
#else
  for (int step = 16; step > 0; step /= 2) value = min(value, __shfl_xor_sync(0xffffffffu, value, step));
  return value;
#endif
}
__device__ int highest_of_warp(int value) { return ~lowest_of_warp(~value); }

/// Of the block, by what each thread has found.
__device__ Range range_of_block(Shared& shared, Range range) {
  range = {lowest_of_warp(range.lowest), highest_of_warp(range.highest),
           highest_of_warp(range.highest_ground)};
  if (threadIdx.x % 32 == 0) shared.range[threadIdx.x / 32] = range;
  __syncthreads();
  for (int n = 0; n < warps; ++n) {
    const Range& other = shared.range[n];
    range = {min(range.lowest, other.lowest), max(range.highest, other.highest),
             max(range.highest_ground, other.highest_ground)};
  }
  return range;
}

/// Hands the patch's sand what the coarse level has done. Fetches all before it uses any.
template <bool whole>
__device__ void prolong(const Place<whole>& place, OfPatch<Quanta>& sand) {
  constexpr int families = Patch::side / 2;
  const Prolong& coarse = place.law.from_coarse;
  Quanta change[families][families];
#pragma unroll
  for (int row = 0; row < families; ++row)
#pragma unroll
    for (int column = 0; column < families; ++column) {
      const int i = place.parent(2 * row, 2 * column);
      change[row][column] = i >= 0 ? coarse.sand_after[i] - coarse.sand_before[i] : 0;
    }
#pragma unroll
  for (int row = 0; row < families; ++row)
#pragma unroll
    for (int column = 0; column < families; ++column) {
      Quanta *south = sand.rows[2 * row].values + 2 * column,
             *north = sand.rows[2 * row + 1].values + 2 * column;
      hand_down(change[row][column], south[0], south[1], north[0], north[1]);
    }
}

/// Heights of the patch's cells, from wall_height on for walls, and their sand.
template <bool whole>
__device__ void fetch_heights(const Place<whole>& place, OfPatch<Quanta>& height, OfPatch<Quanta>& sand) {
  const LevelView& level = place.law.level;
  place.fetch(level.ground, height);
  place.fetch(static_cast<const Quanta*>(level.sand), sand);
  if (place.law.from_coarse.sand_after) prolong(place, sand);
  if (level.soil) {
    OfPatch<Quanta> soil;
    place.fetch(level.soil, soil);
#pragma unroll
    for (int n = 0; n < Patch::cells; ++n) height[n] += height[n] < wall_height ? soil[n] : 0;
  }
  if (level.obstacle) {
    OfPatch<float> obstacle;
    place.fetch(level.obstacle, obstacle);
#pragma unroll
    for (int n = 0; n < Patch::cells; ++n) height[n] = obstacle[n] > 0.0f ? wall_height : height[n];
  }
#pragma unroll
  for (int n = 0; n < Patch::cells; ++n) {
    height[n] += sand[n];
    if (!place.there(n)) height[n] = wall_height;
  }
}

/// What a patch adds to its tile's.
__device__ Range range_of_patch(OfPatch<Quanta>& height, OfPatch<Quanta>& sand, bool& walls) {
  Range range{height[0], height[0], height[0] - sand[0]};
#pragma unroll
  for (int n = 1; n < Patch::cells; ++n)
    range = {min(range.lowest, height[n]), max(range.highest, height[n]),
             max(range.highest_ground, height[n] - sand[n])};
  walls = range.highest >= wall_height;
  if (walls) {
    range.highest = range.highest_ground = -wall_height;
#pragma unroll
    for (int n = 0; n < Patch::cells; ++n)
      if (height[n] < wall_height)
        range = {range.lowest, max(range.highest, height[n]), max(range.highest_ground, height[n] - sand[n])};
  }
  return range;
}

/// Shared memory from the grid.
template <bool whole>
__device__ Range load(const Place<whole>& place, Shared& shared) {
  const LevelView& level = place.law.level;
  OfPatch<Quanta> height, sand;
  OfPatch<float> drop;
  place.fetch(level.repose, drop);
  fetch_heights(place, height, sand);
  bool walls;
  const Range range = range_of_block(shared, range_of_patch(height, sand, walls));
  const Units units(range.lowest, range.highest, level.quanta_per_cell);
  const int px = static_cast<int>(threadIdx.x) % patches, py = static_cast<int>(threadIdx.x) / patches;
  const auto at = [&](PerCell& values, int n) -> float& {
    return values.at(px * Patch::side + n % Patch::side, py * Patch::side + n / Patch::side);
  };
  if (!range.deep())
#pragma unroll
    for (int n = 0; n < Patch::cells; ++n) at(shared.ground, n) = units.ground(height[n], sand[n]);
#pragma unroll
  for (int n = 0; n < Patch::cells; ++n) {
    const float h = units.height(height[n]);
    at(shared.h, n) = h;
    at(shared.drop, n) = units.drop(drop[n], level.quanta_per_cell);
    sand[n] -= units.of_height(h);
  }
  if (walls)
#pragma unroll
    for (int n = 0; n < Patch::cells; ++n)
      if (height[n] >= wall_height) {
        at(shared.h, n) = at(shared.ground, n) = at(shared.drop, n) = Units::wall;
        sand[n] += units.of_height(units.height(height[n])) - units.of_height(Units::wall);
      }
#pragma unroll
  for (int row = 0; row < Patch::side; ++row) shared.base[row][threadIdx.x] = sand.rows[row];
  return range;
}

/// The sand of the patch, to the grid.
template <bool whole>
__device__ void store(const Place<whole>& place, Shared& shared, const Units& units) {
  const int px = static_cast<int>(threadIdx.x) % patches, py = static_cast<int>(threadIdx.x) / patches;
#pragma unroll
  for (int row = 0; row < Patch::side; ++row) {
    Four<Quanta> sand = shared.base[row][threadIdx.x];
#pragma unroll
    for (int n = 0; n < Patch::side; ++n)
      sand.values[n] += units.of_height(shared.h.at(px * Patch::side + n, py * Patch::side + row));
    place.put_row(place.law.level.sand, row, sand);
  }
}

/// Where a patch's cell lies among its registers.
struct InRegisters {
  __device__ constexpr int operator()(int row, int column) const { return row * Patch::side + column; }
};

/// The pairs of this thread's patch; the most that one of them moves.
template <bool deep>
__device__ float sweep_patch(Shared& shared, const PatchShift& shift) {
  const int px = static_cast<int>(threadIdx.x) % patches, py = static_cast<int>(threadIdx.x) / patches;
  int columns[Patch::side], rows[Patch::side];
#pragma unroll
  for (int n = 0; n < Patch::side; ++n) {
    columns[n] = (px * Patch::side + shift.x + n) % side;
    rows[n] = (py * Patch::side + shift.y + n) % side;
  }
  float h[Patch::cells], ground[Patch::cells], drop[Patch::cells];
#pragma unroll
  for (int n = 0; n < Patch::cells; ++n) {
    const int x = columns[n % Patch::side], y = rows[n / Patch::side];
    h[n] = shared.h.at(x, y);
    if (!deep) ground[n] = shared.ground.at(x, y);
    drop[n] = shared.drop.at(x, y);
  }
  Shares<1> shares;
#pragma unroll
  for (int n = 0; n + 1 < Patch::side; ++n) {
    shares.x[n][0] = shared.share[px * Patch::side + shift.x + n];
    shares.y[n] = shared.share[py * Patch::side + shift.y + n];
  }
  float most = 0.0f;
  PairsOfPatches<1, deep, InRegisters>{h, ground, drop, {}, shares, &most}.relax();
#pragma unroll
  for (int n = 0; n < Patch::cells; ++n) shared.h.at(columns[n % Patch::side], rows[n / Patch::side]) = h[n];
  return most;
}

/// Sweeps over what is loaded, until the tile is at rest or has had enough of them. Whether anything moved.
template <bool deep>
__device__ bool relax(const RelaxTile& law, Shared& shared, const Units& units) {
  const float much = units.drop(law.plenty, law.level.quanta_per_cell);
  bool moved = false, moved_before = true;
  for (int n = 0;; ++n) {
    const float most = sweep_patch<deep>(shared, PatchShift(n, law.tiles.offset));
    const bool any = __any_sync(0xffffffffu, most > 0.0f), any_much = __any_sync(0xffffffffu, most > much);
    if (threadIdx.x % 32 == 0) shared.moved[n % 2][threadIdx.x / 32] = any_much ? 2 : (any ? 1 : 0);
    __syncthreads();
    int here = 0;
#pragma unroll
    for (int k = 0; k < warps; ++k) here = max(here, shared.moved[n % 2][k]);
    moved = moved || here > 0;
    if (here == 0 && !moved_before) break;
    if (law.has_had_enough(n + 1, here == 2)) break;
    moved_before = here > 0;
  }
  return moved;
}

/// What becomes of a block of 4 × 4 cells.
__device__ void finish(NothingThen, int, int) {}
__device__ void finish(const Restrict& law, int column, int row) { law.fill_whole(column, row); }
__device__ void finish(const surface::MeasureBlock& law, int column, int row) { law(column, row); }

template <bool whole, class Then>
__global__ __launch_bounds__(threads, tiles_at_once) void relax_tiles_kernel(RelaxTile law, Then then) {
  if (law.closed(static_cast<int>(blockIdx.x), static_cast<int>(blockIdx.y))) return;
  __shared__ Shared shared;
  if (threadIdx.x < side + Patch::side) shared.share[threadIdx.x] = law.share(static_cast<int>(threadIdx.x));
  const Place<whole> place(law);
  const Range range = load(place, shared);
  __syncthreads();
  if (range.lowest < wall_height) {
    const Units units(range.lowest, range.highest, law.level.quanta_per_cell);
    const bool moved = range.deep() ? relax<true>(law, shared, units) : relax<false>(law, shared, units);
    if (moved || law.from_coarse.sand_after) store(place, shared, units);
  }
  if (whole && place.there()) finish(then, place.x / Patch::side, place.y / Patch::side);
}

bool patches_are_whole(const RelaxTile& law) {
  const Grid& grid = law.level.grid;
  return law.tiles.offset % Patch::side == 0 && grid.width % Patch::side == 0 &&
         grid.height % Patch::side == 0;
}

template <class Then>
void launch(CudaExec& exec, const RelaxTile& law, const Then& then) {
  const dim3 tiles(law.tiles.columns(), law.tiles.rows());
  if (patches_are_whole(law))
    relax_tiles_kernel<true><<<tiles, threads, 0, cuda::stream(exec)>>>(law, then);
  else
    relax_tiles_kernel<false><<<tiles, threads, 0, cuda::stream(exec)>>>(law, NothingThen{});
  check_cuda(cudaGetLastError(), "launch over tiles, tuned");
}

/// In the same pass, if blocks are patches and all tiles are passed over.
template <class Then>
bool relaxed_with(CudaExec& exec, const RelaxTile& law, const Then& then) {
  if (law.open || !patches_are_whole(law)) return false;
  launch(exec, law, then);
  return true;
}
static_assert(surface::block_side == Patch::side);

}  // namespace
}  // namespace tuned

void relax_tiles(CudaExec& exec, const RelaxTile& law) { tuned::launch(exec, law, NothingThen{}); }

void relax_tiles_then(CudaExec& exec, const RelaxTile& law, const Restrict& then) {
  if (!tuned::relaxed_with(exec, law, then)) relax_tiles_then<CudaExec, Restrict>(exec, law, then);
}

void relax_tiles_then(CudaExec& exec, const RelaxTile& law, const surface::MeasureBlock& then) {
  if (!tuned::relaxed_with(exec, law, then))
    relax_tiles_then<CudaExec, surface::MeasureBlock>(exec, law, then);
}

}  // namespace desert_sim::avalanching
