#pragma once
/// The rover's model for robot_state_publisher and rviz, from its parameters.

#include <string>
#include <vector>

#include "src/rover/rover.hpp"
#include "src/rover/sensors/sensor_parameters.hpp"

namespace desert_sim {

/// The URDF: base_link, rockers, bogies and wheels, and the sensors whose rate is not 0; the names of links
/// with `prefix` before them.
std::string urdf_of(const RoverParameters& rover, const LidarParameters& lidar,
                    const DepthCameraParameters& depth_camera, const std::string& prefix);

/// front_left, …: its wheel's joint is <name>_wheel_joint.
std::string wheel_name(int wheel, int wheels);

struct JointValue {
  std::string name;
  double position = 0, velocity = 0;  ///< [rad, rad/s]
};
/// The joints of that model that move, in a fixed order.
std::vector<JointValue> joint_values(const RoverParameters& rover, const RoverState& state);

}  // namespace desert_sim
