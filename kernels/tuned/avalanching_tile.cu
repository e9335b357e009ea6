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

namespace desert_sim::avalanching {

namespace {

constexpr int side = Tiles::side;
constexpr unsigned whole_warp = 0xffffffffu;
/// Rows of a strip: many, where there are tiles enough to fill the GPU, because what strips hand each other
/// takes time; few, where a tile's own time is what counts, or little moves and warps sit out.
constexpr int long_strip = 8, short_strip = 4, shortest_strip = 2;
constexpr int tiles_for_long = 1200, tiles_for_short = 400;
/// Threads of a multiprocessor: leaves each 64 registers.
constexpr int threads_at_once = 1024;

/// What the warps of a tile share. Line and column 0 and side + 1 are walls.
template <int strip>
struct Shared {
  static constexpr int strips = side / strip;
  float h[side + 2][side + 2];
  float northward[strips + 1][side], southward[strips + 1][side];  ///< over the border below strip n
  int gave[strips + 2];  ///< in the last sweep: nothing, something, much; strip n at n + 1
  int lowest[strips], highest[strips];
  int first_of_row[side];  ///< the grid's cell at x = 0, or −1
};

/// A thread's column of its warp's strip.
template <int strip>
struct Column {
  float h[strip], ground[strip], drop[strip];
};

/// The least of all values in the block.
template <int strips>
__device__ int lowest_in_block(int value, int (&of_warps)[strips]) {
  for (int step = 16; step > 0; step /= 2) value = min(value, __shfl_xor_sync(whole_warp, value, step));
  if (threadIdx.x == 0) of_warps[threadIdx.y] = value;
  __syncthreads();
  for (int n = 0; n < strips; ++n) value = min(value, of_warps[n]);
  return value;
}

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

/// Registers from the grid; the tile's units. Fetches all before it uses any.
template <int strip>
__device__ Units load(const RelaxTile& law, Shared<strip>& shared, const int (&cell)[strip],
                      Column<strip>& c) {
  const LevelView& level = law.level;
  Quanta height[strip], sand[strip];
#pragma unroll
  for (int n = 0; n < strip; ++n) {
    height[n] = cell[n] < 0 ? wall_height : level.ground[cell[n]];
    sand[n] = cell[n] < 0 ? 0 : level.sand[cell[n]];
    c.drop[n] = cell[n] < 0 ? 0.0f : level.repose[cell[n]];
  }
  if (level.soil)
#pragma unroll
    for (int n = 0; n < strip; ++n) height[n] += cell[n] < 0 ? 0 : level.soil[cell[n]];
  if (level.obstacle)
#pragma unroll
    for (int n = 0; n < strip; ++n)
      if (cell[n] >= 0 && level.obstacle[cell[n]] > 0.0f) height[n] = wall_height;
  int lowest = wall_height, lowest_depth = wall_height;
#pragma unroll
  for (int n = 0; n < strip; ++n) {
    height[n] = height[n] < wall_height ? height[n] + sand[n] : wall_height;
    lowest = min(lowest, height[n]);
    lowest_depth = min(lowest_depth, height[n] < wall_height ? -height[n] : wall_height);
  }
  lowest = lowest_in_block(lowest, shared.lowest);
  const Units units(lowest, -lowest_in_block(lowest_depth, shared.highest), level.quanta_per_cell);
#pragma unroll
  for (int n = 0; n < strip; ++n) {
    const bool wall = height[n] >= wall_height;
    c.h[n] = wall ? Units::wall : units.height(height[n]);
    c.ground[n] = wall ? Units::wall_ground : c.h[n] - units.depth_over_film(sand[n]);
    c.drop[n] = units.drop(c.drop[n], level.quanta_per_cell);
  }
  return units;
}

template <int strip>
__device__ void cells_of(const RelaxTile& law, const Shared<strip>& shared, int (&cell)[strip]) {
  const int x = law.grid_x(static_cast<int>(blockIdx.x), static_cast<int>(threadIdx.x));
#pragma unroll
  for (int n = 0; n < strip; ++n) {
    const int first = shared.first_of_row[threadIdx.y * strip + n];
    cell[n] = x < 0 || first < 0 ? -1 : first + x;
  }
}

template <int strip, class Onward>
__global__ __launch_bounds__(side* side / strip,
                             threads_at_once* strip / (side * side)) void relax_tiles_kernel(RelaxTile law,
                                                                                             Onward onward) {
  if (law.closed(static_cast<int>(blockIdx.x), static_cast<int>(blockIdx.y))) return;
  constexpr int strips = side / strip;
  __shared__ Shared<strip> shared;
  const int x = static_cast<int>(threadIdx.x), warp = static_cast<int>(threadIdx.y), y = warp * strip;
  if (warp == 0) {
    const int there = law.grid_y(static_cast<int>(blockIdx.y), x);
    shared.first_of_row[x] = there < 0 ? -1 : there * law.level.grid.width;
  }
  build_walls(shared);
  if (law.from_coarse.sand_after)
    for (int n = y * side / strip + x; n < RelaxTile::families; n += side * strips)
      law.prolong_family(static_cast<int>(blockIdx.x), static_cast<int>(blockIdx.y), n);
  __syncthreads();
  Column<strip> c;
  int cell[strip];
  cells_of(law, shared, cell);
  const Units units = load(law, shared, cell, c);
  if (units.lowest >= wall_height) return;

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
  if (!moved) return;
  cells_of(law, shared, cell);
  Quanta* sand = law.level.sand;
#pragma unroll
  for (int n = 0; n < strip; ++n)
    if (cell[n] >= 0 && c.h[n] < Units::wall)
      sand[cell[n]] += units.gain(c.ground[n] + units.depth_over_film(sand[cell[n]]), c.h[n]);
}

template <int strip>
void launch(CudaExec& exec, const RelaxTile& law) {
  const dim3 tiles(law.tiles.columns(), law.tiles.rows()), threads(side, side / strip);
  if (law.onward > 0.0f)
    relax_tiles_kernel<strip><<<tiles, threads, 0, cuda::stream(exec)>>>(law, law.onward);
  else
    relax_tiles_kernel<strip><<<tiles, threads, 0, cuda::stream(exec)>>>(law, NoOnward{});
  check_cuda(cudaGetLastError(), "launch over tiles, tuned");
}

}  // namespace

void relax_tiles(CudaExec& exec, const RelaxTile& law) {
  const int tiles = law.tiles.count();
  if (tiles >= tiles_for_long && !law.open) return launch<long_strip>(exec, law);
  if (tiles >= tiles_for_short) return launch<short_strip>(exec, law);
  launch<shortest_strip>(exec, law);
}

}  // namespace desert_sim::avalanching
