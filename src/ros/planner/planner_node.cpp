/// desert_planner_node: plans paths for a rover and drives it along them.
#include "src/ros/planner/planner_node.hpp"

#include <iostream>
#include <memory>

#include "src/ros/planner/planner_server.hpp"
#include "src/ros/support/node_program.hpp"

namespace desert_sim {

namespace {

Options planner_node_options() {
  Options o("desert_planner_node",
            "Plans paths for a rover and drives it along them, as a ROS node, which it is without options.");
  o.flag("describe", "print the page of its parameters")
      .footer("Exit status: 0 after a shutdown; 2 for input it refuses; 3 for a failure at run\ntime.");
  return o;
}

}  // namespace

int run_planner_node(int argc, char** argv) {
  if (has_options(argc, argv))
    return run_main(planner_node_options(), argc, argv, [](const Options&) {
      std::cout << describe_planner_parameters();
      return 0;
    });
  return run_node(argc, argv, "desert_planner", [] {
    return std::make_unique<const PlannerServer>(ros::NodeHandle(), ros::NodeHandle("~"));
  });
}

}  // namespace desert_sim
