#pragma once
/// How a picture's scale and direction are told: by a bar of a round length, and by an arrow to the north.

#include <optional>
#include <string>

#include "src/render/view.hpp"

namespace desert_sim::render {

struct ScaleBar {
  double metres, pixels;
};

/// The longest bar of 1, 2 or 5 times a power of ten [m] that takes at most `most_pixels`; none for a scale
/// that no picture of a desert has (is_drawable()).
std::optional<ScaleBar> scale_bar(double metres_per_pixel, double most_pixels);

/// A length of such a bar: 20 cm, 5 m, 2 km.
std::string length_text(double metres);

/// The angle from the upper edge of the picture clockwise to the north, on a map that lies level before the
/// viewer [rad]. `right` points to the right edge of the picture, in a frame with x to the east and y to the
/// north (REP 103). 0 if that is vertical.
double north_angle(const Point& right);

}  // namespace desert_sim::render
