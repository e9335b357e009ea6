#include "src/render/terrain_colours.hpp"

#include <cmath>

namespace desert_sim::render {

namespace {

constexpr float hidden = 0.02f, covering = 0.12f;  // depths of sand or soil: none and all of it is seen [m]
constexpr float wet = 0.05f;                       // moisture of ground that looks fully wet [m]
constexpr float wet_brightness = 0.62f;

float known(float value) { return std::isnan(value) ? 0.0f : value; }

}  // namespace

float smooth_step(float from, float to, float value) {
  const float t = std::clamp((value - from) / (to - from), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

float cover_of_depth(float depth) { return smooth_step(hidden, covering, known(depth)); }

Colour ground_colour(const SurfaceMaterials& m, const Palette& p) {
  Colour colour = mix(p.weak_rock, p.hard_rock, std::clamp(known(m.resistance), 0.0f, 1.0f));
  colour = mix(colour, p.soil, std::clamp(known(m.soil), 0.0f, 1.0f));
  colour = mix(colour, p.sand, std::clamp(known(m.sand), 0.0f, 1.0f));
  const float brightness = 1 + (wet_brightness - 1) * smooth_step(0, wet, known(m.moisture));
  colour = {colour.r * brightness, colour.g * brightness, colour.b * brightness};
  colour = mix(colour, m.plants.value_or(p.vegetation), 0.9f * smooth_step(0, 0.8f, known(m.vegetation)));
  return mix(colour, p.obstacle, smooth_step(0.25f, 0.75f, known(m.obstacle)));
}

Colour water_colour(float depth, const Palette& p) {
  return mix(p.shallow_water, p.deep_water, 1 - std::exp(-std::max(0.0f, known(depth)) / 2));
}

float water_opacity(float depth) { return 0.92f * smooth_step(0.001f, 0.2f, known(depth)); }

Colour wind_colour(float relative) {
  constexpr Colour slow{0.10f, 0.25f, 0.85f}, equal{0.92f, 0.97f, 1.0f}, fast{0.95f, 0.15f, 0.10f};
  const float position = std::clamp(2 * (relative - 0.5f), 0.0f, 2.0f);
  return position < 1 ? mix(slow, equal, position) : mix(equal, fast, position - 1);
}

}  // namespace desert_sim::render
