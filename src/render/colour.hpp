#pragma once
/// Colours for drawing.

#include <algorithm>
#include <cmath>
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

/// The colour of a plant's crown by its hue [deg]: each channel is bright within 60 degrees of its own hue
/// and dull beyond 120 degrees.
inline Colour crown_colour(float hue) {
  constexpr float dull = 0.13f, bright = 0.52f;
  const auto channel = [&](float peak) {
    const float away = std::abs(std::remainder(hue - peak, 360.0f));
    return dull + (bright - dull) * std::clamp(2.0f - away / 60.0f, 0.0f, 1.0f);
  };
  return {channel(0), channel(120), channel(240)};
}

inline Colour mix(const Colour& a, const Colour& b, float share) {
  return {a.r + share * (b.r - a.r), a.g + share * (b.g - a.g), a.b + share * (b.b - a.b)};
}

}  // namespace desert_sim::render
