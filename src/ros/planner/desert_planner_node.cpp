/// desert_planner_node: plans paths for a rover and drives it along them. Without ROS:
///
///   --describe    prints the page of its parameters
///
/// Exit status: 0 after a shutdown; 2 for input it refuses; 3 for a failure at run time.
#include <ros/console.h>
#include <ros/init.h>

#include <csignal>
#include <iostream>
#include <string>

#include "src/core/error.hpp"
#include "src/ros/planner/planner_server.hpp"

namespace {

constexpr int exit_invalid_input = 2, exit_failure = 3;

/// Handles SIGTERM and SIGINT; only calls what a signal handler may.
void shut_down(int) { ros::requestShutdown(); }

int run() {
  const desert_sim::PlannerServer server(ros::NodeHandle(), ros::NodeHandle("~"));
  std::string failure;
  while (ros::ok() && failure.empty()) {
    ros::WallDuration(0.05).sleep();
    failure = server.failure();
  }
  if (failure.empty()) return 0;
  ROS_FATAL("%s", failure.c_str());
  return exit_failure;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string first = argc > 1 ? argv[1] : "";
  if (first == "--describe" && argc == 2) {
    std::cout << desert_sim::describe_planner_parameters();
    return 0;
  }
  if (first.rfind("--", 0) == 0) {
    std::cerr << "desert_planner_node: not --describe\n";
    return exit_invalid_input;
  }
  ros::init(argc, argv, "desert_planner");
  std::signal(SIGINT, shut_down);
  std::signal(SIGTERM, shut_down);
  ros::start();  // the log ends with ROS, and must outlive the server
  int status = exit_failure;
  try {
    status = run();
  } catch (const desert_sim::ConfigError& e) {
    ROS_FATAL("%s", e.what());
    status = exit_invalid_input;
  } catch (const std::exception& e) {
    ROS_FATAL("%s", e.what());
  }
  ros::shutdown();
  return status;
}
