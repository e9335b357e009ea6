#pragma once
/// The page of the node's own parameters, from their tables.

#include <string>

namespace desert_sim {

/// As markdown: what `desert_sim_node --describe` prints and config/node_parameters.md holds.
std::string describe_node_parameters();

}  // namespace desert_sim
