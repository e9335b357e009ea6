#pragma once
/// Neighbour look-up of plants: five uniform grids for radii up to 1/16, ⅛, ¼, ½ and all of `largest_plant`
/// (1.25 … 20 m), with cells at least twice that wide. Nilles 2025 §3.2.6 has no grid for radii up to 1.25 m;
/// with it two million bushes took 0.48 ms less of 4.8 ms a step, and with a sixth one longer
/// (doc/notebook/kernel_experiments.md).
///
/// The key of a plant is its grid and cell. Plants are sorted by key, so that those of cells which lie beside
/// each other in a row do so, too, and of each cell the number of plants in the cells before is known. A
/// periodic axis is divided into a whole number of cells, and distances are to the nearest image.

#include <cstdint>
#include <limits>

#include "kernels/backend/vec4.hpp"
#include "kernels/base/grid.hpp"
#include "kernels/base/math.hpp"
#include "kernels/plants/population.hpp"
#include "kernels/plants/species.hpp"

namespace desert_sim::plants {

/// What neighbours see of a plant, together in memory, because they look at many.
struct alignas(16) Neighbour {
  float x, y, radius;
  Quanta z;
};

struct Lookup {
  static constexpr int levels = 5;
  struct Level {
    int columns = 1, rows = 1, first = 0;  ///< first: index of its first cell
    float per_x = 0, per_y = 0;            ///< cells per metre
    float radius = 0;                      ///< largest radius of its plants [m]
  };
  Level level[levels];
  float width = 0, height = 0;            ///< of the terrain [m]
  float half_width = 0, half_height = 0;  ///< on a periodic axis, else infinity
  bool periodic_x = true, periodic_y = true;
  float slack = 0;  ///< upper bound of the rounding errors of positions [m]
  int cells = 0;    ///< number of cells of all grids

  Lookup() = default;
  /// `largest_plant`: radius that no plant exceeds [m].
  Lookup(const Grid& grid, float largest_plant)
      : width(grid.width * grid.cell_size),
        height(grid.height * grid.cell_size),
        half_width(grid.periodic_x ? 0.5f * width : std::numeric_limits<float>::infinity()),
        half_height(grid.periodic_y ? 0.5f * height : std::numeric_limits<float>::infinity()),
        periodic_x(grid.periodic_x),
        periodic_y(grid.periodic_y),
        slack(1e-6f * maximum(width, height)) {
    for (int n = 0; n < levels; ++n) {
      Level& at = level[n];
      at.radius = largest_plant / static_cast<float>(1 << (levels - 1 - n));
      const float side = maximum(2.0f * at.radius, grid.cell_size);
      at.columns = fitting(width, side, grid.width);
      at.rows = fitting(height, side, grid.height);
      at.per_x = static_cast<float>(at.columns) / width;
      at.per_y = static_cast<float>(at.rows) / height;
      at.first = cells;
      cells += at.columns * at.rows;
    }
  }
  static int fitting(float length, float side, int most) {
    const int whole = static_cast<int>(length / side);
    return whole < 1 ? 1 : (whole > most ? most : whole);
  }

