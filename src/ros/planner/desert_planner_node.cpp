/// desert_planner_node: plans paths for a rover and drives it along them. Without ROS:
///
///   --describe    prints the page of its parameters
///
/// Exit status: 0 after a shutdown; 2 for input it refuses; 3 for a failure at run time.
#include <iostream>
#include <memory>
#include <string>

#include "src/ros/planner/planner_server.hpp"
#include "src/ros/support/node_program.hpp"

int main(int argc, char** argv) {
  const std::string first = argc > 1 ? argv[1] : "";
  if (first == "--describe" && argc == 2) {
    std::cout << desert_sim::describe_planner_parameters();
    return 0;
  }
  if (first.rfind("--", 0) == 0) {
    std::cerr << "desert_planner_node: not --describe\n";
    return desert_sim::exit_invalid_input;
  }
  return desert_sim::run_node(argc, argv, "desert_planner", [] {
    return std::make_unique<const desert_sim::PlannerServer>(ros::NodeHandle(), ros::NodeHandle("~"));
  });
}
