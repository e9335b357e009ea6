#pragma once

namespace desert_sim {

/// What the program desert_planner_node does; returns its exit status.
int run_planner_node(int argc, char** argv);

}  // namespace desert_sim
