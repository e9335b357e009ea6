#include "src/render/camera.hpp"

#include <algorithm>
#include <cmath>

namespace desert_sim::render {

namespace {

constexpr double radians = 3.14159265358979323846 / 180;

Point cross(const Point& a, const Point& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
double dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

}  // namespace

Projection::Projection(const Camera& camera, const Box& box, int width, int height)
    : width_(width), height_(height) {
  target_ = {0.5 * (box.low.x + box.high.x), 0.5 * (box.low.y + box.high.y), 0.5 * (box.low.z + box.high.z)};
  const double azimuth = camera.azimuth_deg * radians, elevation = camera.elevation_deg * radians;
  back_ = {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
           std::sin(elevation)};
  const Point right{-std::sin(azimuth), std::cos(azimuth), 0};
  const Point up = cross(back_, right);
  const Point axes[3] = {right, up, back_};
  for (std::size_t row = 0; row < 3; ++row)
    camera_from_terrain_[row] = {axes[row].x, axes[row].y, axes[row].z, -dot(axes[row], target_)};
  camera_from_terrain_[3] = {0, 0, 0, 1};

  const double shorter = std::min(width, height);
  const double focus = 1 / std::tan(0.5 * camera.field_of_view_deg * radians);
  const double reach_x = width / shorter / focus, reach_y = height / shorter / focus;
  projection_[0][0] = 1 / reach_x;
  projection_[1][1] = 1 / reach_y;
  projection_[3][2] = -1;
  // A corner (x, y, z) of the camera's axes is in the picture from the distance |x| / reach + z on.
  double distance = 0, deepest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Point from_target{(corner & 1 ? box.high.x : box.low.x) - target_.x,
                            (corner & 2 ? box.high.y : box.low.y) - target_.y,
                            (corner & 4 ? box.high.z : box.low.z) - target_.z};
    const double towards = dot(from_target, back_);
    distance = std::max({distance, std::abs(dot(from_target, right)) / reach_x + towards,
                         std::abs(dot(from_target, up)) / reach_y + towards});
    deepest = std::max(deepest, -towards);
  }
  distance = std::max(distance, 1e-3);
  const double far = distance + 2 * deepest, near = 1e-3 * distance;
  projection_[2][2] = -(far + near) / (far - near);
  projection_[2][3] = -2 * far * near / (far - near);
  camera_from_terrain_[2][3] -= distance;
  fill_picture(box, camera.zoom);
}

/// What is near is larger: the subject is not in the middle of the picture, and leaves a part of it empty.
/// Shifts and scales the picture, as a shift lens does.
void Projection::fill_picture(const Box& box, double zoom) {
  constexpr double filled = 0.95;
  clip_ = multiply(projection_, camera_from_terrain_);
  double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
  for (int corner = 0; corner < 8; ++corner) {
    const PicturePoint p = project({corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                                    corner & 4 ? box.high.z : box.low.z});
    const double place[2] = {2 * p.column / width_ - 1, 1 - 2 * p.row / height_};
    for (int axis = 0; axis < 2; ++axis) {
      low[axis] = std::min(low[axis], place[axis]);
      high[axis] = std::max(high[axis], place[axis]);
    }
  }
  const double factor = zoom * 2 * filled / std::max({high[0] - low[0], high[1] - low[1], 1e-9});
  for (std::size_t axis = 0; axis < 2; ++axis) {
    projection_[axis][axis] *= factor;
    projection_[axis][2] = 0.5 * (low[axis] + high[axis]) * factor;  // a point at z = -w
  }
  clip_ = multiply(projection_, camera_from_terrain_);
}

PicturePoint Projection::project(const Point& p) const {
  const auto row = [&](std::size_t k) {
    return clip_[k][0] * p.x + clip_[k][1] * p.y + clip_[k][2] * p.z + clip_[k][3];
  };
  const double w = row(3);
  if (!(w > 0)) return {0, 0, 0, false};
  return {0.5 * width_ * (1 + row(0) / w), 0.5 * height_ * (1 - row(1) / w), -1 / w, true};
}

View Projection::view(double exaggeration) const {
  Matrix4 from_true_heights = camera_from_terrain_;
  for (std::array<double, 4>& row : from_true_heights) row[2] *= exaggeration;
  return {projection_, from_true_heights, height_};
}

}  // namespace desert_sim::render
