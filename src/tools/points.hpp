#pragma once
/// Points of a terrain as options name them.

#include <string>
#include <vector>

#include "src/scenario/scenario.hpp"

namespace desert_sim {

/// As many numbers as `count`, with commas between them; empty if `text` is something else.
std::vector<double> numbers_of(const std::string& text, std::size_t count);

/// Throws ConfigError, in the name of `what`, unless the point (x, y) lies on the grid [m].
void require_on_grid(double x, double y, const GridParameters& grid, const std::string& what);

}  // namespace desert_sim
