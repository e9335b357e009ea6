#pragma once
/// Sums and statistics over the whole terrain. Each function reads a result back and so waits for the device;
/// none is part of a step.

#include "kernels/backend/exec.hpp"
#include "kernels/field/layers.hpp"

namespace desert_sim {

namespace statistics {

template <class E>
long long sum(E& exec, const Grid& grid, const Quanta* layer);

/// Whether a value breaks the contract of its layer: a negative depth, a height at or beyond that of walls,
/// or a float that is not finite. A depth may be larger than the height of a wall: it reaches from below the
/// datum.
DESERT_HD bool breaks_contract(Quanta value, bool depth) {
  return depth ? value < 0 : value >= wall_height || value <= -wall_height;
}
DESERT_HD bool breaks_contract(float value) { return !(value - value == 0.0f); }
/// Cells whose values do.
template <class E>
long long count_violations(E& exec, const Grid& grid, const Quanta* quanta, const float* real, bool depth);

template <class E>
float sand_slope(E& exec, const TerrainView& t);

}  // namespace statistics
}  // namespace desert_sim
