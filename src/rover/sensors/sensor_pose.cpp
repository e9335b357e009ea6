#include "src/rover/sensors/sensor_pose.hpp"

#include <cmath>
#include <sstream>

#include "src/core/constants.hpp"
#include "src/core/error.hpp"
#include "src/core/rotation.hpp"

namespace desert_sim {

SensorPose pose_from_angles(double x, double y, double z, double roll_deg, double pitch_deg, double yaw_deg) {
  const double half = pi / 360;
  const double sr = std::sin(roll_deg * half), cr = std::cos(roll_deg * half);
  const double sp = std::sin(pitch_deg * half), cp = std::cos(pitch_deg * half);
  const double sy = std::sin(yaw_deg * half), cy = std::cos(yaw_deg * half);
  return {{x, y, z},
          {cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
           cr * cp * sy - sr * sp * cy}};
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
