#pragma once
/// Ground for rovers: heights by a function of x and y, which may move with time.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "src/core/constants.hpp"
#include "src/rover/grid_ground.hpp"
#include "src/rover/rover.hpp"

namespace desert_sim::test {

constexpr double degree = pi / 180;
using Height = std::function<double(double x, double y)>;

/// 40 m × 40 m about the origin in cells of 0.1 m, of sand that is deep, and as loose as is said.
inline GridGround::Layers layers_of(const Height& height, double sand = 0, double looseness = 0,
                                    double cell = 0.1, int count = 400) {
  GridGround::Layers layers;
  const double corner = -cell * count / 2;
  for (int j = 0; j < count; ++j)
    for (int i = 0; i < count; ++i)
      layers.elevation.push_back(
          static_cast<float>(height(corner + (i + 0.5) * cell, corner + (j + 0.5) * cell)));
  layers.sand_depth.assign(layers.elevation.size(), static_cast<float>(sand));
  layers.looseness.assign(layers.elevation.size(), static_cast<float>(looseness));
  return layers;
}
inline GridGround::Geometry geometry(double cell = 0.1, int count = 400) {
  return {count, count, cell, -cell * count / 2, -cell * count / 2, false, false};
}
inline GridGround ground_of(const Height& height, double sand = 0, double looseness = 0) {
  return GridGround(geometry(), layers_of(height, sand, looseness));
}

/// Exact heights instead of cells, for what cells would round; sand as deep and loose as is said.
class SmoothGround : public GroundSource {
 public:
  explicit SmoothGround(Height height, double sand = 0, double looseness = 0)
      : height_(std::move(height)), sand_(sand), looseness_(looseness) {}
  bool contains(double, double) const override { return true; }
  std::optional<double> elevation(double x, double y) const override { return height_(x, y); }
  GroundPoint at(double, double) const override {
    GroundPoint p;
    p.sand_depth = sand_;
    p.looseness = looseness_;
    p.moisture = moisture_;
    return p;
  }
  Height height_;
  double sand_, looseness_, moisture_ = 0;
};

inline Rover rover_of(const RoverParameters& parameters = {}) { return Rover(parameters, {}); }

inline Height flat() {
  return [](double, double) { return 0.0; };
}
/// Rises along +x.
inline Height plane(double angle_deg) {
  return [t = std::tan(angle_deg * degree)](double x, double) { return t * x; };
}

inline std::size_t wheels_of(const Rover& rover) {
  return static_cast<std::size_t>(rover.suspension().wheels());
}

inline double deepest(const Rover& rover) {
  double depth = 0;
  for (std::size_t n = 0; n < wheels_of(rover); ++n) depth = std::max(depth, rover.state().wheels[n].sunk);
  return depth;
}

}  // namespace desert_sim::test
