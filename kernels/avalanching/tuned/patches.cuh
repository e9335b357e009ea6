#pragma once
/// Transfer of a tile's patches from global to shared memory and back.

#include "kernels/avalanching/tuned/sweeps.cuh"

namespace desert_sim::avalanching::tuned {

/// One value for each cell of a patch, in registers.
template <class T>
struct PatchValues {
  Vec4<T> rows[Patch::side];
  __device__ T& operator[](int n) { return rows[n / Patch::side].values[n % Patch::side]; }
};

/// The ground of all patches [quanta], kept in shared memory for the law that follows the sweeps, if there is
/// one.
struct Ground {
  Vec4<Quanta> rows[Patch::side][threads];
};

/// Where a thread's patch lies in the grid. With `patch_aligned`, the grid's width and height are multiples
/// of four, as the tiles' offset is, so that a patch lies completely inside the grid, with aligned rows, or
/// completely outside.
template <bool patch_aligned>
struct PatchLocation {
  const RelaxTile& law;
  /// First cell of the patch: its position in the grid if `patch_aligned` (−1 where the patch lies outside),
  /// else in the tile.
  int x, y;

  __device__ explicit PatchLocation(const RelaxTile& tile)
      : law(tile),
        x(static_cast<int>(threadIdx.x) % patches * Patch::side),
        y(static_cast<int>(threadIdx.x) / patches * Patch::side) {
    if (!patch_aligned) return;
    x = grid_x(x);
    y = grid_y(y);
  }
  __device__ bool is_in_grid() const { return x >= 0 && y >= 0; }  ///< valid if `patch_aligned`
  __device__ bool is_in_grid(int n) const {
    return patch_aligned ? is_in_grid() : cell(n / Patch::side, n % Patch::side) >= 0;
  }
  /// Index of a cell in the grid, or −1 where it does not exist.
  __device__ int cell(int row, int column) const {
    const int width = law.level.grid.width;
    if (patch_aligned) return is_in_grid() ? (y + row) * width + x + column : -1;
    const int cell_x = grid_x(x + column), cell_y = grid_y(y + row);
    return cell_x < 0 || cell_y < 0 ? -1 : cell_y * width + cell_x;
  }
  /// Changes of the two coarse cells whose children are the cells of rows `row` and `row` + 1.
  __device__ Vec2<Quanta> changes(int row) const {
    const Prolong& from = law.from_coarse;
    if constexpr (patch_aligned) {
      if (!is_in_grid()) return {};
      const int i = from.coarse.index(x / 2, (y + row) / 2);
      const Vec2<Quanta> after = load_vec<2>(from.sand_after + i), before = load_vec<2>(from.sand_before + i);
      return {after.values[0] - before.values[0], after.values[1] - before.values[1]};
    } else {
      return {change(row, 0), change(row, 2)};
    }
  }

  /// Loads a layer. Cells that do not exist get values of other cells; their heights will be those of walls.
  template <class T>
  __device__ void fetch(const T* from, PatchValues<T>& to) const {
#pragma unroll
    for (int row = 0; row < Patch::side; ++row) {
      if constexpr (patch_aligned) {
        to.rows[row] = load_vec4(from + (is_in_grid() ? cell(row, 0) : 0));
      } else {
#pragma unroll
        for (int n = 0; n < Patch::side; ++n) {
          const int i = cell(row, n);
          to.rows[row].values[n] = from[i < 0 ? 0 : i];
        }
      }
    }
  }
  __device__ void store_row(Quanta* to, int row, const Vec4<Quanta>& four) const {
    if constexpr (patch_aligned) {
      if (is_in_grid()) store_vec4(to + cell(row, 0), four);
    } else {
#pragma unroll
      for (int n = 0; n < Patch::side; ++n)
        if (const int i = cell(row, n); i >= 0) to[i] = four.values[n];
    }
  }

