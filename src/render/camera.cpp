#include "src/render/camera.hpp"

#include <algorithm>
#include <cmath>

namespace desert_sim::render {

namespace {

constexpr double radians = 3.14159265358979323846 / 180;

constexpr double filled = 0.95;  // of the picture, by the subject

Box::CornerType corner_of(int number) { return static_cast<Box::CornerType>(number); }

}  // namespace

Projection::Projection(const Camera& camera, const Box& box, int width, int height)
    : width_(width), height_(height) {
  const double azimuth = camera.azimuth_deg * radians, elevation = camera.elevation_deg * radians;
  const Eigen::Vector3d back(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                             std::sin(elevation));  // from the subject to the camera
  const Eigen::Vector3d right(-std::sin(azimuth), std::cos(azimuth), 0);
  Eigen::Matrix3d axes;
  axes << right.transpose(), back.cross(right).transpose(), back.transpose();
  camera_from_terrain_.topLeftCorner<3, 3>() = axes;
  camera_from_terrain_.topRightCorner<3, 1>() = -(axes * box.center());

  const double shorter = std::min(width, height);
  const double focus = 1 / std::tan(0.5 * camera.field_of_view_deg * radians);
  const double reach_x = width / shorter / focus, reach_y = height / shorter / focus;
  projection_(0, 0) = 1 / reach_x;
  projection_(1, 1) = 1 / reach_y;
  projection_(3, 2) = -1;
  // A corner (x, y, z) of the camera's axes is in the picture from the distance |x| / reach + z on.
  double distance = 0, deepest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d from_target = axes * (box.corner(corner_of(corner)) - box.center());
    distance = std::max({distance, std::abs(from_target.x()) / reach_x + from_target.z(),
                         std::abs(from_target.y()) / reach_y + from_target.z()});
    deepest = std::max(deepest, -from_target.z());
  }
  distance = std::max(distance, 1e-3);
  const double far = distance + 2 * deepest, near = 1e-3 * distance;
  projection_(2, 2) = -(far + near) / (far - near);
  projection_(2, 3) = -2 * far * near / (far - near);
  camera_from_terrain_(2, 3) -= distance;
  fill_picture(box, camera.zoom);
}

/// What is near is larger: the subject is not in the middle of the picture, and leaves a part of it empty.
/// Shifts and scales the picture, as a shift lens does.
void Projection::fill_picture(const Box& box, double zoom) {
  clip_ = projection_ * camera_from_terrain_;
  Eigen::AlignedBox2d seen;
  for (int corner = 0; corner < 8; ++corner) {
    const PicturePoint p = project(box.corner(corner_of(corner)));
    seen.extend(Eigen::Vector2d(2 * p.column / width_ - 1, 1 - 2 * p.row / height_));
  }
  const double factor = zoom * 2 * filled / std::max(seen.sizes().maxCoeff(), 1e-9);
  for (int axis = 0; axis < 2; ++axis) {
    projection_(axis, axis) *= factor;
    projection_(axis, 2) = seen.center()[axis] * factor;  // a point at z = -w
  }
  clip_ = projection_ * camera_from_terrain_;
}

PicturePoint Projection::project(const Point& p) const {
  const Eigen::Vector4d place = clip_ * p.homogeneous();
  const double w = place.w();
  if (!(w > 0)) return {0, 0, 0, false};
  return {0.5 * width_ * (1 + place.x() / w), 0.5 * height_ * (1 - place.y() / w), -1 / w, true};
}

View Projection::view(double exaggeration) const {
  Eigen::Matrix4d from_true_heights = camera_from_terrain_;
  from_true_heights.col(2) *= exaggeration;
  return {projection_, from_true_heights, height_};
}

}  // namespace desert_sim::render
