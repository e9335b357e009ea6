#include "src/render/draped_line.hpp"

#include <algorithm>
#include <cmath>

namespace desert_sim::render {

namespace {

constexpr double most_points = 4096;

}  // namespace

std::vector<Place> circle(const Place& centre, double radius) {
  constexpr int sides = 96;
  std::vector<Place> places;
  for (int n = 0; n <= sides; ++n) {
    const double angle = 2 * pi * (n % sides) / sides;
    places.push_back({centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)});
  }
  return places;
}

std::vector<Point> drape(const HeightField& field, const std::vector<Place>& line) {
  std::vector<Point> points;
  const auto put = [&](const Place& p) { points.emplace_back(p.x, p.y, field.height_at(p)); };
  double length = 0;
  for (std::size_t n = 1; n < line.size(); ++n) length += distance(line[n - 1], line[n]);
  const double room = std::max(1.0, most_points - static_cast<double>(line.size()) - 1);
  const double spacing = std::max(field.cell_size, length / room);
  for (std::size_t n = 0; n + 1 < line.size(); ++n) {
    const Place &a = line[n], &b = line[n + 1];
    const int parts = std::max(1, static_cast<int>(std::ceil(distance(a, b) / spacing)));
    for (int part = 0; part < parts; ++part) {
      const double share = static_cast<double>(part) / parts;
      put({a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)});
    }
  }
  if (!line.empty()) put(line.back());
  return points;
}

Measurement measure(const std::vector<Point>& line) {
  Measurement result;
  if (line.empty()) return result;
  const Eigen::Vector3d way = line.back() - line.front();
  result.horizontal = way.head<2>().norm();
  for (std::size_t n = 1; n < line.size(); ++n) result.along_surface += (line[n] - line[n - 1]).norm();
  result.height_difference = way.z();
  result.slope = std::atan2(result.height_difference, result.horizontal);
  return result;
}

void append_line(Mesh& mesh, const std::vector<Point>& line, double exaggeration, PackedColour colour) {
  for (std::size_t n = 0; n < line.size(); ++n) {
    const Point& p = line[n];
    const auto index = static_cast<std::uint32_t>(mesh.vertices.size());
    if (std::isnan(p.z())) continue;
    mesh.vertices.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()),
                             static_cast<float>(exaggeration * p.z()), 0, 0, 1, colour});
    if (n == 0 || std::isnan(line[n - 1].z())) continue;
    mesh.indices.push_back(index - 1);
    mesh.indices.push_back(index);
  }
  mesh.surface_indices = mesh.indices.size();
}

}  // namespace desert_sim::render
