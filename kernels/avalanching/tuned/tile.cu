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
///      global memory   sand, 16 bytes a row of a patch; and what is made of a block of 4 × 4 cells, for which
///                      shared memory keeps its ground
// clang-format on
///
/// Between two sweeps is one barrier: a thread writes the cells that it has read.

#include <type_traits>

#include "kernels/avalanching/tuned/patches.cuh"
#include "kernels/avalanching/tuned/tile.hpp"
#include "kernels/backend/for_each_cuda.cuh"

namespace desert_sim::avalanching {

namespace tuned {
namespace {

/// Tiles of a multiprocessor: leaves a thread 128 registers, of which it takes up to 116. With nine or ten,
/// and 96, fewer pairs lie side by side, and a step takes a tenth longer.
constexpr int tiles_at_once = 8;

/// What becomes of a block of 4 × 4 cells. Where obstacles stand, a wall hides what ground there is.
template <class RowOf>
__device__ void finish(const Restrict& law, bool, int column, int row, const RowOf& row_of) {
  law.fill_whole(column, row, row_of);
}
template <class RowOf>
__device__ void finish(const surface::MeasureBlock& law, bool obstacles, int column, int row,
                       const RowOf& row_of) {
  if (obstacles) return law(column, row);
  law.measure_whole(column, row, row_of);
}

template <bool whole, Code code, class Then>
__global__ __launch_bounds__(threads, tiles_at_once) void relax_tiles_kernel(RelaxTile law, Then then) {
  constexpr bool ends_here = std::is_same_v<Then, NothingThen>;
  if (law.closed(static_cast<int>(blockIdx.x), static_cast<int>(blockIdx.y))) return;
  __shared__ Shared shared;
  __shared__ std::conditional_t<ends_here, NothingThen, Ground> ground;
  const Place<whole> place(law);
  Ground* kept = nullptr;
  if constexpr (!ends_here) kept = &ground;
  const Range range = load(place, shared, kept);
  __syncthreads();
  const Units units(range.lowest, range.highest, law.level.quanta_per_cell);
  bool changed = law.from_coarse.sand_after;
  if (range.lowest < wall_height)
    changed |= range.deep() ? relax<true, code>(law, shared, units) : relax<false, code>(law, shared, units);
  if (changed)
#pragma unroll
    for (int row = 0; row < Patch::side; ++row)
      place.put_row(law.level.sand, row, sand_of_row(shared, units, row));
  if constexpr (whole && !ends_here)
    if (place.there())
      finish(then, law.level.obstacle, place.x / Patch::side, place.y / Patch::side, [&](int row) {
        return surface::GroundAndSand{ground.rows[row][threadIdx.x], sand_of_row(shared, units, row)};
      });
}

bool patches_are_whole(const RelaxTile& law) {
  const Grid& grid = law.level.grid;
  return law.tiles.offset % Patch::side == 0 && grid.width % Patch::side == 0 &&
         grid.height % Patch::side == 0;
}

template <bool whole, Code code, class Then>
void launch_as(CudaExec& exec, const RelaxTile& law, const Then& then) {
  const dim3 tiles(law.tiles.columns(), law.tiles.rows());
  relax_tiles_kernel<whole, code><<<tiles, threads, 0, cuda::stream(exec)>>>(law, then);
  check_cuda(cudaGetLastError(), "launch over tiles, tuned");
}
void launch(CudaExec& exec, const RelaxTile& law) {
  if (!patches_are_whole(law))
    launch_as<false, Code::one_for_all_shifts>(exec, law, NothingThen{});
  else if (law.sweeps > most_sweeps)
    launch_as<true, Code::one_a_shift>(exec, law, NothingThen{});
  else
    launch_as<true, Code::one_for_all_shifts>(exec, law, NothingThen{});
}

/// In the same pass, if blocks are patches and all tiles are passed over.
template <class Then>
void launch_with(CudaExec& exec, const RelaxTile& law, const Then& then) {
  if (!law.open && patches_are_whole(law)) return launch_as<true, Code::one_for_all_shifts>(exec, law, then);
  launch(exec, law);
  for_each_cell(exec, passed_over(then), then);
}
static_assert(surface::block_side == Patch::side);

}  // namespace
}  // namespace tuned

void relax_tiles_tuned(CudaExec& exec, const RelaxTile& law, const NothingThen&) { tuned::launch(exec, law); }
void relax_tiles_tuned(CudaExec& exec, const RelaxTile& law, const Restrict& then) {
  tuned::launch_with(exec, law, then);
}
void relax_tiles_tuned(CudaExec& exec, const RelaxTile& law, const surface::MeasureBlock& then) {
  tuned::launch_with(exec, law, then);
}

}  // namespace desert_sim::avalanching
