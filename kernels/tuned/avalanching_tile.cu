/// RelaxTile for GPUs: the same laws and the same bits, with the tile in registers.
///
/// A tile is a block; a warp has a strip of rows, a lane one column of them:
///
// clang-format off
///      lane 0 … 31          a warp's lines, south to north
///     +------------+       +--------------+
///     | warp 3     |       | line strip+1 |  its neighbour's; what goes there: shared memory
///     +------------+       +--------------+
///     | warp 2     |       | line strip   |
///     +------------+       |  …           |  heights, ground, drop: registers;
///     | warp 1     |       | line 1       |  parts to columns beside: shuffled, three rows' in one
///     +------------+       +--------------+
///     | warp 0     |       | line 0       |  as line strip+1
///     +------------+       +--------------+
// clang-format on
///
/// A sweep: the heights go to shared memory, where walls lie around them; | every warp slides its rows from
/// south to north, and completes a row when the next one is done; | what crossed the strips' borders is
/// added. (| a barrier.) A warp sits out a sweep if neither it nor one beside it gave anything in the one
/// before. Sums of parts are exact, so that their order here needs not be the reference's.

#include "desert_sim/kernels/avalanching_tile.hpp"
#include "desert_sim/kernels/for_each_cuda.cuh"
#include "desert_sim/kernels/tuned/tile_blocks.cuh"
#include "desert_sim/kernels/tuned/tile_cells.cuh"

