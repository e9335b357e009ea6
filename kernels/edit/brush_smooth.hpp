#pragma once
/// The brush's merge `smooth`: by its weight, a cell moves towards the mean of the (2r + 1)² cells around it;
/// repeated. Every pass sees what the pass before left. Means wrap over periodic borders and take the cells
/// that there are at open ones.

#include "kernels/backend/buffer.hpp"
#include "kernels/edit/brush.hpp"

namespace desert_sim::brush {

/// Scratch: `values` one a cell of the terrain, `sums` one a cell of the brush's rectangle grown by `radius`
/// above and below.
struct SmoothWorkspace {
  Buffer<Quanta> values;
  Buffer<long long> sums;
};

/// What smoothing does to each cell.
template <class E>
void smooth(E& exec, const Brush& b, int radius, int passes, SmoothWorkspace& work, Quanta* change);

}  // namespace desert_sim::brush
