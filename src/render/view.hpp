#pragma once
/// A camera's view of the terrain: what it sees, and how many pixels a metre takes. All places are in the
/// terrain's frame [m]. Both follow from the matrices with which the camera projects, so that perspective and
/// orthographic cameras need no cases of their own.

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace desert_sim::render {

constexpr double pi = 3.14159265358979323846;

using Point = Eigen::Vector3d;
using Box = Eigen::AlignedBox3d;

/// What begins at a point [m] and goes on in a direction, of any length above 0.
struct Ray {
  Point origin, direction;
};

class View {
 public:
  /// `projection` maps coordinates of the camera (which looks along -z) to OpenGL's clip coordinates, and
  /// `camera_from_terrain` those of the terrain to the camera's, by a rotation and a translation. `height` is
  /// that of the viewport [pixels].
  View(const Eigen::Matrix4d& projection, const Eigen::Matrix4d& camera_from_terrain, int height);

  bool orthographic() const { return orthographic_; }
  /// The line of sight through the middle of the picture, from the camera on.
  Ray middle() const { return {eye_, ahead_}; }
  /// Whether any part of the box can be in the picture. May be true for a box just outside.
  bool sees(const Box& box) const;
  /// The camera's distance from a box; 0 inside [m]. For an orthographic camera: from the line of sight
  /// through the middle of the picture.
  double distance(const Box& box) const;
  /// The pixels that a metre takes at most anywhere in the box, seen at a right angle. Infinite if the camera
  /// is inside.
  double pixels_per_metre(const Box& box) const;

 private:
  Eigen::Matrix<double, 6, 4> planes_;  ///< of the frustum, a row each; inside is positive
  Point eye_;
  Point ahead_;  ///< unit vector of the line of sight
  bool orthographic_;
  double pixels_;  ///< a metre, in orthographic views; else a metre at a distance of one
};

}  // namespace desert_sim::render
