#pragma once
/// A brush that edits a layer of material, with the weight w of its shape (brush_shape.hpp) in a cell:
///
///   add, sub          v ± w · value
///   replace           lerp(v, value, w)
///   min, max, avg     lerp(v, min(v, value) | max(v, value) | ½(v + value), w)
///   smooth            lerp(v, mean of v over a square, w), several times (brush_smooth.hpp)
///
/// An edit is worked out as a change of each cell of the brush's rectangle, checked, and then booked: depths
/// stop at 0; what is added and removed is in and out of the material.

#include "kernels/edit/brush_shape.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"

namespace desert_sim {

enum class BrushMerge : int { add, sub, replace, min, max, avg, smooth };
constexpr const char* brush_merges[] = {"add", "sub", "replace", "min", "max", "avg", "smooth"};

namespace brush {

/// Buffers of the brush have one value a cell of its rectangle, row-major: `columns` × `rows`.
struct Brush {
  Grid grid;
  int x0, y0, columns, rows;  ///< cells it may touch, before wrapping
  float centre_x, centre_y;   ///< of the shape [cells]
  Shape shape;
  float ring;  ///< width of the ring around the shape that gives and takes [cells]; 0: none
  BrushMerge merge;
  double value;  ///< quanta (above the datum for bedrock)
  double quanta_per_metre;
  bool depth;  ///< cannot fall below 0
  Material material;
  Quanta* layer;
  const Quanta* rest[3];  ///< other layers of the column, or null
  LedgerView ledger;

  DESERT_HD Grid area() const { return Grid{columns, rows, 1.0f, false, false}; }
  DESERT_HD int cell(int x, int y) const { return neighbour_index(grid, x0 + x, y0 + y); }
  DESERT_HD Point point(int x, int y) const { return {x0 + x + 0.5f - centre_x, y0 + y + 0.5f - centre_y}; }

  /// New value of a cell [quanta]; never more than a cell can hold.
  DESERT_HD Quanta edited(int i, Point p, float w) const {
    const double v = layer[i], here = value + quanta_per_metre * shape.height(p);
    double target = here;
    if (merge == BrushMerge::min) target = v < here ? v : here;
    if (merge == BrushMerge::max) target = v > here ? v : here;
    if (merge == BrushMerge::avg) target = 0.5 * (v + here);
    double result = v + w * (target - v);
    if (merge == BrushMerge::add) result = v + w * here;
    if (merge == BrushMerge::sub) result = v - w * here;
    result = rint(result);
    const double lowest = depth ? 0.0 : 1.0 - wall_height, highest = wall_height - 1.0;
    return static_cast<Quanta>(result < lowest ? lowest : (result > highest ? highest : result));
  }
};

/// What the brush does to each cell, by every merge but smooth.
template <class E>
void merge(E& exec, const Brush& b, Quanta* change);

template <class E>
void ring_stock(E& exec, const Brush& b, Quanta* stock);

/// How many cells the change would raise or lower beyond what the height scale holds.
template <class E>
long long cells_beyond_limit(E& exec, const Brush& b, const Quanta* change);

template <class E>
long long total(E& exec, const Brush& b, const Quanta* change);

/// Makes the change. `moved`: its sum is 0, and material only goes from cell to cell.
template <class E>
void book(E& exec, const Brush& b, const Quanta* change, bool moved);

}  // namespace brush
}  // namespace desert_sim
