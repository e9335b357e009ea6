#pragma once
/// Planting and clearing: what an EditPlants command makes of a population.

#include <cstdint>
#include <vector>

#include "src/scenario/scenario.hpp"
#include "src/simulation/commands/command.hpp"
#include "src/simulation/undo/population.hpp"
#include "src/terrain/terrain.hpp"

namespace desert_sim {

/// Throws ConfigError that names every parameter which is out of range, a species that this scenario does not
/// have, points that do not make a shape, or that plants are off.
void check_plant_edit(const command::EditPlants& edit, const Scenario& scenario);

/// How many places planting may draw in the rectangle around its region, so that no request holds up the
/// simulation for long; fewer for polygons, whose every edge is looked at for each place.
constexpr double max_drawn_places = 1e7, max_drawn_edges = 1e9;

/// What a checked edit changes in the plants `words` (columns, see plants::words()). Throws ConfigError if
/// there would be more than `most` plants, or if it would draw too many places.
Population::Edit plant_edit(const command::EditPlants& edit, const Scenario& scenario, const Terrain& terrain,
                            std::uint64_t step, int most, const std::vector<std::uint32_t>& words);

}  // namespace desert_sim
