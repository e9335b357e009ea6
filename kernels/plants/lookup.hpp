#pragma once
/// Neighbour look-up of plants: five uniform grids for radii up to 1/16, ⅛, ¼, ½ and all of `largest_plant`
/// (1.25 … 20 m), with cells at least twice that wide. Nilles 2025 §3.2.6 has no grid for radii up to 1.25 m;
/// with it two million bushes take 0.48 ms less of 4.8 ms a step (test/bench/oasis.yaml), and a sixth grid
/// takes longer.
///
/// The key of a plant is its grid and cell. Plants are sorted by key, and each cell has the span of its
/// plants. A periodic axis is divided into a whole number of cells, and distances are to the nearest image.

#include <cstdint>

#include "kernels/base/grid.hpp"
#include "kernels/base/math.hpp"
#include "kernels/plants/population.hpp"
#include "kernels/plants/species.hpp"

namespace desert_sim::plants {

/// Plants begin … end − 1.
struct Span {
  std::int32_t begin, end;
};

struct Lookup {
  static constexpr int levels = 5;
  struct Level {
    int columns = 1, rows = 1, first = 0;  ///< first: index of its first cell
    float per_x = 0, per_y = 0;            ///< cells per metre
    float radius = 0;                      ///< largest radius of its plants [m]
  };
  Level level[levels];
  float width = 0, height = 0;  ///< of the terrain [m]
  bool periodic_x = true, periodic_y = true;
  float slack = 0;  ///< upper bound of the rounding errors of positions [m]
  int cells = 0;    ///< number of cells of all grids

  Lookup() = default;
  /// `largest_plant`: radius that no plant exceeds [m].
  Lookup(const Grid& grid, float largest_plant)
      : width(grid.width * grid.cell_size),
        height(grid.height * grid.cell_size),
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
  DESERT_HD int level_of_cell(int cell) const {
    int n = 0;
    while (n < levels - 1 && cell >= level[n + 1].first) ++n;
    return n;
  }
  DESERT_HD int key(float x, float y, float radius) const {
    const Level& at = level[level_of(radius)];
    return at.first + clamp_index(static_cast<int>(y * at.per_y), at.rows) * at.columns +
           clamp_index(static_cast<int>(x * at.per_x), at.columns);
  }
  /// a − b, to the nearest image on a periodic axis.
  DESERT_HD static float difference(float a, float b, float length, bool periodic) {
    const float d = a - b;
    if (!periodic) return d;
    return d > 0.5f * length ? d - length : (d < -0.5f * length ? d + length : d);
  }
  /// A coordinate moved onto the grid, to its image there on a periodic axis.
  float wrap_onto_grid_x(double x) const { return wrap_onto_grid(x, width, periodic_x); }
  float wrap_onto_grid_y(double y) const { return wrap_onto_grid(y, height, periodic_y); }
  static float wrap_onto_grid(double at, float length, bool periodic) {
    return static_cast<float>(periodic ? at - length * std::floor(at / length) : at);
  }
  DESERT_HD float difference_x(float a, float b) const { return difference(a, b, width, periodic_x); }
  DESERT_HD float difference_y(float a, float b) const { return difference(a, b, height, periodic_y); }
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

/// Spans of the sorted plants, for visiting those near a point.
struct Neighbourhood {
  Lookup lookup;
  const Span* spans = nullptr;  ///< of the cells, followed by those of the levels

  /// Calls visit(n) for each plant of a level in the cells within `reach` [m] of (x, y), in the order of the
  /// cells and of the sorted plants.
  template <class Visit>
  DESERT_HD void visit_level(int number, float x, float y, float reach, const Visit& visit) const {
    const Span all = spans[lookup.cells + number];
    if (all.begin == all.end) return;
    const Lookup::Level& at = lookup.level[number];
    const float wide = reach + lookup.slack;
    const CellRange across(x, wide, at.per_x, at.columns, lookup.periodic_x);
    const CellRange along(y, wide, at.per_y, at.rows, lookup.periodic_y);
    for (int row = along.first; row <= along.last; ++row) {
      const int first = at.first + wrap(row, at.rows) * at.columns;
      for (int column = across.first; column <= across.last; ++column) {
        const Span span = spans[first + wrap(column, at.columns)];
        for (int n = span.begin; n < span.end; ++n) visit(n);
      }
    }
  }
  /// Visits the plants of all levels that may reach (x, y) with their own radius plus `beyond` [m].
  template <class Visit>
  DESERT_HD void visit_near(float x, float y, float beyond, const Visit& visit) const {
    for (int n = 0; n < Lookup::levels; ++n) visit_level(n, x, y, lookup.level[n].radius + beyond, visit);
  }
};

}  // namespace desert_sim::plants
