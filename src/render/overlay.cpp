#include "src/render/overlay.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

namespace desert_sim::render {

namespace {

using Stops = std::array<Colour, 5>;  // evenly from 0 to 1
constexpr Stops sequential{{{0.27f, 0.00f, 0.33f},
                            {0.23f, 0.32f, 0.55f},
                            {0.13f, 0.57f, 0.55f},
                            {0.37f, 0.79f, 0.38f},
                            {0.99f, 0.91f, 0.14f}}};
constexpr Stops diverging{{{0.13f, 0.30f, 0.70f},
                           {0.55f, 0.70f, 0.90f},
                           {0.97f, 0.97f, 0.97f},
                           {0.93f, 0.60f, 0.50f},
                           {0.70f, 0.08f, 0.16f}}};
constexpr Stops signal_stops{{{0.10f, 0.60f, 0.25f},
                              {0.55f, 0.78f, 0.30f},
                              {0.98f, 0.88f, 0.30f},
                              {0.95f, 0.50f, 0.20f},
                              {0.75f, 0.08f, 0.12f}}};

const Stops& stops_of(ColourMap map) {
  switch (map) {
    case ColourMap::diverging:
      return diverging;
    case ColourMap::signal:
      return signal_stops;
    default:
      return sequential;
  }
}

}  // namespace

Colour colour_of(ColourMap map, float share) {
  const Stops& stops = stops_of(map);
  const float position = std::clamp(share, 0.0f, 1.0f) * (stops.size() - 1);
  const std::size_t n = std::min(static_cast<std::size_t>(position), stops.size() - 2);
  return mix(stops[n], stops[n + 1], position - static_cast<float>(n));
}

float Overlay::share(float value) const {
  return low == high ? 0.5f : std::clamp((value - low) / (high - low), 0.0f, 1.0f);
}

Colour Overlay::on(const Colour& ground, float value) const {
  return std::isnan(value) ? ground : mix(ground, colour_of(map, share(value)), opacity);
}

const std::vector<LayerStyle>& layer_styles() {
  static const std::vector<LayerStyle> styles{{"elevation", "m", 0, 50, ColourMap::sequential},
                                              {change_layer, "m", -0.5f, 0.5f, ColourMap::diverging},
                                              {slope_layer, "deg", 0, 40, ColourMap::signal},
                                              {"traversability", "1", 1, 0, ColourMap::signal},
                                              {"cost", "1", 0, 100, ColourMap::signal},
                                              {"wind_shadow", "1", 0, 1, ColourMap::sequential},
                                              {"echo", "1", -1, 1, ColourMap::diverging},
                                              {"moisture", "m", 0, 0.1f, ColourMap::sequential},
                                              {"sand_depth", "m", 0, 10, ColourMap::sequential},
                                              {"soil_depth", "m", 0, 1, ColourMap::sequential},
                                              {"water_depth", "m", 0, 3, ColourMap::sequential},
                                              {"vegetation", "1", 0, 1, ColourMap::sequential},
                                              {"grass", "1", 0, 1, ColourMap::sequential},
                                              {"mesquite", "1", 0, 1, ColourMap::sequential},
                                              {"shrub", "1", 0, 1, ColourMap::sequential},
                                              {"burial", "m", -0.5f, 0.5f, ColourMap::diverging},
                                              {"snow_density", "kg/m^3", 0, 500, ColourMap::sequential},
                                              {"roughness", "m", 0, 0.5f, ColourMap::sequential},
                                              {"step_height", "m", 0, 0.5f, ColourMap::sequential}};
  return styles;
}

LayerStyle layer_style(const std::string& layer) {
  for (const LayerStyle& style : layer_styles())
    if (style.layer == layer) return style;
  return {layer, "1", 0, 1, ColourMap::sequential};
}

ValueRange range_of(const std::vector<float>& values) {
  float low = std::numeric_limits<float>::infinity(), high = -low;
  for (const float value : values) {
    if (value < low) low = value;
    if (value > high) high = value;
  }
  if (low > high) return {};
  return {low, high};
}

std::string legend_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

}  // namespace desert_sim::render
