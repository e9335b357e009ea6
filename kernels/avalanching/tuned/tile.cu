/// RelaxTile for GPUs: the same laws and the same bits, with a patch of 4 × 4 cells in the registers of each
/// thread.
///
/// A tile is a thread block of 64 threads, one for each of its patches, which are numbered eastward row by
/// row:
///
///       global memory   16 bytes a row of a patch: ground, sand, tangents
///            |
///       registers       heights and ground in the tile's units, after adding the change of the coarse level
///            |
///       shared memory   heights, drop at repose, and the top of the     <---+
///            |          ground unless the tile is deep                      |
///            |   by patches, shifted in each sweep                          | heights
///       registers       the pairs of a patch, one after the other       ----+
///            |
///       global memory   sand, 16 bytes a row of a patch; and the results of the law that follows the
///                       sweeps, for which the ground is kept in shared memory
///
/// One barrier between two sweeps is enough, because a thread writes only the cells that it has read.

#include <type_traits>

#include "kernels/avalanching/tuned/patches.cuh"
#include "kernels/avalanching/tuned/tile.hpp"
#include "kernels/backend/for_each_cuda.cuh"

namespace desert_sim::avalanching {

namespace tuned {
namespace {

/// Tiles (thread blocks) that reside on a multiprocessor at once. This leaves a thread 128 registers, of
/// which it takes up to 116. With nine or ten tiles it has 96, fewer pairs are in flight, and a step takes a
/// tenth longer.
constexpr int resident_tiles = 8;

/// Applies the law that follows the sweeps to a block of 4 × 4 cells. Where there are obstacles, the tile
/// holds the height of a wall instead of the ground's, so heights are measured from the layers again.
template <class RowOf>
__device__ void apply_follow_up(const Restrict& law, bool, int column, int row, const RowOf& row_of) {
  law.fill_complete_block(column, row, row_of);
}
template <class RowOf>
__device__ void apply_follow_up(const surface::ComputeBlockHeights& law, bool obstacles, int column, int row,
                                const RowOf& row_of) {
  if (obstacles) return law(column, row);
  law.compute_complete_block(column, row, row_of);
}

template <bool patch_aligned, bool quads, ShiftCode code, class Then>
__global__ __launch_bounds__(threads, resident_tiles) void relax_tiles_kernel(RelaxTile law, Then then) {
  constexpr bool has_no_follow_up = std::is_same_v<Then, NoFollowUp>;
  if (law.is_skipped(static_cast<int>(blockIdx.x), static_cast<int>(blockIdx.y))) return;
  __shared__ Shared shared;
  __shared__ std::conditional_t<has_no_follow_up, NoFollowUp, Ground> ground;
  const PatchLocation<patch_aligned> patch(law);
  Ground* kept_ground = nullptr;
  if constexpr (!has_no_follow_up) kept_ground = &ground;
  bool walls;
  const Range range = load(patch, shared, kept_ground, walls);
  if constexpr (quads)
    walls = __syncthreads_or(walls) != 0;
  else
    __syncthreads();
  const Units units(range.lowest, range.highest, law.level.quanta_per_cell);
  bool changed = law.from_coarse.sand_after;
  if (range.lowest < wall_height)
    changed |= range.deep() ? relax<true, quads, code>(law, shared, units, walls)
                            : relax<false, quads, code>(law, shared, units, walls);
  if (changed)
#pragma unroll
    for (int row = 0; row < Patch::side; ++row)
      patch.store_row(law.level.sand, row, sand_of_row(shared, units, row));
  if constexpr (patch_aligned && !has_no_follow_up)
    if (patch.is_in_grid())
      apply_follow_up(then, law.level.obstacle, patch.x / Patch::side, patch.y / Patch::side, [&](int row) {
        return surface::GroundAndSand{ground.rows[row][threadIdx.x], sand_of_row(shared, units, row)};
      });
}

bool patches_are_aligned(const RelaxTile& law) {
  const Grid& grid = law.level.grid;
  return law.tiles.offset % Patch::side == 0 && grid.width % Patch::side == 0 &&
         grid.height % Patch::side == 0;
}

template <bool patch_aligned, ShiftCode code, class Then>
void launch_kernel(CudaExec& exec, const RelaxTile& law, const Then& then) {
  const dim3 tiles(law.tiles.columns(), law.tiles.rows());
  if (law.by_gradient)
    relax_tiles_kernel<patch_aligned, true, code><<<tiles, threads, 0, cuda::stream(exec)>>>(law, then);
  else
    relax_tiles_kernel<patch_aligned, false, code><<<tiles, threads, 0, cuda::stream(exec)>>>(law, then);
  check_cuda(cudaGetLastError(), "launch over tiles, tuned");
}
void launch(CudaExec& exec, const RelaxTile& law) {
  if (!patches_are_aligned(law))
    launch_kernel<false, ShiftCode::shared_by_shifts>(exec, law, NoFollowUp{});
  else if (law.sweeps > max_sweeps_while_sliding)
    launch_kernel<true, ShiftCode::one_per_shift>(exec, law, NoFollowUp{});
  else
    launch_kernel<true, ShiftCode::shared_by_shifts>(exec, law, NoFollowUp{});
}

/// Applies `then` in the same kernel if all patches lie in the grid as a whole and all tiles are relaxed.
template <class Then>
void launch_with_follow_up(CudaExec& exec, const RelaxTile& law, const Then& then) {
  if (!law.active_flags && patches_are_aligned(law))
    return launch_kernel<true, ShiftCode::shared_by_shifts>(exec, law, then);
  launch(exec, law);
  for_each_cell(exec, follow_up_grid(then), then);
}
static_assert(surface::block_side == Patch::side);

}  // namespace
}  // namespace tuned

void relax_tiles_tuned(CudaExec& exec, const RelaxTile& law, const NoFollowUp&) { tuned::launch(exec, law); }
void relax_tiles_tuned(CudaExec& exec, const RelaxTile& law, const Restrict& then) {
  tuned::launch_with_follow_up(exec, law, then);
}
void relax_tiles_tuned(CudaExec& exec, const RelaxTile& law, const surface::ComputeBlockHeights& then) {
  tuned::launch_with_follow_up(exec, law, then);
}

}  // namespace desert_sim::avalanching
