/// The program desert_sim_node. It lies apart from the node itself, whose headers take long to compile,
/// so that these are compiled with the rest of desert_ros.
#include "src/ros/node/sim_node.hpp"

int main(int argc, char** argv) { return desert_sim::run_sim_node(argc, argv); }
