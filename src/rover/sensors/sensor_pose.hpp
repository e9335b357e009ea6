#pragma once
/// Where a sensor is.

#include <array>

namespace desert_sim {

/// Position [m] and orientation (a quaternion of any length above 0) of a frame in another one; the axes of a
/// sensor are x forward, y left, z up (REP 103).
struct SensorPose {
  double x = 0, y = 0, z = 0;
  double qx = 0, qy = 0, qz = 0, qw = 1;
};

/// From roll, pitch and yaw about the fixed axes x, y, z in this order [deg], as in URDF.
SensorPose pose_from_angles(double x, double y, double z, double roll_deg, double pitch_deg, double yaw_deg);

/// The pose in the frame of `outer` of what has the pose `inner` in the frame that `outer` describes.
SensorPose compose(const SensorPose& outer, const SensorPose& inner);

using RotationMatrix = std::array<std::array<double, 3>, 3>;
/// The matrix that turns vectors of the pose's own frame into the frame in which it is given. Throws
/// ConfigError if a number of the pose is not finite, or the quaternion is 0.
RotationMatrix rotation_of(const SensorPose& pose);

}  // namespace desert_sim
