#pragma once
/// The private parameters of a rover's node, and the page that describes them.

#include <ros/node_handle.h>

#include <optional>
#include <string>
#include <vector>

#include "src/core/parameter_table.hpp"
#include "src/rover/rover_parameters.hpp"
#include "src/rover/sensors/sensor_parameters.hpp"

namespace desert_sim {

/// ros: the rover drives as ROS time passes. lockstep: it drives when the terrain's state moves on, as far
/// as that did.
enum class RoverClock : int { ros, lockstep };
constexpr const char* rover_clocks[] = {"ros", "lockstep"};

/// Whether the rover believes in the layer looseness. automatic: if any cell of it is not 0.
enum class LoosenessSource : int { automatic, layer, assumed };
constexpr const char* looseness_sources[] = {"auto", "layer", "assumed"};

struct RoverNodeParameters {
  std::string terrain_node = "desert_sim";
  std::string rover_class;
  RoverClock clock = RoverClock::ros;
  double seconds_per_sim_second = 1;
  double rate = 50;
  double cmd_vel_timeout = 0.5;
  std::string tf_prefix;
  bool publish_tf = true;
  bool publish_map_tf = true;
  bool publish_description = true;
  std::optional<double> x, y;
  double yaw_deg = 0;
  LoosenessSource looseness = LoosenessSource::automatic;
  double moisture_capacity = 0.3;
  double moisture_depth = 1;
  double half_wet = 1.5;
  double saturated = 0.15;
  std::string data_dir;
  std::string journal;
  bool micro_relief = false;
  bool tracks = false;
  double track_spacing = 0.25;
  double track_rate = 10;
  std::string sensor_backend = "cpu";
  int sensor_threads = 1;
  double status_rate = 1;
  double diagnostic_period = 1;
  double answer_timeout = 5;
};

constexpr auto parameter_table(const RoverNodeParameters*) {
  using P = RoverNodeParameters;
  return std::make_tuple(
      parameter("terrain_node", &P::terrain_node,
                "Name of the simulation's node; one without a leading slash is in the namespace around "
                "that of this node."),
      parameter("rover_class", &P::rover_class,
                "A file of a class of rovers, or the bare name of one in the package's config/rovers, whose "
                "values the "
                "section rover overrides; empty: the defaults of that section."),
      parameter("clock", &P::clock, rover_clocks,
                "ros: it drives as ROS time passes; lockstep: as the terrain's simulated time does, by whole "
                "states."),
      parameter("seconds_per_sim_second", &P::seconds_per_sim_second, 1e-6, 1e6, "1",
                "With clock lockstep: time of the rover for a second of the terrain's."),
      parameter("rate", &P::rate, 1, 1000, "Hz", "With clock ros: poses a second."),
      parameter("cmd_vel_timeout", &P::cmd_vel_timeout, 0.02, 1e9, "s",
                "Of the rover's time: it stops so long after the last message on cmd_vel."),
      parameter("tf_prefix", &P::tf_prefix,
                "Before the names of all frames but the terrain's, with a slash: r1 gives "
                "r1/odom, r1/base_link."),
      parameter("publish_tf", &P::publish_tf, "Whether odom -> base_footprint -> base_link goes to tf."),
      parameter("publish_map_tf", &P::publish_map_tf,
                "Whether the true transform from the terrain's frame to odom goes to tf; false for who "
                "estimates it."),
      parameter("publish_description", &P::publish_description,
                "Whether it sets robot_description, in its namespace."),
      parameter("x", &P::x, -1e9, 1e9, "m",
                "Start in the terrain's frame; left out: the middle of the terrain, or without y, too, the "
                "free ground nearest to it, from which the rover can drive ahead and back."),
      parameter("y", &P::y, -1e9, 1e9, "m", "Start in the terrain's frame; left out: as for x."),
      parameter("yaw_deg", &P::yaw_deg, -360, 360, "deg", "Heading at the start, counter-clockwise from +x."),
      parameter("looseness", &P::looseness, looseness_sources,
                "layer: that of the terrain, where there is one; assumed: rover/assumed_looseness; auto: the "
                "terrain's "
                "if any cell of it was not 0."),
      parameter("moisture_capacity", &P::moisture_capacity, 0.001, 1, "1",
                "The scenario's repose.moisture_capacity: moisture that a metre of ground can hold."),
      parameter("moisture_depth", &P::moisture_depth, 0.01, 100, "m",
                "The scenario's repose.moisture_depth, down to which ground holds moisture."),
      parameter("half_wet", &P::half_wet, 0.1, 10, "1",
                "The scenario's repose.half_wet: strength of half-wet ground over that of dry."),
      parameter("saturated", &P::saturated, 0.001, 10, "1",
                "The scenario's repose.saturated: strength of saturated ground over that of dry."),
      parameter("data_dir", &P::data_dir,
                "States of the rover lie below this folder; empty: desert_sim in ROS's own "
                "folder ($ROS_HOME, or ~/.ros)."),
      parameter(
          "journal", &P::journal,
          "File for the journal of all that the rover was told and drove on, whose folder is made where it "
          "is missing; one of that name gets the ending .previous. Empty: none."),
      parameter("micro_relief", &P::micro_relief,
                "Whether wheels and beams meet ripples and bumps (section micro_relief of the terrain's "
                "scenario)."),
      parameter("tracks", &P::tracks, "Whether its wheels press and displace the terrain's sand."),
      parameter("track_spacing", &P::track_spacing, 0.01, 100, "m", "Way of a wheel that is one stroke."),
      parameter("track_rate", &P::track_rate, 0.1, 1000, "Hz",
                "With clock ros: at most so many strokes a second."),
      parameter("sensor_backend", &P::sensor_backend,
                "Where beams of the sensors are cast: cpu, cuda, or auto, a GPU if there is one."),
      parameter("sensor_threads", &P::sensor_threads, 0, 1024, "1", "Of that CPU; 0: one a processor."),
      parameter("status_rate", &P::status_rate, 0.01, 1000, "Hz",
                "~status, of wall time; it is also sent on change."),
      parameter("diagnostic_period", &P::diagnostic_period, 0.01, 1e6, "s", "Of /diagnostics, in wall time."),
      parameter("answer_timeout", &P::answer_timeout, 0.01, 1e6, "s",
                "Of wall time: how long services wait in lockstep until the rover has reached the terrain's "
                "step."));
}
static_assert(table_is_complete<RoverNodeParameters>());

struct RoverSetup {
  RoverNodeParameters node;
  RoverParameters rover;
  WheelGroundParameters wheel_ground;
  LidarParameters lidar;
  DepthCameraParameters depth_camera;
  SensorMediaParameters sensor_media;

  bool has_sensors() const { return lidar.rate > 0 || depth_camera.rate > 0; }
  std::string frame(const std::string& name) const {
    return node.tf_prefix.empty() ? name : node.tf_prefix + "/" + name;
  }
};

/// Reads all private parameters: those of the table, and the sections `rover`, `wheel_ground`, `lidar`,
/// `depth_camera` and `sensor_media`. Throws ConfigError that lists all errors; an unknown parameter is one.
RoverSetup read_rover_setup(const ros::NodeHandle& private_node);
/// The same from words of a command line: a YAML file, and key:=value or section/key:=value, which override
/// its keys; what has no value is left out.
RoverSetup read_rover_words(const std::vector<std::string>& words);

/// The page in markdown: what `desert_rover_node --describe` prints, and what config/rover_parameters.md
/// holds.
std::string describe_rover_parameters();

}  // namespace desert_sim
