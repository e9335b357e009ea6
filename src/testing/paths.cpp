#include "include/desert_sim/testing/paths.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace desert_sim::test {

namespace {

double distance_to_segment(const Point& p, const Point& a, const Point& b) {
  const double along_x = b.x - a.x, along_y = b.y - a.y, length = along_x * along_x + along_y * along_y;
  const double share =
      length > 0 ? std::clamp(((p.x - a.x) * along_x + (p.y - a.y) * along_y) / length, 0.0, 1.0) : 0.0;
  return std::hypot(p.x - a.x - share * along_x, p.y - a.y - share * along_y);
}

double distance_to_line(const Point& p, const std::vector<Point>& line) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < line.size(); ++n)
    nearest = std::min(nearest, distance_to_segment(p, line[n], line[std::min(n + 1, line.size() - 1)]));
  return nearest;
}

}  // namespace

std::vector<Point> points_of(const nav_msgs::Path& path) {
  std::vector<Point> points;
  points.reserve(path.poses.size());
  for (const geometry_msgs::PoseStamped& pose : path.poses)
    points.push_back({pose.pose.position.x, pose.pose.position.y});
  return points;
}

double deviation(const std::vector<Point>& path, const std::vector<Point>& reference) {
  double farthest = 0;
  for (const Point& p : path) farthest = std::max(farthest, distance_to_line(p, reference));
  return farthest;
}

}  // namespace desert_sim::test
