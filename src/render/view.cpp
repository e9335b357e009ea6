#include "src/render/view.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace desert_sim::render {

Matrix4 multiply(const Matrix4& a, const Matrix4& b) {
  Matrix4 product{};
  for (std::size_t row = 0; row < 4; ++row)
    for (std::size_t column = 0; column < 4; ++column)
      for (std::size_t k = 0; k < 4; ++k) product[row][column] += a[row][k] * b[k][column];
  return product;
}

View::View(const Matrix4& projection, const Matrix4& camera_from_terrain, int height)
    : orthographic_(projection[3][2] == 0) {
  const Matrix4 clip = multiply(projection, camera_from_terrain);
  for (std::size_t n = 0; n < 6; ++n) {  // -w <= x, y, z <= w
    const double sign = n % 2 == 0 ? 1 : -1;
    for (std::size_t k = 0; k < 4; ++k) planes_[n][k] = clip[3][k] + sign * clip[n / 2][k];
  }
  // The camera is at the origin of its own frame: the terrain's point that is mapped there.
  const Matrix4& m = camera_from_terrain;
  const auto eye = [&](std::size_t k) {
    return -(m[0][k] * m[0][3] + m[1][k] * m[1][3] + m[2][k] * m[2][3]);
  };
  eye_ = {eye(0), eye(1), eye(2)};
  ahead_ = {-m[2][0], -m[2][1], -m[2][2]};
  pixels_ = 0.5 * height * std::abs(projection[1][1]);
}

bool View::sees(const Box& box) const {
  return std::all_of(planes_.begin(), planes_.end(), [&](const std::array<double, 4>& plane) {
    const double x = plane[0] > 0 ? box.high.x : box.low.x, y = plane[1] > 0 ? box.high.y : box.low.y,
                 z = plane[2] > 0 ? box.high.z : box.low.z;
    return plane[0] * x + plane[1] * y + plane[2] * z + plane[3] >= 0;
  });
}

double View::distance(const Box& box) const {
  if (orthographic_) {
    const Point to{0.5 * (box.low.x + box.high.x) - eye_.x, 0.5 * (box.low.y + box.high.y) - eye_.y,
                   0.5 * (box.low.z + box.high.z) - eye_.z};
    const double along = to.x * ahead_.x + to.y * ahead_.y + to.z * ahead_.z;
    return std::hypot(to.x - along * ahead_.x, to.y - along * ahead_.y, to.z - along * ahead_.z);
  }
  const auto beyond = [](double value, double low, double high) {
    return std::max({low - value, value - high, 0.0});
  };
  return std::hypot(beyond(eye_.x, box.low.x, box.high.x), beyond(eye_.y, box.low.y, box.high.y),
                    beyond(eye_.z, box.low.z, box.high.z));
}

double View::pixels_per_metre(const Box& box) const {
  if (orthographic_) return pixels_;
  const double away = distance(box);
  return away > 0 ? pixels_ / away : std::numeric_limits<double>::infinity();
}

}  // namespace desert_sim::render
