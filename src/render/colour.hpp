#pragma once
/// Colours for drawing.

#include <algorithm>
#include <cstdint>

namespace desert_sim::render {

struct Colour {
  float r = 0, g = 0, b = 0;  ///< 0…1
};

/// The bytes red, green, blue and alpha, red in the lowest.
using PackedColour = std::uint32_t;

inline PackedColour pack(const Colour& c, float alpha = 1) {
  const auto byte = [](float v) {
    return static_cast<PackedColour>(255.0f * std::min(1.0f, std::max(0.0f, v)) + 0.5f);
  };
  return byte(c.r) | byte(c.g) << 8 | byte(c.b) << 16 | byte(alpha) << 24;
}

inline Colour mix(const Colour& a, const Colour& b, float share) {
  return {a.r + share * (b.r - a.r), a.g + share * (b.g - a.g), a.b + share * (b.b - a.b)};
}

}  // namespace desert_sim::render
