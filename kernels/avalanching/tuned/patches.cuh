#pragma once
/// Transfer of a tile's patches from global to shared memory and back.

#include "kernels/avalanching/tuned/sweeps.cuh"

namespace desert_sim::avalanching::tuned {

/// One value for each cell of a patch, in registers.
template <class T>
struct OfPatch {
  Vec4<T> rows[Patch::side];
  __device__ T& operator[](int n) { return rows[n / Patch::side].values[n % Patch::side]; }
};

/// The ground of all patches [quanta], kept in shared memory for the law that follows the sweeps, if there is
/// one.
struct Ground {
  Vec4<Quanta> rows[Patch::side][threads];
};

/// Where a thread's patch lies in the grid. `whole`: the grid's width and height are multiples of four, as
/// the tiles' offset is, so that a patch lies completely inside the grid, with aligned rows, or completely
/// outside.
template <bool whole>
struct Place {
  const RelaxTile& law;
  /// First cell of the patch: its place in the grid if `whole` (−1 where the patch lies outside), else in the
  /// tile.
  int x, y;

  __device__ explicit Place(const RelaxTile& tile)
      : law(tile),
        x(static_cast<int>(threadIdx.x) % patches * Patch::side),
        y(static_cast<int>(threadIdx.x) / patches * Patch::side) {
    if (!whole) return;
    x = grid_x(x);
    y = grid_y(y);
  }
  __device__ bool there() const { return x >= 0 && y >= 0; }  ///< valid if `whole`
  __device__ bool there(int n) const { return whole ? there() : cell(n / Patch::side, n % Patch::side) >= 0; }
  /// Index of a cell in the grid, or −1 where it does not exist.
  __device__ int cell(int row, int column) const {
    const int width = law.level.grid.width;
    if (whole) return there() ? (y + row) * width + x + column : -1;
    const int there_x = grid_x(x + column), there_y = grid_y(y + row);
    return there_x < 0 || there_y < 0 ? -1 : there_y * width + there_x;
  }
  /// Changes of the two coarse cells whose children are the cells of rows `row` and `row` + 1.
  __device__ Vec2<Quanta> changes(int row) const {
    const Prolong& from = law.from_coarse;
    if constexpr (whole) {
      if (!there()) return {};
      const int i = from.coarse.index(x / 2, (y + row) / 2);
      const Vec2<Quanta> after = load_vec<2>(from.sand_after + i), before = load_vec<2>(from.sand_before + i);
      return {after.values[0] - before.values[0], after.values[1] - before.values[1]};
    } else {
      return {change(row, 0), change(row, 2)};
    }
  }

  /// Loads a layer. Cells that do not exist get values of other cells; their heights will be those of walls.
  template <class T>
  __device__ void fetch(const T* from, OfPatch<T>& to) const {
#pragma unroll
    for (int row = 0; row < Patch::side; ++row) {
      if constexpr (whole) {
        to.rows[row] = load_vec4(from + (there() ? cell(row, 0) : 0));
      } else {
#pragma unroll
        for (int n = 0; n < Patch::side; ++n) {
          const int i = cell(row, n);
          to.rows[row].values[n] = from[i < 0 ? 0 : i];
        }
      }
    }
  }
  __device__ void put_row(Quanta* to, int row, const Vec4<Quanta>& four) const {
    if constexpr (whole) {
      if (there()) store_vec4(to + cell(row, 0), four);
    } else {
#pragma unroll
      for (int n = 0; n < Patch::side; ++n)
        if (const int i = cell(row, n); i >= 0) to[i] = four.values[n];
    }
  }

