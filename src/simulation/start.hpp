#pragma once
/// How a simulation begins.

#include <memory>
#include <string>

#include "src/simulation/simulation.hpp"

namespace desert_sim {

/// The start of a scenario: built by its terrain steps, or with the state of the checkpoint that
/// `run.start_from` names (below `folder`, if one is given), under the scenario's own parameters, wind and
/// timeline. Whatever is otherwise than in the checkpoint changes as set_parameters would change it; a wind
/// regime that is another begins now. Throws ConfigError that lists what cannot change, such as the grid.
std::unique_ptr<Simulation> simulation_at_start(Exec& exec, const Scenario& scenario,
                                                const RasterLoader& load_raster,
                                                const std::string& folder = "");

}  // namespace desert_sim
