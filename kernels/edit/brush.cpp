/// Laws and functions of brush.hpp; compiled once for each backend.
#include "kernels/edit/brush.hpp"

#include "kernels/backend/for_each.hpp"
#include "kernels/backend/loops.hpp"
#include "kernels/edit/brush_shape.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"

namespace desert_sim::brush {

struct MergeChange {
  Brush b;
  Quanta* change;
  DESERT_HD void operator()(int x, int y) const {
    const int i = b.cell(x, y);
    const Point p = b.point(x, y);
    const float w = b.shape.weight(p);
    change[y * b.columns + x] = i < 0 || w <= 0.0f ? 0 : b.new_value(i, p, w) - b.layer[i];
  }
};

/// Material in each cell of the ring; −1 in cells outside the ring.
struct RingStock {
  Brush b;
  Quanta* stock;
  DESERT_HD void operator()(int x, int y) const {
    const int i = b.cell(x, y);
    const Point p = b.point(x, y);
    const bool in_ring = i >= 0 && b.shape.covers(p, b.ring) && !b.shape.covers(p, 0.0f);
    // Rock reaches down to the lowest height, so that a ring of it always has enough.
    stock[y * b.columns + x] = !in_ring ? -1 : (b.depth ? b.layer[i] : wall_height);
  }
};

struct BeyondLimit {
  Brush b;
  const Quanta* change;
  DESERT_HD long long operator()(int x, int y) const {
    const int k = y * b.columns + x;
    if (change[k] == 0) return 0;
    const int i = b.cell(x, y);
    long long surface = static_cast<long long>(b.layer[i]) + change[k];
    if (surface >= wall_height - 1 || surface <= 1 - wall_height) return 1;
    for (int n = 0; n < 3; ++n) surface += b.other_layers[n] ? b.other_layers[n][i] : 0;
    return surface >= load_limit || surface <= -load_limit ? 1 : 0;
  }
};

struct Sum {
  int columns;
  const Quanta* change;
  DESERT_HD long long operator()(int x, int y) const { return change[y * columns + x]; }
};

struct CommitChange {
  Brush b;
  const Quanta* change;
  bool moved;  ///< material stays within the layer, so the ledger records nothing
  DESERT_HD void operator()(int x, int y) const {
    const Quanta c = change[y * b.columns + x];
    if (c == 0) return;
    const int i = b.cell(x, y);
    b.layer[i] += c;
    if (moved) return;
    if (c > 0) b.ledger.book_in(b.material, i, c);
    if (c < 0) b.ledger.book_out(b.material, i, -c);
  }
};

struct ReadSteps {
  Grid grid;
  const float* values;
  float steps_per_unit;
  Quanta* steps;
  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    steps[i] = static_cast<Quanta>(rintf(value_or_zero(values, i) * steps_per_unit));
  }
};

struct CommitSteps {
  Brush b;
  const Quanta* change;
  float unit_per_step;
  float* values;
  DESERT_HD void operator()(int x, int y) const {
    const Quanta c = change[y * b.columns + x];
    if (c == 0) return;
    const int i = b.cell(x, y);
    values[i] = static_cast<float>(b.layer[i] + c) * unit_per_step;
  }
};

struct Loosen {
  Brush b;
  const Quanta* change;
  float fresh_depths;  ///< one quantum of sand, over that which loosens
  float* looseness;
  DESERT_HD void operator()(int x, int y) const {
    const Quanta c = change[y * b.columns + x];
    if (c <= 0) return;
    const int i = b.cell(x, y);
    looseness[i] = looseness::loosened(looseness[i], static_cast<float>(c) * fresh_depths);
  }
};

template <class E>
void merge(E& exec, const Brush& b, Quanta* change) {
  for_each_cell(exec, b.area(), MergeChange{b, change});
}

template <class E>
void ring_stock(E& exec, const Brush& b, Quanta* stock) {
  for_each_cell(exec, b.area(), RingStock{b, stock});
}

template <class E>
long long cells_beyond_limit(E& exec, const Brush& b, const Quanta* change) {
  return sum_cells(exec, b.area(), BeyondLimit{b, change});
}

template <class E>
long long total(E& exec, const Brush& b, const Quanta* change) {
  return sum_cells(exec, b.area(), Sum{b.columns, change});
}

template <class E>
void commit_change(E& exec, const Brush& b, const Quanta* change, bool moved) {
  for_each_cell(exec, b.area(), CommitChange{b, change, moved});
}

template <class E>
void read_steps(E& exec, const Grid& grid, const float* values, float steps_per_unit, Quanta* steps) {
  for_each_cell(exec, grid, ReadSteps{grid, values, steps_per_unit, steps});
}

template <class E>
void commit_steps(E& exec, const Brush& b, const Quanta* change, float unit_per_step, float* values) {
  for_each_cell(exec, b.area(), CommitSteps{b, change, unit_per_step, values});
}

template <class E>
void loosen(E& exec, const Brush& b, const Quanta* change, const LoosenessParameters& p, float metres,
            float* looseness) {
  for_each_cell(exec, b.area(), Loosen{b, change, metres / p.fresh_depth, looseness});
}

template void loosen(Backend&, const Brush&, const Quanta*, const LoosenessParameters&, float, float*);
template void merge(Backend&, const Brush&, Quanta*);
template void ring_stock(Backend&, const Brush&, Quanta*);
template long long cells_beyond_limit(Backend&, const Brush&, const Quanta*);
template long long total(Backend&, const Brush&, const Quanta*);
template void read_steps(Backend&, const Grid&, const float*, float, Quanta*);
template void commit_steps(Backend&, const Brush&, const Quanta*, float, float*);
template void commit_change(Backend&, const Brush&, const Quanta*, bool);

}  // namespace desert_sim::brush
