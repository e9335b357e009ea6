#include "src/render/cost_colours.hpp"

#include <algorithm>

namespace desert_sim::render {

namespace {

struct CostStops {
  Colour low, middle, high, inscribed, lethal;
};

constexpr CostStops present_stops{{0.98f, 0.88f, 0.30f},
                                  {0.95f, 0.50f, 0.15f},
                                  {0.80f, 0.10f, 0.12f},
                                  {0.66f, 0.05f, 0.30f},
                                  {0.42f, 0.05f, 0.45f}};
constexpr CostStops forecast_stops{{0.55f, 0.95f, 0.85f},
                                   {0.10f, 0.70f, 0.62f},
                                   {0.02f, 0.42f, 0.40f},
                                   {0.01f, 0.26f, 0.26f},
                                   {0.00f, 0.10f, 0.12f}};

bool is_known_cost(std::int8_t cost) { return cost >= free_cost && cost <= lethal_cost; }

}  // namespace

Colour cost_colour(CostPalette palette, std::int8_t cost) {
  const CostStops& stops = palette == CostPalette::present ? present_stops : forecast_stops;
  if (cost >= lethal_cost) return stops.lethal;
  if (cost == inscribed_cost) return stops.inscribed;
  const float share = 2 * static_cast<float>(cost) / (inscribed_cost - 1);
  return share < 1 ? mix(stops.low, stops.middle, share) : mix(stops.middle, stops.high, share - 1);
}

float cost_opacity(std::int8_t cost, float opacity, int x, int y) {
  constexpr float full_from = 50;
  if (!is_known_cost(cost)) return (x + y) % 4 < 2 ? opacity : 0;
  return opacity * std::min(1.0f, static_cast<float>(cost) / full_from);
}

PackedColour cost_pixel(CostPalette palette, std::int8_t cost, float opacity, int x, int y) {
  const float alpha = cost_opacity(cost, opacity, x, y);
  const Colour c = is_known_cost(cost) ? cost_colour(palette, cost) : unknown_cost_colour;
  return pack(c, alpha);
}

}  // namespace desert_sim::render
