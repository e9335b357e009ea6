#include "src/render/view.hpp"

#include <cmath>
#include <limits>

namespace desert_sim::render {

View::View(const Eigen::Matrix4d& projection, const Eigen::Matrix4d& camera_from_terrain, int height)
    : orthographic_(projection(3, 2) == 0) {
  const Eigen::Matrix4d clip = projection * camera_from_terrain;
  for (int n = 0; n < 6; ++n)  // -w <= x, y, z <= w
    planes_.row(n) = clip.row(3) + (n % 2 == 0 ? 1 : -1) * clip.row(n / 2);
  // The camera is at the origin of its own frame: the terrain's point that is mapped there.
  const Eigen::Matrix3d turn = camera_from_terrain.topLeftCorner<3, 3>();
  eye_ = -(turn.transpose() * camera_from_terrain.topRightCorner<3, 1>());
  ahead_ = -turn.row(2).transpose();
  pixels_ = 0.5 * height * std::abs(projection(1, 1));
}

bool View::sees(const Box& box) const {
  for (int n = 0; n < planes_.rows(); ++n) {
    const Eigen::Vector3d normal = planes_.row(n).head<3>();
    const Point farthest = (normal.array() > 0).select(box.max(), box.min());
    if (!(normal.dot(farthest) + planes_(n, 3) >= 0)) return false;
  }
  return true;
}

double View::distance(const Box& box) const {
  if (!orthographic_) return box.exteriorDistance(eye_);
  const Eigen::Vector3d to = box.center() - eye_;
  return (to - to.dot(ahead_) * ahead_).norm();
}

double View::pixels_per_metre(const Box& box) const {
  if (orthographic_) return pixels_;
  const double away = distance(box);
  return away > 0 ? pixels_ / away : std::numeric_limits<double>::infinity();
}

}  // namespace desert_sim::render
