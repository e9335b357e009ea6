#include "src/render/scale_bar.hpp"

#include <cmath>

#include "src/render/drawable.hpp"
#include "src/render/overlay.hpp"

namespace desert_sim::render {

std::optional<ScaleBar> scale_bar(double metres_per_pixel, double most_pixels) {
  const double most = metres_per_pixel * most_pixels;
  if (!is_drawable(most) || !(most >= 1e-3)) return std::nullopt;
  const double decade = std::pow(10, std::floor(std::log10(most)));
  double metres = decade;
  for (const double digit : {2.0, 5.0, 10.0})
    if (digit * decade <= most) metres = digit * decade;
  return ScaleBar{metres, metres / metres_per_pixel};
}

std::string length_text(double metres) {
  if (metres >= 1000) return legend_number(metres / 1000) + " km";
  if (metres >= 1) return legend_number(metres) + " m";
  return metres >= 0.01 ? legend_number(100 * metres) + " cm" : legend_number(1000 * metres) + " mm";
}

double north_angle(const Point& right) { return std::atan2(right.y(), right.x()); }

}  // namespace desert_sim::render
