/// desert_sim_node: the simulation as a ROS node. After SIGTERM or Ctrl-C it ends within five seconds: a step
/// that takes longer is given up (status 4), and its journal then ends with the last command.
#include "src/ros/node/sim_node.hpp"

#include <unistd.h>

#include <csignal>
#include <iostream>
#include <memory>
#include <string>

#include "src/ros/node/desert_sim_server.hpp"
#include "src/ros/parameters/node_parameters.hpp"
#include "src/ros/support/node_program.hpp"

namespace desert_sim {

namespace {

constexpr int exit_given_up = 4;
constexpr unsigned shutdown_time = 5;  // [s]
constexpr double last_words = 0.5;     // [s], for the last status

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

Options sim_node_options() {
  Options o("desert_sim_node", "The simulation as a ROS node, which it is without options.");
  o.flag("describe", "print the page of its parameters")
      .footer(
          "Exit status: 0 after a shutdown; 2 for input it refuses; 3 for a failure at run\n"
          "time; 4 after a step that took longer than the shutdown may.");
  return o;
}

}  // namespace

int run_sim_node(int argc, char** argv) {
  if (has_options(argc, argv))
    return run_main(sim_node_options(), argc, argv, [](const Options&) {
      std::cout << describe_node_parameters();
      return 0;
    });
  std::signal(SIGALRM, give_up);
  return run_node(
      argc, argv, "desert_sim", [] { return std::make_unique<const DesertSimServer>(ros::NodeHandle("~")); },
      shut_down, last_words);
}

}  // namespace desert_sim