namespace desert_sim::avalanching {

namespace tuned {
namespace {

/// Rows of a strip: many, where there are tiles enough to fill the GPU, because what strips hand each other
/// takes time; few, where a tile's own time is what counts, or little moves and warps sit out.
constexpr int long_strip = 8, short_strip = 4, shortest_strip = 2;
constexpr int tiles_for_long = 1200, tiles_for_short = 400;
/// Threads of a multiprocessor: leaves each 64 registers.
constexpr int threads_at_once = 1024;

template <int strip>
__device__ void build_walls(Shared<strip>& shared) {
  constexpr int strips = side / strip;
  const int first = static_cast<int>(threadIdx.y * side + threadIdx.x);
  for (int n = first; n < 4 * (side + 2); n += side * strips) {
    const int along = n >> 2, end = n & 1 ? side + 1 : 0;
    (n & 2 ? shared.h[along][end] : shared.h[end][along]) = Units::wall;
  }
  if (first < strips + 2) shared.gave[first] = 0;
}

/// One sweep of a warp's strip: its heights but for what comes over the borders, and what goes over them.
/// The most that one of the thread's cells gives.
template <int strip, class Onward>
__device__ float sweep_strip(Shared<strip>& shared, Column<strip>& c, float rest, float transfer,
                             Onward onward) {
  const int x = static_cast<int>(threadIdx.x), warp = static_cast<int>(threadIdx.y);
  const float not_first = x > 0 ? 1.0f : 0.0f, not_last = x < side - 1 ? 1.0f : 0.0f;
  const float(*lines)[side + 2] = shared.h + warp * strip;  // line n of the strip
  // What each line gets: from the columns beside, and from its own.
  float left[strip], east[strip + 2] = {}, west[strip + 2] = {}, straight[strip + 2] = {};

  struct Line {
    float west, middle, east, lower;  ///< of columns x − 1, x, x + 1; the lower of the outer two
  };
  const auto line = [&](int n) {
    const float w = lines[n][x], e = lines[n][x + 2];
    return Line{w, n > 0 && n <= strip ? c.h[n - 1] : lines[n][x + 1], e, lower(w, e)};
  };
  const auto incoming = [&](int n) {
    return fused(not_first, __shfl_up_sync(whole_warp, east[n], 1),
                 fused(not_last, __shfl_down_sync(whole_warp, west[n], 1), straight[n]));
  };

  float most = 0.0f;
  Line south = line(0), here = line(1);
#pragma unroll
  for (int n = 1; n <= strip; ++n) {
    const Line north = line(n + 1);
    const float around[] = {here.east,  here.west,  north.middle, south.middle,
                            north.east, south.west, north.west,   south.east};
    const Slide slide(here.middle, around, lower(here.lower, lower(north.middle, south.middle)),
                      lower(north.lower, south.lower), c.ground[n - 1], c.drop[n - 1], rest, transfer,
                      onward);
    most = higher(most, here.middle - slide.left);
    left[n - 1] = slide.left;
    // A line's sums begin with what its southern neighbour gives, but for the two southernmost.
    east[n - 1] = n == 1 ? slide.part[7] : east[n - 1] + slide.part[7];
    west[n - 1] = n == 1 ? slide.part[5] : west[n - 1] + slide.part[5];
    straight[n - 1] = n <= 2 ? slide.part[3] : straight[n - 1] + slide.part[3];
    east[n] = n == 1 ? slide.part[0] : east[n] + slide.part[0];
    west[n] = n == 1 ? slide.part[1] : west[n] + slide.part[1];
    east[n + 1] = slide.part[4];
    west[n + 1] = slide.part[6];
    straight[n + 1] = slide.part[2];
    if (n == 1)
      shared.southward[warp][x] = incoming(0);
    else
      c.h[n - 2] = left[n - 2] + incoming(n - 1);
    south = here;
    here = north;
  }
  c.h[strip - 1] = left[strip - 1] + incoming(strip);
  shared.northward[warp + 1][x] = incoming(strip + 1);
  return most;
}

/// Sweeps over what is loaded, until the tile is at rest or has had enough of them. Whether this warp's cells
/// have changed.
template <int strip, class Onward>
__device__ bool relax(const RelaxTile& law, Shared<strip>& shared, Column<strip>& c, const Units& units,
                      Onward onward) {
  constexpr int strips = side / strip;
  const int x = static_cast<int>(threadIdx.x), warp = static_cast<int>(threadIdx.y), y = warp * strip;
  bool stale = true, moved = false;
  const float much = units.drop(law.plenty, law.level.quanta_per_cell);
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    if (stale)
#pragma unroll
      for (int n = 0; n < strip; ++n) shared.h[y + n + 1][x + 1] = c.h[n];
    __syncthreads();
    const float most = stale ? sweep_strip(shared, c, law.rest, law.transfer, onward) : 0.0f;
    const bool gives = __any_sync(whole_warp, most > 0.0f), gives_much = __any_sync(whole_warp, most > much);
    if (x == 0) shared.gave[warp + 1] = gives_much ? 2 : (gives ? 1 : 0);
    __syncthreads();
    const bool from_south = shared.gave[warp], from_north = shared.gave[warp + 2];
    if (from_south) c.h[0] += shared.northward[warp][x];
    if (from_north) c.h[strip - 1] += shared.southward[warp + 1][x];
    stale = gives || from_south || from_north;
    moved = moved || stale;
    int any = 0;
#pragma unroll
    for (int n = 1; n <= strips; ++n) any = max(any, shared.gave[n]);
    if (any < (sweep + 1 < law.sweeps ? 1 : 2)) break;
  }
  return moved;
}

template <int strip, class Onward, class Then>
__global__ __launch_bounds__(side* side / strip,
                             threads_at_once* strip / (side * side)) void relax_tiles_kernel(RelaxTile law,
                                                                                             Onward onward,
                                                                                             Then then) {
  const int column = static_cast<int>(blockIdx.x), row = static_cast<int>(blockIdx.y);
  if (law.closed(column, row)) return;
  constexpr int strips = side / strip;
  __shared__ Shared<strip> shared;
  const int x = static_cast<int>(threadIdx.x), warp = static_cast<int>(threadIdx.y);
  if (warp == 0) shared.row[x] = law.grid_y(row, x);
  build_walls(shared);
  if (law.from_coarse.sand_after)
    for (int n = warp * side + x; n < RelaxTile::families; n += side * strips)
      law.prolong_family(column, row, n);
  __syncthreads();
  const bool whole = law.whole(column, row);
  Column<strip> c;
  const Units units = whole ? load<true>(law, shared, c) : load<false>(law, shared, c);
  if (units.lowest < wall_height && relax(law, shared, c, units, onward))
    whole ? store<true>(law, shared, units, c) : store<false>(law, shared, units, c);
  whole ? then.template operator()<true>(law, shared) : then.template operator()<false>(law, shared);
}

template <int strip, class Then>
void launch(CudaExec& exec, const RelaxTile& law, const Then& then) {
  const dim3 tiles(law.tiles.columns(), law.tiles.rows()), threads(side, side / strip);
  if constexpr (!Then::anything)
    if (law.onward > 0.0f) {
      relax_tiles_kernel<strip><<<tiles, threads, 0, cuda::stream(exec)>>>(law, law.onward, then);
      return check_cuda(cudaGetLastError(), "launch over tiles, tuned");
    }
  relax_tiles_kernel<strip><<<tiles, threads, 0, cuda::stream(exec)>>>(law, NoOnward{}, then);
  check_cuda(cudaGetLastError(), "launch over tiles, tuned");
}

/// If it can be done in the same pass: blocks lie in one tile each, and all tiles are passed over.
template <class Then>
bool relaxed_with(CudaExec& exec, const RelaxTile& law, const Then& then) {
  if (law.open || law.onward > 0.0f || !blocks_share_tiles(law.tiles)) return false;
  if (law.tiles.count() >= tiles_for_long)
    launch<long_strip>(exec, law, then);
  else
    launch<short_strip>(exec, law, then);
  return true;
}

}  // namespace
}  // namespace tuned

void relax_tiles(CudaExec& exec, const RelaxTile& law) {
  const int tiles = law.tiles.count();
  if (tiles >= tuned::tiles_for_long && !law.open)
    return tuned::launch<tuned::long_strip>(exec, law, tuned::Nothing{});
  if (tiles >= tuned::tiles_for_short) return tuned::launch<tuned::short_strip>(exec, law, tuned::Nothing{});
  tuned::launch<tuned::shortest_strip>(exec, law, tuned::Nothing{});
}

void relax_tiles_then(CudaExec& exec, const RelaxTile& law, const Restrict& then) {
  if (!tuned::relaxed_with(exec, law, tuned::ThenRestrict{then}))
    relax_tiles_then<CudaExec, Restrict>(exec, law, then);
}

void relax_tiles_then(CudaExec& exec, const RelaxTile& law, const surface::MeasureBlock& then) {
  if (!tuned::relaxed_with(exec, law, tuned::ThenMeasure{then}))
    relax_tiles_then<CudaExec, surface::MeasureBlock>(exec, law, then);
}

}  // namespace desert_sim::avalanching
