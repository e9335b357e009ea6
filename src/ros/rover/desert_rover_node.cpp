/// desert_rover_node: a rover as a ROS node. Without ROS:
///
///   desert_rover_node --describe            prints the page of its parameters
///   desert_rover_node --urdf [FILE.yaml]    prints the model of a rover with these parameters
///
/// Exit status: 0 after a shutdown; 2 for input it refuses; 3 for a failure at run time.
#include <ros/console.h>
#include <ros/init.h>

#include <csignal>
#include <iostream>
#include <string>

#include "src/core/error.hpp"
#include "src/ros/rover/rover_server.hpp"
#include "src/rover/urdf.hpp"

namespace {

constexpr int exit_invalid_input = 2, exit_failure = 3;

/// Handles SIGTERM and SIGINT; only calls what a signal handler may.
void shut_down(int) { ros::requestShutdown(); }

int print_model(const char* file) {
  try {
    desert_sim::RoverSetup setup;
    if (file) setup = desert_sim::read_rover_file(file);
    std::cout << desert_sim::urdf_of(setup.rover,
                                     setup.node.tf_prefix.empty() ? "" : setup.node.tf_prefix + "/");
    return 0;
  } catch (const desert_sim::ConfigError& e) {
    std::cerr << e.what() << "\n";
    return exit_invalid_input;
  }
}

int run() {
  const desert_sim::RoverServer server(ros::NodeHandle(), ros::NodeHandle("~"));
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
    std::cout << desert_sim::describe_rover_parameters();
    return 0;
  }
  if (first == "--urdf" && argc <= 3) return print_model(argc == 3 ? argv[2] : nullptr);
  ros::init(argc, argv, "desert_rover");
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