  DESERT_HD int level_of(float radius) const {
    int n = 0;
    while (n < levels - 1 && radius > level[n].radius) ++n;
    return n;
  }
  DESERT_HD int key(float x, float y, float radius) const {
    const Level& at = level[level_of(radius)];
    return at.first + clamp_index(static_cast<int>(y * at.per_y), at.rows) * at.columns +
           clamp_index(static_cast<int>(x * at.per_x), at.columns);
  }
  /// a − b, to the nearest image on a periodic axis; `half` of its length, or infinity on an open one.
  DESERT_HD static float difference(float a, float b, float length, float half) {
    const float d = a - b;
    return fabsf(d) > half ? d - copysignf(length, d) : d;
  }
  /// A coordinate moved onto the grid, to its image there on a periodic axis.
  float wrap_onto_grid_x(double x) const { return wrap_onto_grid(x, width, periodic_x); }
  float wrap_onto_grid_y(double y) const { return wrap_onto_grid(y, height, periodic_y); }
  static float wrap_onto_grid(double at, float length, bool periodic) {
    return static_cast<float>(periodic ? at - length * std::floor(at / length) : at);
  }
  DESERT_HD float difference_x(float a, float b) const { return difference(a, b, width, half_width); }
  DESERT_HD float difference_y(float a, float b) const { return difference(a, b, height, half_height); }
};

/// Cells first … last along an axis that lie within `reach`, not yet wrapped; each at most once.
struct CellRange {
  int first, last;
  DESERT_HD CellRange(float at, float reach, float per_metre, int cells, bool periodic)
      : first(static_cast<int>(floorf((at - reach) * per_metre))),
        last(static_cast<int>(floorf((at + reach) * per_metre))) {
    if (!periodic || last - first + 1 >= cells) {
      const bool whole = periodic;
      first = whole ? 0 : clamp_index(first, cells);
      last = whole ? cells - 1 : clamp_index(last, cells);
    }
  }
};

/// The sorted plants, for visiting those near a point.
struct Neighbourhood {
  Lookup lookup;
  const std::int32_t* begins = nullptr;  ///< of each cell, its first plant; then the number of all plants
  const Neighbour* plants = nullptr;

  /// Calls visit(n, plant) for all plants whose edge is nearer than `beyond` [m] to (x, y), level by level,
  /// in the order of the cells and of the sorted plants. What is found waits until there are several: the
  /// threads of a GPU that look at the same time do not find at the same time.
  template <class Visit>
  DESERT_HD void visit_near(float x, float y, float beyond, const Visit& visit) const {
    constexpr int most = 16;
    int found[most], count = 0;
    const auto visit_found = [&] {
      DESERT_NO_UNROLL
      for (int k = 0; k < count; ++k) visit(found[k], plant(found[k]));
      count = 0;
    };
    DESERT_NO_UNROLL
    for (int n = 0; n < Lookup::levels; ++n)
      for_each_piece(lookup.level[n], x, y, beyond, [&](int begin, int end) {
        DESERT_NO_UNROLL
        for (int i = begin; i < end; ++i) {
          const Neighbour other = plant(i);
          const float dx = lookup.difference_x(x, other.x), dy = lookup.difference_y(y, other.y);
          const float within = beyond + other.radius;
          if (!(dx * dx + dy * dy < within * within)) continue;
          if (count == most) visit_found();
          found[count++] = i;
        }
      });
    visit_found();
  }

 private:
  DESERT_HD Neighbour plant(int n) const {
    const Vec4<std::uint32_t> words = load_vec4(reinterpret_cast<const std::uint32_t*>(plants + n));
    return {float_from_bits(words.values[0]), float_from_bits(words.values[1]),
            float_from_bits(words.values[2]), static_cast<Quanta>(words.values[3])};
  }
  /// Calls piece(begin, end) for the plants begin … end − 1 of each row of cells of a level: in one piece, or
  /// in two where the cells go on beyond the east edge.
  template <class Piece>
  DESERT_HD void for_each_piece(const Lookup::Level& at, float x, float y, float beyond,
                                const Piece& piece) const {
    if (begins[at.first] == begins[at.first + at.columns * at.rows]) return;
    const float reach = at.radius + beyond + lookup.slack;
    const CellRange across(x, reach, at.per_x, at.columns, lookup.periodic_x);
    const CellRange along(y, reach, at.per_y, at.rows, lookup.periodic_y);
    const int first_column = wrap(across.first, at.columns);
    for (int row = along.first; row <= along.last; ++row) {
      const int first = at.first + wrap(row, at.rows) * at.columns;
      int column = first_column, left = across.last - across.first + 1;
      while (left > 0) {
        const int some = left < at.columns - column ? left : at.columns - column;
        piece(begins[first + column], begins[first + column + some]);
        left -= some;
        column = 0;
      }
    }
  }
};

}  // namespace desert_sim::plants
