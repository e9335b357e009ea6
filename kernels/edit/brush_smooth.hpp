#pragma once
/// The brush's merge `smooth`: in each pass, a cell's value v moves by the shape's weight w towards the mean
/// of the (2r + 1)² cells around it,
///
///   v ← v + w (mean(v) − v)
///
/// starting from the result of the pass before. Means wrap over periodic borders, and take only the existing
/// cells at open ones.

#include "kernels/backend/buffer.hpp"
#include "kernels/edit/brush.hpp"

namespace desert_sim::brush {

/// Work buffers: `values` has one value a cell of the terrain, `sums` one a cell of the brush's rectangle,
/// extended by `radius` rows in the north and south.
struct SmoothWorkspace {
  Buffer<Quanta> values;
  Buffer<long long> sums;
};

/// Writes the change of each cell after `passes` passes to `change`.
template <class E>
void smooth(E& exec, const Brush& b, int radius, int passes, SmoothWorkspace& work, Quanta* change);

}  // namespace desert_sim::brush
