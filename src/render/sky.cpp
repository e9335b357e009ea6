#include "src/render/sky.hpp"

#include <algorithm>
#include <cmath>

#include "src/render/sunlight.hpp"

namespace desert_sim::render {

namespace {

constexpr double disc = 2 * pi / 180;  // half of the sun's width [rad]
constexpr Colour zenith{0.33f, 0.52f, 0.78f}, horizon{0.87f, 0.87f, 0.84f}, haze{0.78f, 0.74f, 0.67f},
    glow{1.0f, 0.96f, 0.86f};

Point towards(double azimuth, double elevation) {
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
          std::sin(elevation)};
}

std::uint32_t add_vertex(const Point& direction, float radius, const Colour& colour, Mesh& mesh) {
  const Eigen::Vector3f p = radius * direction.cast<float>();
  mesh.vertices.push_back({p.x(), p.y(), p.z(), 0, 0, 1, pack(colour)});
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

}  // namespace

Colour sky_colour(const Point& direction) {
  const auto up = static_cast<float>(direction.z());
  const Colour colour = up > 0 ? mix(horizon, zenith, std::sqrt(std::min(1.0f, up)))
                               : mix(horizon, haze, std::min(1.0f, -8 * up));
  const float near = std::max(0.0f, static_cast<float>(direction.dot(towards_sun())));
  return mix(colour, glow, 0.35f * std::pow(near, 24.0f));
}

Mesh sky_dome(float radius) {
  constexpr std::uint32_t sides = 72, rings = 24;
  Mesh mesh;
  for (std::uint32_t ring = 0; ring <= rings; ++ring) {
    const double share = 2.0 * ring / rings - 1;  // -1 … 1, denser near the horizon
    const double elevation = share * std::abs(share) * pi / 2;
    for (std::uint32_t side = 0; side < sides; ++side) {
      const Point direction = towards(2 * pi * side / sides, elevation);
      const std::uint32_t here = add_vertex(direction, radius, sky_colour(direction), mesh);
      if (ring == 0) continue;
      const std::uint32_t next = side + 1 < sides ? here + 1 : here + 1 - sides;
      for (const std::uint32_t corner : {here, here - sides, next, next, here - sides, next - sides})
        mesh.indices.push_back(corner);
    }
  }
  const Point sun = towards_sun(), across = sun.unitOrthogonal(), other = sun.cross(across);
  const std::uint32_t centre = add_vertex(sun, radius, sun_disc_colour, mesh);
  constexpr std::uint32_t corners = 24;
  for (std::uint32_t n = 0; n < corners; ++n) {
    const double angle = 2 * pi * n / corners;
    add_vertex(std::cos(disc) * sun + std::sin(disc) * (std::cos(angle) * across + std::sin(angle) * other),
               radius, sun_disc_colour, mesh);
    for (const std::uint32_t corner : {centre, centre + 1 + n, centre + 1 + (n + 1) % corners})
      mesh.indices.push_back(corner);
  }
  mesh.surface_indices = mesh.indices.size();
  return mesh;
}

}  // namespace desert_sim::render
