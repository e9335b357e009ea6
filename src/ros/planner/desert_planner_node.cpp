/// The program desert_planner_node. It lies apart from the node itself, whose headers take long to compile,
/// so that these are compiled with the rest of desert_ros.
#include "src/ros/planner/planner_node.hpp"

int main(int argc, char** argv) { return desert_sim::run_planner_node(argc, argv); }
