#pragma once
/// Paths as points, and what they cost on a grid.

#include <optional>
#include <vector>

#include "src/planner/cost_grid.hpp"

namespace desert_sim {

using GridPath = std::vector<GridPoint>;

/// What a straight line costs, ∫ c ds / (4 m): its length [m] where the ground is the best; none if it meets
/// a lethal cell or leaves the grid. The cells that it crosses are met exactly; `free_start`: the distance
/// from its beginning up to which lethal cells count as the worst passable ones, for a rover that stands too
/// near to one.
std::optional<double> line_cost(const CostGrid& grid, const GridPoint& from, const GridPoint& to,
                                double free_start = 0);
/// The same of a path from point to point.
std::optional<double> path_cost(const CostGrid& grid, const GridPath& path, double free_start = 0);

/// The centres of cells as points, those between which a straight line costs no more than the cells' way left
/// out.
GridPath shortened(const CostGrid& grid, const std::vector<CellIndex>& cells);
/// The same path with a point at least every `spacing` [m].
GridPath resampled(const GridPath& path, double spacing);

double path_length(const GridPath& path);  ///< [m]

}  // namespace desert_sim