 private:
  __device__ Quanta change(int row, int column) const {
    const Prolong& from = law.from_coarse;
    const int there_x = grid_x(x + column), there_y = grid_y(y + row);
    if (there_x < 0 || there_y < 0 || !from.coarse.inside(there_x / 2, there_y / 2)) return 0;
    return from.change(from.coarse.index(there_x / 2, there_y / 2));
  }
  __device__ int grid_x(int n) const { return law.grid_x(static_cast<int>(blockIdx.x), n); }
  __device__ int grid_y(int n) const { return law.grid_y(static_cast<int>(blockIdx.y), n); }
};

/// Minimum over the threads of a warp.
__device__ inline int lowest_of_warp(int value) {
#if __CUDA_ARCH__ >= 800
  return __reduce_min_sync(0xffffffffu, value);
#else
  for (int step = 16; step > 0; step /= 2) value = min(value, __shfl_xor_sync(0xffffffffu, value, step));
  return value;
#endif
}
__device__ inline int highest_of_warp(int value) { return ~lowest_of_warp(~value); }

/// Range of the tile (thread block), combined from those of the threads.
__device__ inline Range range_of_block(Shared& shared, Range range) {
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

constexpr int families = Patch::side / 2;  ///< groups of a coarse cell's children in a patch, along an axis

/// Loads the changes of the coarse cells above the patch; 0 if there is nothing to prolong.
template <bool whole>
__device__ void fetch_changes(const Place<whole>& place, Vec2<Quanta> (&change)[families]) {
#pragma unroll
  for (int row = 0; row < families; ++row)
    change[row] = place.law.from_coarse.sand_after ? place.changes(2 * row) : Vec2<Quanta>{};
}

/// Prolongs them to the sand of the children.
__device__ inline void prolong(const Vec2<Quanta> (&change)[families], OfPatch<Quanta>& sand) {
  const auto for_each_family = [&](const auto& body) {
#pragma unroll
    for (int n = 0; n < families * families; ++n) {
      const int row = n / families, column = n % families;
      Quanta *south = sand.rows[2 * row].values + 2 * column,
             *north = sand.rows[2 * row + 1].values + 2 * column;
      body(change[row].values[column], south[0], south[1], north[0], north[1]);
    }
  };
  bool enough = true;  // for all children first: one branch, which is hardly ever taken
  for_each_family([&](Quanta d, Quanta& sw, Quanta& se, Quanta& nw, Quanta& ne) {
    enough = enough && have_enough_sand(d, sw, se, nw, ne);
  });
  if (enough)
    for_each_family([&](Quanta d, Quanta& sw, Quanta& se, Quanta& nw, Quanta& ne) {
      sw += d, se += d, nw += d, ne += d;
    });
  else
    for_each_family(
        [](Quanta d, Quanta& sw, Quanta& se, Quanta& nw, Quanta& ne) { prolong_change(d, sw, se, nw, ne); });
}

/// Turns ground into heights by adding soil and sand. Walls, and cells that do not exist, get wall_height or
/// more.
template <bool whole>
__device__ void add_up(const Place<whole>& place, OfPatch<Quanta>& height, OfPatch<Quanta>& sand) {
  const LevelView& level = place.law.level;
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

/// Range of a patch, without its walls; `walls`: whether it has any.
__device__ inline Range range_of_patch(OfPatch<Quanta>& height, OfPatch<Quanta>& sand, bool& walls) {
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

/// Loads a patch into shared memory, and returns the tile's range. `kept` gets the ground; it may be null.
template <bool whole>
__device__ Range load(const Place<whole>& place, Shared& shared, Ground* kept) {
  const LevelView& level = place.law.level;
  OfPatch<Quanta> height, sand;
  OfPatch<float> drop;
  Vec2<Quanta> change[families];
  place.fetch(level.ground, height);
  place.fetch(static_cast<const Quanta*>(level.sand), sand);
  fetch_changes(place, change);
  place.fetch(level.repose, drop);
  // Done while the loads above are under way.
  if (threadIdx.x < side + Patch::side)
    shared.share[threadIdx.x] = place.law.share(static_cast<int>(threadIdx.x));
  prolong(change, sand);
  add_up(place, height, sand);
  if (kept) {
#pragma unroll
    for (int row = 0; row < Patch::side; ++row) {
      Vec4<Quanta>& ground = kept->rows[row][threadIdx.x];
#pragma unroll
      for (int n = 0; n < Patch::side; ++n)
        ground.values[n] = height.rows[row].values[n] - sand.rows[row].values[n];
    }
  }
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
