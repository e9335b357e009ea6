#include "src/rover/sensors/sensor_pose.hpp"

#include <cmath>
#include <sstream>

#include "src/core/constants.hpp"
#include "src/core/error.hpp"

namespace desert_sim {

SensorPose pose_from_angles(double x, double y, double z, double roll_deg, double pitch_deg, double yaw_deg) {
  const double half = pi / 360;
  const double sr = std::sin(roll_deg * half), cr = std::cos(roll_deg * half);
  const double sp = std::sin(pitch_deg * half), cp = std::cos(pitch_deg * half);
  const double sy = std::sin(yaw_deg * half), cy = std::cos(yaw_deg * half);
  return {x,
          y,
          z,
          sr * cp * cy - cr * sp * sy,
          cr * sp * cy + sr * cp * sy,
          cr * cp * sy - sr * sp * cy,
          cr * cp * cy + sr * sp * sy};
}

SensorPose compose(const SensorPose& outer, const SensorPose& inner) {
  const RotationMatrix turn = rotation_of(outer);
  const auto along = [&](int n) {
    const auto& row = turn[static_cast<std::size_t>(n)];
    return row[0] * inner.x + row[1] * inner.y + row[2] * inner.z;
  };
  const SensorPose &a = outer, &b = inner;
  return {a.x + along(0),
          a.y + along(1),
          a.z + along(2),
          a.qw * b.qx + a.qx * b.qw + a.qy * b.qz - a.qz * b.qy,
          a.qw * b.qy - a.qx * b.qz + a.qy * b.qw + a.qz * b.qx,
          a.qw * b.qz + a.qx * b.qy - a.qy * b.qx + a.qz * b.qw,
          a.qw * b.qw - a.qx * b.qx - a.qy * b.qy - a.qz * b.qz};
}

RotationMatrix rotation_of(const SensorPose& p) {
  const double square = p.qx * p.qx + p.qy * p.qy + p.qz * p.qz + p.qw * p.qw;
  if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z) || !std::isfinite(square) ||
      !(square > 0)) {
    std::ostringstream fault;
    fault << "pose of a sensor: position (" << p.x << ", " << p.y << ", " << p.z << "), orientation (" << p.qx
          << ", " << p.qy << ", " << p.qz << ", " << p.qw
          << "): numbers must be finite, and the quaternion not 0";
    throw ConfigError(fault.str());
  }
  const double s = 2 / square;
  const double xx = s * p.qx * p.qx, yy = s * p.qy * p.qy, zz = s * p.qz * p.qz;
  const double xy = s * p.qx * p.qy, xz = s * p.qx * p.qz, yz = s * p.qy * p.qz;
  const double wx = s * p.qw * p.qx, wy = s * p.qw * p.qy, wz = s * p.qw * p.qz;
  return {
      {{1 - yy - zz, xy - wz, xz + wy}, {xy + wz, 1 - xx - zz, yz - wx}, {xz - wy, yz + wx, 1 - xx - yy}}};
}

}  // namespace desert_sim
