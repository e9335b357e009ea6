#pragma once

namespace desert_sim {

/// What the program desert_sim_node does; returns its exit status.
int run_sim_node(int argc, char** argv);

}  // namespace desert_sim
