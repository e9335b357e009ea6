#pragma once
/// Rotations with the same bits on every machine. Eigen's own products of matrices, vectors and quaternions
/// add in an order that its version and the processor's vector instructions decide, and a rover's state and
/// its sensors' pictures are to be reproducible. What goes number by number, as here, has one order.

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "src/core/elementary.hpp"

namespace desert_sim {

/// The product of a matrix and a vector.
inline Eigen::Vector3d turned(const Eigen::Matrix3d& by, const Eigen::Vector3d& v) {
  return by.col(0) * v.x() + by.col(1) * v.y() + by.col(2) * v.z();
}

/// Hamilton's product: the rotation `a` after the rotation `b`.
inline Eigen::Quaterniond turned(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return {a.w() * b.w() - a.x() * b.x() - a.y() * b.y() - a.z() * b.z(),
          a.w() * b.x() + a.x() * b.w() + a.y() * b.z() - a.z() * b.y(),
          a.w() * b.y() - a.x() * b.z() + a.y() * b.w() + a.z() * b.x(),
          a.w() * b.z() + a.x() * b.y() - a.y() * b.x() + a.z() * b.w()};
}

/// The turn by `roll` about x, then `pitch` about y, then `yaw` about z; each is {cos, sin} of half an angle.
inline Eigen::Quaterniond turn_of_halves(const elementary::UnitVector& roll,
                                         const elementary::UnitVector& pitch,
                                         const elementary::UnitVector& yaw) {
  return {roll.x * pitch.x * yaw.x + roll.y * pitch.y * yaw.y,
          roll.y * pitch.x * yaw.x - roll.x * pitch.y * yaw.y,
          roll.x * pitch.y * yaw.x + roll.y * pitch.x * yaw.y,
          roll.x * pitch.x * yaw.y - roll.y * pitch.y * yaw.x};
}

}  // namespace desert_sim
