#pragma once

namespace desert_sim {

/// What the program desert_rover_node does; returns its exit status.
int run_rover_node(int argc, char** argv);

}  // namespace desert_sim
