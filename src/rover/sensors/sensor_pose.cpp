#include "src/rover/sensors/sensor_pose.hpp"

#include <cmath>
#include <sstream>

#include "src/core/elementary.hpp"
#include "src/core/error.hpp"
#include "src/core/rotation.hpp"

namespace desert_sim {

SensorPose pose_from_angles(double x, double y, double z, double roll_deg, double pitch_deg, double yaw_deg) {
  using elementary::direction_deg;
  return {
      {x, y, z},
      turn_of_halves(direction_deg(roll_deg / 2), direction_deg(pitch_deg / 2), direction_deg(yaw_deg / 2))};
}

SensorPose compose(const SensorPose& outer, const SensorPose& inner) {
  return {outer.position + turned(rotation_of(outer), inner.position),
          turned(outer.orientation, inner.orientation)};
}

Eigen::Matrix3d rotation_of(const SensorPose& pose) {
  const Eigen::Vector3d& p = pose.position;
  const Eigen::Quaterniond& q = pose.orientation;
  const double square = q.x() * q.x() + q.y() * q.y() + q.z() * q.z() + q.w() * q.w();
  if (!p.allFinite() || !std::isfinite(square) || !(square > 0)) {
    std::ostringstream fault;
    fault << "pose of a sensor: position (" << p.x() << ", " << p.y() << ", " << p.z() << "), orientation ("
          << q.x() << ", " << q.y() << ", " << q.z() << ", " << q.w()
          << "): numbers must be finite, and the quaternion not 0";
    throw ConfigError(fault.str());
  }
  // Of a quaternion of any length; its square root would cost bits.
  const double s = 2 / square;
  const double xx = s * q.x() * q.x(), yy = s * q.y() * q.y(), zz = s * q.z() * q.z();
  const double xy = s * q.x() * q.y(), xz = s * q.x() * q.z(), yz = s * q.y() * q.z();
  const double wx = s * q.w() * q.x(), wy = s * q.w() * q.y(), wz = s * q.w() * q.z();
  Eigen::Matrix3d matrix;
  matrix << 1 - yy - zz, xy - wz, xz + wy,  //
      xy + wz, 1 - xx - zz, yz - wx,        //
      xz - wy, yz + wx, 1 - xx - yy;
  return matrix;
}

}  // namespace desert_sim
