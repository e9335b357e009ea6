#pragma once
/// Where a ray meets the terrain: what the mouse points at.

#include <optional>

#include "src/render/height_field.hpp"

namespace desert_sim::render {

/// The point nearest to the ray's origin in which the ray meets the surface of HeightField::height_at(),
/// from above or from below; empty if it meets none. Where the surface is unknown, rays go through. The
/// time is proportional to the number of cells below the ray.
std::optional<Point> first_hit(const HeightField& field, const Ray& ray);

}  // namespace desert_sim::render
