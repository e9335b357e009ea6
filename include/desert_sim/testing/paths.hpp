#pragma once
/// Points of the plane, and how far one path leads away from another.

#include <nav_msgs/Path.h>

#include <vector>

namespace desert_sim::test {

/// In the terrain's frame [m].
struct Point {
  double x = 0, y = 0;
};

/// Place of a rover's base_link in the terrain's frame [m], and its heading, counter-clockwise from +x [rad].
struct Pose {
  double x = 0, y = 0, z = 0, yaw = 0;
};

std::vector<Point> points_of(const nav_msgs::Path& path);

/// How far the points of a path are at most from the line through those of another one [m]: 0 of a path
/// without points, and infinity from one without.
double deviation(const std::vector<Point>& path, const std::vector<Point>& reference);

}  // namespace desert_sim::test
