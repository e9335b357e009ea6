/// desert_sim_node: the simulation as a ROS node. With --describe it prints the page of its parameters and
/// ends. Exit status: 0 after a shutdown; 2 for input it refuses; 3 for a failure at run time. After SIGTERM
/// or Ctrl-C it ends within five seconds: a step that takes longer is given up (status 4), and its journal
/// then ends with the last command.
#include <ros/console.h>
#include <ros/init.h>
#include <unistd.h>

#include <csignal>
#include <iostream>
#include <string>

#include "src/core/error.hpp"
#include "src/ros/node/desert_sim_server.hpp"
#include "src/ros/node/node_parameters.hpp"

namespace {

constexpr int exit_invalid_input = 2, exit_failure = 3, exit_given_up = 4;
constexpr unsigned shutdown_time = 5;  // [s]

void give_up(int) {
  constexpr char text[] = "desert_sim_node: a step took longer than the shutdown may, and was given up.\n";
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, text, sizeof text - 1);
  _exit(exit_given_up);
}

/// Handles SIGTERM and SIGINT; only calls what a signal handler may.
void shut_down(int) {
  alarm(shutdown_time - 1);
  ros::requestShutdown();
}

int run() {
  const desert_sim::DesertSimServer server(ros::NodeHandle("~"));
  std::string failure;
  while (ros::ok() && failure.empty()) {
    ros::WallDuration(0.05).sleep();
    failure = server.failure();
  }
  if (failure.empty()) return 0;
  ROS_FATAL("%s", failure.c_str());
  ros::WallDuration(0.5).sleep();  // the last status is on its way
  return exit_failure;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && argv[1] == std::string("--describe")) {
    std::cout << desert_sim::describe_node_parameters();
    return 0;
  }
  ros::init(argc, argv, "desert_sim");
  std::signal(SIGALRM, give_up);
  std::signal(SIGINT, shut_down);
  std::signal(SIGTERM, shut_down);  // of systemd, docker and roslaunch's second attempt
  ros::start();                     // the log ends with ROS, and must outlive the server
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
