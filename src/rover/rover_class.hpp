#pragma once
/// Classes of rovers: files such as those of config/rovers, which say in `traversability` what a planner
/// has to know of a rover, and in `rover_dimensions` how it is built.
///
///   rover_dimensions:
///     axles            x of each axle from the front to the rear [m]: two (rocker) or three (rocker_bogie)
///     track            [m]
///     rocker_pivot     x, z above the hubs [m]
///     bogie_pivot      likewise, with three axles; the bogie carries middle and rear wheels (`bogie: rear`)
///     clearance, body  [m]; length, width, height [m]
///     steered_axles    none: skid; else ackermann
///     max_speed        [m/s]

#include <yaml-cpp/yaml.h>

#include <string>

#include "src/rover/rover_parameters.hpp"

namespace desert_sim {

/// The parameters of a rover of this class; what the file does not say keeps the default, in proportion to
/// the wheels where that matters. Throws ConfigError that names `source` and what is wrong.
RoverParameters rover_of_class(const YAML::Node& file, const std::string& source);

}  // namespace desert_sim
