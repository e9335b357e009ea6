#pragma once
/// A brush that edits a layer of material. w is the weight of its shape in a cell (brush_shape.hpp), v the
/// cell's value:
///
///   add, sub          v ± w · value
///   replace           lerp(v, value, w)
///   min, max, avg     lerp(v, min(v, value) | max(v, value) | ½(v + value), w)
///   smooth            lerp(v, mean of v over a square, w), repeated (brush_smooth.hpp)
///
/// An edit is computed as the change of each cell in the brush's rectangle, checked, and then applied. Depths
/// do not fall below 0. The ledger records what is added or removed as inflow or outflow of the material.
///
/// Layers of real numbers are edited as integers that count steps (2⁻²⁰ of obstacles), which floats represent
/// exactly; cells that an edit does not change keep their bits.

#include "kernels/edit/brush_shape.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/sand/looseness.hpp"

namespace desert_sim {

enum class BrushMerge : int { add, sub, replace, min, max, avg, smooth };
constexpr const char* brush_merges[] = {"add", "sub", "replace", "min", "max", "avg", "smooth"};

namespace brush {

/// A brush on a grid. Its buffers have one value a cell of its rectangle, row-major: `columns` × `rows`.
struct Brush {
  Grid grid;
  int x0, y0, columns, rows;  ///< rectangle of the cells it may touch, before wrapping
  float centre_x, centre_y;   ///< of the shape [cells]
  Shape shape;
  float ring;  ///< width of the ring that gives and takes material [cells]; 0: none
  BrushMerge merge;
  double value;  ///< quanta (above the datum for bedrock)
  double quanta_per_metre;
  bool depth;              ///< a depth of material: a ring of it has what there is
  Quanta lowest, highest;  ///< what a cell may become
  Material material;
  Quanta* layer;
  const Quanta* other_layers[3];  ///< other layers of the column, or null
  LedgerView ledger;

  DESERT_HD Grid area() const { return Grid{columns, rows, 1.0f, false, false}; }
  DESERT_HD int cell(int x, int y) const { return neighbour_index(grid, x0 + x, y0 + y); }
  DESERT_HD Point point(int x, int y) const { return {x0 + x + 0.5f - centre_x, y0 + y + 0.5f - centre_y}; }

  /// New value of a cell [quanta], limited to what a cell can hold.
  DESERT_HD Quanta new_value(int i, Point p, float w) const {
    const double v = layer[i], brush_value = value + quanta_per_metre * shape.height(p);
    double target = brush_value;
    if (merge == BrushMerge::min) target = v < brush_value ? v : brush_value;
    if (merge == BrushMerge::max) target = v > brush_value ? v : brush_value;
    if (merge == BrushMerge::avg) target = 0.5 * (v + brush_value);
    double result = v + w * (target - v);
    if (merge == BrushMerge::add) result = v + w * brush_value;
    if (merge == BrushMerge::sub) result = v - w * brush_value;
    result = rint(result);
    return static_cast<Quanta>(result < lowest ? lowest : (result > highest ? highest : result));
  }
};

/// Writes the change of each cell to `change`, for every merge but smooth.
template <class E>
void merge(E& exec, const Brush& b, Quanta* change);

template <class E>
void ring_stock(E& exec, const Brush& b, Quanta* stock);

/// Number of cells that the change would raise or lower beyond the limit of the height scale.
template <class E>
long long cells_beyond_limit(E& exec, const Brush& b, const Quanta* change);

template <class E>
long long total(E& exec, const Brush& b, const Quanta* change);

/// A layer of real numbers as a brush edits it, of all cells of the grid; `values` may be null, which is 0
/// everywhere.
template <class E>
void read_steps(E& exec, const Grid& grid, const float* values, float steps_per_unit, Quanta* steps);

/// Applies the change to the values; `b.layer` is what read_steps() gave, and `unit_per_step` a power of two.
template <class E>
void commit_steps(E& exec, const Brush& b, const Quanta* change, float unit_per_step, float* values);

/// Loosens the ground where the change adds sand; see looseness.hpp. `metres`: a quantum.
template <class E>
void loosen(E& exec, const Brush& b, const Quanta* change, const LoosenessParameters& p, float metres,
            float* looseness);

/// Applies the change. `moved`: it sums to 0, because material only moves from cell to cell.
template <class E>
void commit_change(E& exec, const Brush& b, const Quanta* change, bool moved);

}  // namespace brush
}  // namespace desert_sim