 private:
  __device__ Quanta change(int row, int column) const {
    const Prolong& from = law.from_coarse;
    const int cell_x = grid_x(x + column), cell_y = grid_y(y + row);
    if (cell_x < 0 || cell_y < 0 || !from.coarse.inside(cell_x / 2, cell_y / 2)) return 0;
    return from.change(from.coarse.index(cell_x / 2, cell_y / 2));
  }
  __device__ int grid_x(int n) const { return law.grid_x(static_cast<int>(blockIdx.x), n); }
  __device__ int grid_y(int n) const { return law.grid_y(static_cast<int>(blockIdx.y), n); }
};

/// Minimum over the threads of a warp.
__device__ inline int warp_min(int value) {
#if __CUDA_ARCH__ >= 800
  return __reduce_min_sync(0xffffffffu, value);
#else
  for (int step = 16; step > 0; step /= 2) value = min(value, __shfl_xor_sync(0xffffffffu, value, step));
  return value;
#endif
}
__device__ inline int warp_max(int value) { return ~warp_min(~value); }

/// Range of the tile (thread block), combined from those of the threads.
__device__ inline Range range_of_block(Shared& shared, Range range) {
  range = {warp_min(range.lowest), warp_max(range.highest), warp_max(range.highest_ground)};
  if (threadIdx.x % 32 == 0) shared.range[threadIdx.x / 32] = range;
  __syncthreads();
  for (int n = 0; n < warps; ++n) {
    const Range& other = shared.range[n];
    range = {min(range.lowest, other.lowest), max(range.highest, other.highest),
             max(range.highest_ground, other.highest_ground)};
  }
  return range;
}

/// Groups of a coarse cell's children in a patch, along an axis.
constexpr int sibling_groups = Patch::side / 2;

/// Loads the changes of the coarse cells above the patch; 0 if there is nothing to prolong.
template <bool patch_aligned>
__device__ void fetch_changes(const PatchLocation<patch_aligned>& patch,
                              Vec2<Quanta> (&change)[sibling_groups]) {
#pragma unroll
  for (int row = 0; row < sibling_groups; ++row)
    change[row] = patch.law.from_coarse.sand_after ? patch.changes(2 * row) : Vec2<Quanta>{};
}

/// Prolongs them to the sand of the children.
__device__ inline void prolong(const Vec2<Quanta> (&change)[sibling_groups], PatchValues<Quanta>& sand) {
  const auto for_each_sibling_group = [&](const auto& body) {
#pragma unroll
    for (int n = 0; n < sibling_groups * sibling_groups; ++n) {
      const int row = n / sibling_groups, column = n % sibling_groups;
      Quanta *south = sand.rows[2 * row].values + 2 * column,
             *north = sand.rows[2 * row + 1].values + 2 * column;
      body(change[row].values[column], south[0], south[1], north[0], north[1]);
    }
  };
  bool enough = true;  // for all children first: one branch, which is hardly ever taken
  for_each_sibling_group([&](Quanta d, Quanta& sw, Quanta& se, Quanta& nw, Quanta& ne) {
    enough = enough && have_enough_sand(d, sw, se, nw, ne);
  });
  if (enough)
    for_each_sibling_group([&](Quanta d, Quanta& sw, Quanta& se, Quanta& nw, Quanta& ne) {
      sw += d, se += d, nw += d, ne += d;
    });
  else
    for_each_sibling_group(
        [](Quanta d, Quanta& sw, Quanta& se, Quanta& nw, Quanta& ne) { prolong_change(d, sw, se, nw, ne); });
}

/// Turns ground into heights by adding soil and sand. Walls, and cells that do not exist, get wall_height or
/// more.
template <bool patch_aligned>
__device__ void ground_to_height(const PatchLocation<patch_aligned>& patch, PatchValues<Quanta>& height,
                                 PatchValues<Quanta>& sand) {
  const LevelView& level = patch.law.level;
  if (level.soil) {
    PatchValues<Quanta> soil;
    patch.fetch(level.soil, soil);
#pragma unroll
    for (int n = 0; n < Patch::cells; ++n) height[n] += height[n] < wall_height ? soil[n] : 0;
  }
  if (level.obstacle) {
    PatchValues<float> obstacle;
    patch.fetch(level.obstacle, obstacle);
#pragma unroll
    for (int n = 0; n < Patch::cells; ++n) height[n] = obstacle[n] > 0.0f ? wall_height : height[n];
  }
#pragma unroll
  for (int n = 0; n < Patch::cells; ++n) {
    height[n] += sand[n];
    if (!patch.is_in_grid(n)) height[n] = wall_height;
  }
}

/// Range of a patch, without its walls; `walls`: whether it has any.
__device__ inline Range range_of_patch(PatchValues<Quanta>& height, PatchValues<Quanta>& sand, bool& walls) {
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

/// Loads a patch into shared memory, and returns the tile's range. `kept_ground` gets the ground; it may be
/// null. `walls`: whether the patch has any.
template <bool patch_aligned>
__device__ Range load(const PatchLocation<patch_aligned>& patch, Shared& shared, Ground* kept_ground,
                      bool& walls) {
  const LevelView& level = patch.law.level;
  PatchValues<Quanta> height, sand;
  PatchValues<float> drop;
  Vec2<Quanta> change[sibling_groups];
  patch.fetch(level.ground, height);
  patch.fetch(static_cast<const Quanta*>(level.sand), sand);
  fetch_changes(patch, change);
  patch.fetch(level.repose, drop);
  // Done while the loads above are under way.
  if (threadIdx.x < side + Patch::side)
    shared.share[threadIdx.x] = patch.law.share(static_cast<int>(threadIdx.x));
  prolong(change, sand);
  ground_to_height(patch, height, sand);
  if (kept_ground) {
#pragma unroll
    for (int row = 0; row < Patch::side; ++row) {
      Vec4<Quanta>& ground = kept_ground->rows[row][threadIdx.x];
#pragma unroll
      for (int n = 0; n < Patch::side; ++n)
        ground.values[n] = height.rows[row].values[n] - sand.rows[row].values[n];
    }
  }
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

/// The sand of one row of the patch after the sweeps.
__device__ inline Vec4<Quanta> sand_of_row(Shared& shared, const Units& units, int row) {
  const int px = static_cast<int>(threadIdx.x) % patches, py = static_cast<int>(threadIdx.x) / patches;
  Vec4<Quanta> sand = shared.base[row][threadIdx.x];
#pragma unroll
  for (int n = 0; n < Patch::side; ++n)
    sand.values[n] += units.of_height(shared.h.at(px * Patch::side + n, py * Patch::side + row));
  return sand;
}

}  // namespace desert_sim::avalanching::tuned
