#pragma once
/// The colours of maps of costs that are laid on the ground (nav_msgs/OccupancyGrid).

#include <cstdint>

#include "src/render/colour.hpp"

namespace desert_sim::render {

/// Two palettes, so that the costs of now and those of a forecast are told apart.
enum class CostPalette {
  present,  ///< yellow, orange, red; lethal: purple
  forecast  ///< light to dark teal; lethal: nearly black
};

/// What a cost means to costmap_2d. 1 … 98 are costs of ground that can be driven on.
constexpr std::int8_t free_cost = 0, inscribed_cost = 99, lethal_cost = 100;

/// The colour of a cost 0 … 100.
Colour cost_colour(CostPalette palette, std::int8_t cost);
constexpr Colour unknown_cost_colour{0.35f, 0.35f, 0.38f};

/// How much of the ground a cell hides: nothing where it is free, `opacity` from a cost of 50 on. Unknown
/// cells, those of all values beyond 0 … 100, are hatched along the diagonal.
float cost_opacity(std::int8_t cost, float opacity, int x, int y);

/// The pixel of a cell. Where nothing is drawn it has the colour of the lowest cost (or of unknown ones), so
/// that pixels can be interpolated.
PackedColour cost_pixel(CostPalette palette, std::int8_t cost, float opacity, int x, int y);

}  // namespace desert_sim::render
