#pragma once
/// The cost of a cell for a planner, as an occupancy grid has it (nav_msgs/OccupancyGrid):
///
///   cost = lethal                 where the traversability t is 0
///          round(99 (1 − t))      where 0 < t ≤ 1, so 0 … 99
///          unknown                where t is NaN

#include <cstdint>

#include "kernels/base/math.hpp"

namespace desert_sim::cell_cost {

constexpr std::int8_t unknown = -1, lethal = 100;

DESERT_HD std::int8_t of(float traversability) {
  if (!(traversability == traversability)) return unknown;
  if (traversability <= 0.0f) return lethal;
  return static_cast<std::int8_t>(round_to_int(99.0f * (1.0f - minimum(traversability, 1.0f))));
}

}  // namespace desert_sim::cell_cost
