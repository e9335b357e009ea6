#pragma once
/// What the programs of nodes have in common: how they start, wait for their end, and say why it came.

#include <ros/console.h>
#include <ros/init.h>

#include <algorithm>
#include <csignal>

#include "src/command_line/program.hpp"
#include "src/core/error.hpp"
#include "src/ros/support/xmlrpc_backlog.hpp"

namespace desert_sim {

constexpr int exit_invalid_input = 2, exit_failure = 3;

/// Whether the program of a node is asked for something else than to be a node: those get no options but
/// ROS's own, which have no dashes.
inline bool has_options(int argc, char** argv) {
  return std::any_of(argv + 1, argv + argc, [](const char* argument) { return argument[0] == '-'; });
}

/// A handler of signals that only calls what one may.
inline void shut_down_on_signal(int) { ros::requestShutdown(); }

/// Runs the server that `make` returns a pointer to, until ROS shuts down, its failure() is not empty, or
/// SIGINT or SIGTERM comes; `on_signal` handles these. The exit status: 0 after a shutdown;
/// exit_invalid_input for ConfigError of `make`; exit_failure for a failure at run time, after `last_words`
/// seconds in which what the server has published last is sent.
template <class Make>
int run_node(int& argc, char** argv, const char* name, const Make& make,
             void (*on_signal)(int) = shut_down_on_signal, double last_words = 0) {
  ros::init(argc, argv, name);
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);  // of systemd, docker and roslaunch's second attempt
  ros::start();                     // the log ends with ROS, and must outlive the server
  int status = 0;
  try {
    widen_xmlrpc_backlog();
    const auto server = make();
    std::string failure;
    while (ros::ok() && failure.empty()) {
      ros::WallDuration(0.05).sleep();
      failure = server->failure();
    }
    if (!failure.empty()) {
      ROS_FATAL("%s", failure.c_str());
      ros::WallDuration(last_words).sleep();
      status = exit_failure;
    }
  } catch (const ConfigError& e) {
    ROS_FATAL("%s", e.what());
    status = exit_invalid_input;
  } catch (const std::exception& e) {
    if (ros::isShuttingDown()) {  // it was told to end while it started
      ROS_INFO("%s", e.what());
    } else {
      ROS_FATAL("%s", e.what());
      status = exit_failure;
    }
  }
  ros::shutdown();
  return status;
}

}  // namespace desert_sim
