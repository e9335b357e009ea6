#pragma once
/// What others lack of the surface, tile by tile.

#include <cstdint>
#include <vector>

#include "kernels/view/held_elevation.hpp"
#include "src/simulation/views/staging.hpp"

namespace desert_sim {

/// Cells x … x + width − 1, y … y + height − 1, row-major, of which some changed.
struct TileChange {
  int x = 0, y = 0, width = 0, height = 0;
  int bits = 0;          ///< of a step: 4 or 8; 0 if there are none
  float resolution = 0;  ///< of a step [m]
  /// One of both, with held_elevation::unchanged_step or unchanged_elevation in the place of a cell that did
  /// not change.
  std::vector<std::int8_t> steps;
  std::vector<float> elevations;  ///< [m]

  bool changed(std::size_t cell) const {
    return bits ? steps[cell] != held_elevation::unchanged_step
                : elevations[cell] != held_elevation::unchanged_elevation;
  }
};

/// Tiles in which a cell changed, row-major.
struct ElevationChanges {
  std::vector<TileChange> tiles;
};

/// Reads what held_elevation::pack_changes() has packed in `slot`; only that is copied.
std::vector<TileChange> unpacked_changes(Staging::Slot& slot, const packed_tiles::Tiling& tiles);

}  // namespace desert_sim
