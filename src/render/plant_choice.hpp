#pragma once
/// Which plants a camera sees large enough to be drawn as shapes.

#include <functional>
#include <vector>

#include "src/render/plant_tiles.hpp"
#include "src/render/view.hpp"

namespace desert_sim::render {

struct PlantLimits {
  std::size_t plants = 10000;  ///< at most so many are drawn as shapes, a tenth of them in detail
  std::size_t tiles = 400;     ///< in at most so many tiles
  double pixels = 1.5;         ///< from this radius on [pixels]
  double detailed_pixels = 12;
};

struct ChosenTile {
  std::size_t tile = 0;
  std::uint32_t plants = 0;  ///< the widest so many of it
  bool detailed = false;
};

/// The tiles in the picture whose plants are large enough, those with the largest plants first, as pixels
/// count; among equals the nearest. `in_detail` tells which tiles are drawn in detail now: they stay so until
/// they are clearly smaller.
std::vector<ChosenTile> choose_plant_tiles(const PlantTiles& plants, const View& view, double exaggeration,
                                           const PlantLimits& limits,
                                           const std::function<bool(std::size_t tile)>& in_detail);

}  // namespace desert_sim::render
