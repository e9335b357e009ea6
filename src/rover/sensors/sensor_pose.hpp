#pragma once
/// Where a sensor is.

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace desert_sim {

/// Position [m] and orientation (a quaternion of any length above 0) of a frame in another one; the axes of a
/// sensor are x forward, y left, z up (REP 103).
struct SensorPose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

/// From roll, pitch and yaw about the fixed axes x, y, z in this order [deg], as in URDF.
SensorPose pose_from_angles(double x, double y, double z, double roll_deg, double pitch_deg, double yaw_deg);

/// The pose in the frame of `outer` of what has the pose `inner` in the frame that `outer` describes.
SensorPose compose(const SensorPose& outer, const SensorPose& inner);

/// The matrix that turns vectors of the pose's own frame into the frame in which it is given. Throws
/// ConfigError if a number of the pose is not finite, or the quaternion is 0.
Eigen::Matrix3d rotation_of(const SensorPose& pose);

}  // namespace desert_sim
