#pragma once
/// The private parameters of a planner's node, and the page that describes them.

#include <ros/node_handle.h>

#include <string>

#include "src/core/parameter_table.hpp"
#include "src/planner/planner_parameters.hpp"
#include "src/ros/rover/rover_node_parameters.hpp"

namespace desert_sim {

struct PlannerNodeParameters {
  std::string terrain_node = "desert_sim";
  std::string rover_node = "desert_rover";
  std::string goal_topic = "";
  RoverClock clock = RoverClock::ros;
  double seconds_per_sim_second = 1;
  double rate = 10;
  std::string tf_prefix;
  std::string base_frame = "base_footprint";
  double pose_age = 1;
  bool drive = true;
  double forecast_period = 30;
  double forecast_horizon = 300;
  int forecast_moments = 10;
  int forecast_stride = 3;
  double forecast_probability = 0.5;
  double status_rate = 1;
  double answer_timeout = 5;
};

constexpr auto parameter_table(const PlannerNodeParameters*) {
  using P = PlannerNodeParameters;
  return std::make_tuple(
      parameter("terrain_node", &P::terrain_node,
                "Name of the simulation's node; one without a leading slash is in the namespace around "
                "that of this node."),
      parameter("rover_node", &P::rover_node, "Name of the rover's node, whose ~status it listens to."),
      parameter("goal_topic", &P::goal_topic,
                "Topic of goals; one without a leading slash is in the namespace around that of this node; "
                "empty: move_base_simple/goal in its own."),
      parameter(
          "clock", &P::clock, rover_clocks,
          "ros: it acts at its rate, on the pose of tf, by cmd_vel; lockstep: once for each state of the "
          "terrain that the rover has driven on, by the rover's ~drive."),
      parameter("seconds_per_sim_second", &P::seconds_per_sim_second, 1e-6, 1e6, "1",
                "With clock lockstep: time of planner and rover for a second of the terrain's."),
      parameter("rate", &P::rate, 0.1, 1000, "Hz", "With clock ros: commands a second."),
      parameter("tf_prefix", &P::tf_prefix, "Of the rover: before the name of its frame, with a slash."),
      parameter("base_frame", &P::base_frame,
                "The rover's frame, whose transform to the terrain's is its pose."),
      parameter("pose_age", &P::pose_age, 0.01, 1e6, "s",
                "With clock ros: age from which on a pose is too old to drive."),
      parameter("drive", &P::drive, "Whether it drives the rover; false: it plans only."),
      parameter("forecast_period", &P::forecast_period, 0, 1e9, "s",
                "With planner forecast: how often it asks the terrain's ~forecast for one while it has a "
                "goal, and the "
                "last one is there; 0: never, it takes what ~forecast/maps brings."),
      parameter("forecast_horizon", &P::forecast_horizon, 0.1, 1e9, "s", "How far ahead it asks."),
      parameter("forecast_moments", &P::forecast_moments, 1, 100, "1", "For how many moments."),
      parameter("forecast_stride", &P::forecast_stride, 1, 1000, "1",
                "Steps of the live run that one step of the forecast stands for: as much faster, and coarser "
                "in time."),
      parameter("forecast_probability", &P::forecast_probability, 0, 1, "1",
                "Of an ensemble: a cell counts as lethal if a smaller share of its members can pass."),
      parameter("status_rate", &P::status_rate, 0.01, 1000, "Hz",
                "~status, of wall time; it is also sent on change."),
      parameter("answer_timeout", &P::answer_timeout, 0.01, 1e6, "s",
                "Of wall time: how long it waits in lockstep for the maps of a step."));
}
static_assert(table_is_complete<PlannerNodeParameters>());

struct PlannerSetup {
  PlannerNodeParameters node;
  PlannerParameters planner;

  std::string base_frame() const {
    return node.tf_prefix.empty() ? node.base_frame : node.tf_prefix + "/" + node.base_frame;
  }
};

/// Reads all private parameters. Throws ConfigError that lists all errors; an unknown parameter is one.
PlannerSetup read_planner_setup(const ros::NodeHandle& private_node);

/// The page in markdown: what `desert_planner_node --describe` prints, and config/planner_parameters.md
/// holds.
std::string describe_planner_parameters();

}  // namespace desert_sim
