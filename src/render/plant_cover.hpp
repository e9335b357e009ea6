#pragma once
/// Plants as a picture of the ground seen from above: how much of it lies below crowns, and their colour.
/// What is too far to be drawn plant by plant is seen as this.

#include <cmath>
#include <cstdint>
#include <vector>

#include "src/render/colour.hpp"
#include "src/render/plant_tiles.hpp"

namespace desert_sim::render {

/// A part of a picture that is sent to the graphics card in one go: all columns of some rows.
struct CoverStrip {
  std::size_t level = 0;
  int first = 0, rows = 0;
  std::uint64_t hash = 0;  ///< of its pixels
};

struct CoverPicture {
  static constexpr int most_pixels = 2048;  ///< on a side

  double west = 0, south = 0;  ///< its corner in the plants' frame [m]
  double pixel = 1;            ///< side of a pixel of level 0 [m]
  int width = 0, height = 0;   ///< of level 0 [pixels]; empty without plants
  /// Pixels row by row from the south-west; each level has half the pixels on a side of the level before.
  /// The colour is that of the crowns, weighted by their areas; alpha is the share of the ground below crowns
  /// that lie at random.
  std::vector<std::vector<PackedColour>> levels;
  std::vector<CoverStrip> strips;  ///< of all levels

  bool empty() const { return width == 0; }
  bool same_grid(const CoverPicture& o) const {
    return west == o.west && south == o.south && pixel == o.pixel && width == o.width && height == o.height;
  }
};

/// What may be painted, in the plants' frame [m].
struct CoverBounds {
  double west = -HUGE_VAL, south = -HUGE_VAL, east = HUGE_VAL, north = HUGE_VAL;
};

/// The smallest picture around the feet of all plants. Its pixels are a power of two [m] on a side: as small
/// as `most_pixels` allow, but for no more than 64 pixels a plant, or 2^16 in all.
CoverPicture plant_cover(const PlantTiles& plants, const CoverBounds& bounds = {});

}  // namespace desert_sim::render
