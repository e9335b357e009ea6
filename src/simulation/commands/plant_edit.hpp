#pragma once
/// Planting and clearing: what an EditPlants command makes of a population.

#include <cstdint>
#include <vector>

#include "src/scenario/scenario.hpp"
#include "src/simulation/commands/command.hpp"
#include "src/terrain/terrain.hpp"

namespace desert_sim {

/// Throws ConfigError that names every parameter which is out of range, a species that this scenario does not
/// have, points that do not make a shape, or that plants are off.
void check_plant_edit(const command::EditPlants& edit, const Scenario& scenario);

/// The columns (see plants::words()) after a checked edit of those before it. Throws ConfigError if there
/// would be more than `most` plants.
std::vector<std::uint32_t> edited_plants(const command::EditPlants& edit, const Scenario& scenario,
                                         const Terrain& terrain, std::uint64_t step, int most,
                                         const std::vector<std::uint32_t>& words);

}  // namespace desert_sim
