#include "src/render/plant_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "src/render/palette.hpp"
#include "src/render/sunlight.hpp"

namespace desert_sim::render {

namespace {

/// A cone of `sides` triangles: from a ring around (x, y) at height `ring_z` up, or down, to its tip.
void add_cone(int sides, double x, double y, double ring_z, double radius, double tip_z,
              std::vector<Point>& corners) {
  const auto ring = [&](int n) {
    const double angle = 2 * 3.14159265358979 * n / sides;
    return Point{x + radius * std::cos(angle), y + radius * std::sin(angle), ring_z};
  };
  const bool up = tip_z > ring_z;
  for (int n = 0; n < sides; ++n) {
    corners.push_back(ring(up ? n : n + 1));
    corners.push_back(ring(up ? n + 1 : n));
    corners.push_back({x, y, tip_z});
  }
}

/// Three vertices with the normal of their triangle.
void add_triangle(const Point* corner, const Colour& colour, bool light, Mesh& mesh) {
  const Eigen::Vector3f normal =
      (corner[1] - corner[0]).cross(corner[2] - corner[0]).stableNormalized().cast<float>();
  const PackedColour packed =
      pack(light ? lit(colour, illumination(normal.x(), normal.y(), normal.z())) : colour);
  for (std::size_t n = 0; n < 3; ++n) {
    const Eigen::Vector3f p = corner[n].cast<float>();
    mesh.indices.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    mesh.vertices.push_back({p.x(), p.y(), p.z(), normal.x(), normal.y(), normal.z(), packed});
  }
}

}  // namespace

void add_plant(const Plant& plant, bool detailed, std::vector<Point>& corners) {
  const auto height_at = [&](double share) { return plant.foot + share * plant.height(); };
  if (!detailed) {
    add_cone(4, plant.x, plant.y, plant.foot, 0.8 * plant.radius, height_at(1), corners);
    return;
  }
  add_cone(3, plant.x, plant.y, plant.foot, 0.12 * plant.radius, height_at(0.7), corners);
  add_cone(6, plant.x, plant.y, height_at(0.55), 0.9 * plant.radius, height_at(1), corners);
  add_cone(6, plant.x, plant.y, height_at(0.55), 0.9 * plant.radius, height_at(0.3), corners);
}

void add_plant(const Plant& plant, bool detailed, const Colour& colour, Mesh& mesh) {
  std::vector<Point> corners;
  corners.reserve(indices_of_plant(detailed));
  add_plant(plant, detailed, corners);
  for (std::size_t corner = 0; corner + 2 < corners.size(); corner += 3)
    add_triangle(&corners[corner], colour, true, mesh);
}

std::vector<std::size_t> widest_plants(const std::vector<float>& radii, std::size_t count) {
  std::vector<std::size_t> numbers(radii.size());
  std::iota(numbers.begin(), numbers.end(), std::size_t{0});
  if (count >= numbers.size()) return numbers;
  const auto wider = [&](std::size_t a, std::size_t b) {
    return radii[a] != radii[b] ? radii[a] > radii[b] : a < b;
  };
  std::nth_element(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(count), numbers.end(),
                   wider);
  numbers.resize(count);
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

Mesh plants_mesh(const std::vector<Plant>& plants, const std::vector<std::uint8_t>& species,
                 const PlantLook& look) {
  std::vector<float> radii;
  radii.reserve(plants.size());
  for (const Plant& plant : plants) radii.push_back(static_cast<float>(plant.radius));
  const std::vector<std::size_t> detailed = widest_plants(radii, (plants.size() + 9) / 10);
  Mesh mesh;
  std::vector<Point> corners;
  auto next = detailed.begin();
  for (std::size_t n = 0; n < plants.size(); ++n) {
    const bool in_detail = next != detailed.end() && *next == n;
    if (in_detail) ++next;
    Plant plant = plants[n];
    plant.foot *= look.vertical_exaggeration;
    corners.clear();
    add_plant(plant, in_detail, corners);
    const Colour colour = species[n] < look.colours.size() ? look.colours[species[n]] : Palette().vegetation;
    for (std::size_t corner = 0; corner + 2 < corners.size(); corner += 3)
      add_triangle(&corners[corner], colour, look.light, mesh);
  }
  mesh.surface_indices = mesh.indices.size();
  return mesh;
}

}  // namespace desert_sim::render
