#pragma once
/// The sky behind a terrain, with the sun of sunlight.hpp. Directions are unit vectors from the eye, z up.

#include "src/render/mesh.hpp"
#include "src/render/view.hpp"

namespace desert_sim::render {

/// Pale at the horizon, blue above, bright around the sun; below the horizon, haze.
Colour sky_colour(const Point& direction);
constexpr Colour sun_disc_colour{1.0f, 1.0f, 0.96f};

/// The sky as the inside of a sphere around the eye [m]; the disc of the sun is drawn last, over it, eight
/// times as wide as the true one, so that it is seen as such.
Mesh sky_dome(float radius);

}  // namespace desert_sim::render
