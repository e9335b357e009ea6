#pragma once
/// A brush that edits a layer of material: weight 1 within `inner` of its radius, falling linearly to 0 at
/// its edge.
///
///   add, sub          v ± weight · value
///   replace           lerp(v, value, weight)
///   min, max, avg     lerp(v, min(v, value) | max(v, value) | ½(v + value), weight)
///
/// Depths stop at 0. What is added and removed is booked as in and out of the material.

#include "desert_sim/kernels/for_each.hpp"
#include "desert_sim/kernels/layers.hpp"
#include "desert_sim/kernels/ledger.hpp"
#include "desert_sim/kernels/math.hpp"

namespace desert_sim {

enum class BrushMerge : int { add, sub, replace, min, max, avg };
constexpr const char* brush_merges[] = {"add", "sub", "replace", "min", "max", "avg"};

namespace brush {

struct Brush {
  Grid grid;
  int x0, y0, columns, rows;  ///< cells it may touch, before wrapping
  float centre_x, centre_y;   ///< [cells]
  float radius_x, radius_y;   ///< semi-axes [cells]
  float cos, sin, inner;
  BrushMerge merge;
  double value;  ///< quanta (above the datum for bedrock)
  bool depth;    ///< cannot fall below 0
  Material material;
  Quanta* layer;
  const Quanta* rest[2];  ///< other layers that make up the surface, or null
  LedgerView ledger;

  DESERT_HD Grid area() const { return Grid{columns, rows, 1.0f, false, false}; }
  DESERT_HD int cell(int x, int y) const { return neighbour_index(grid, x0 + x, y0 + y); }

  DESERT_HD float weight(int x, int y) const {
    const float dx = x0 + x + 0.5f - centre_x, dy = y0 + y + 0.5f - centre_y;
    const float along = (dx * cos + dy * sin) / radius_x, across = (dy * cos - dx * sin) / radius_y;
    const float r = hypotenuse(along, across);
    if (r > 1.0f) return 0.0f;
    return r <= inner ? 1.0f : (1.0f - r) / (1.0f - inner);
  }

  /// New value of a cell [quanta], not yet limited.
  DESERT_HD double edited(int i, float w) const {
    const double v = layer[i];
    double target = value;
    if (merge == BrushMerge::add) return v + w * value;
    if (merge == BrushMerge::sub) return v - w * value;
    if (merge == BrushMerge::min) target = v < value ? v : value;
    if (merge == BrushMerge::max) target = v > value ? v : value;
    if (merge == BrushMerge::avg) target = 0.5 * (v + value);
    return v + w * (target - v);
  }
};

struct Apply {
  Brush b;
  DESERT_HD void operator()(int x, int y) const {
    const int i = b.cell(x, y);
    const float w = b.weight(x, y);
    if (i < 0 || w <= 0.0f) return;
    double edited = rint(b.edited(i, w));
    if (b.depth && edited < 0) edited = 0;
    const Quanta change = static_cast<Quanta>(edited) - b.layer[i];
    b.layer[i] += change;
    if (change > 0) b.ledger.book_in(b.material, i, change);
    if (change < 0) b.ledger.book_out(b.material, i, -change);
  }
};

struct BeyondLimit {
  Brush b;
  DESERT_HD long long operator()(int x, int y) const {
    const int i = b.cell(x, y);
    const float w = b.weight(x, y);
    if (i < 0 || w <= 0.0f) return 0;
    double surface = b.edited(i, w);
    if (b.depth && surface < 0) surface = 0;
    for (int n = 0; n < 2; ++n) surface += b.rest[n] ? b.rest[n][i] : 0;
    return surface >= load_limit || surface <= -load_limit ? 1 : 0;
  }
};

template <class E>
void apply(E& exec, const Brush& b) {
  for_each_cell(exec, b.area(), Apply{b});
}

/// How many cells the brush would raise or lower beyond what the height scale holds.
template <class E>
long long cells_beyond_limit(E& exec, const Brush& b) {
  return sum_cells(exec, b.area(), BeyondLimit{b});
}

}  // namespace brush
}  // namespace desert_sim
