#pragma once
/// Packed tiles on their way to the host.

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "kernels/view/packed_tiles.hpp"
#include "src/simulation/views/staging.hpp"

namespace desert_sim {

struct TileTransfer {
  packed_tiles::Tiling tiles;     ///< of the whole grid
  std::size_t bytes_of_cell = 1;  ///< at most
  /// Starts laws that pack some rows of the tiles.
  std::function<void(const packed_tiles::Tiling& rows, char* to)> pack;
  /// Once they have arrived, in the order of rows; by whoever waits for them.
  std::function<void(Staging::Slot&, const packed_tiles::Tiling& rows)> unpack;
};

/// As many rows of tiles at a time as staging memory has room for.
void send_tiles(Staging& staging, const TileTransfer& transfer, const std::shared_ptr<Readback>& readback);

struct PackedTile {
  packed_tiles::TileHeader head;
  packed_tiles::TileOfGrid place;
  const char* cells;
};
/// What lies packed in a slot, ordered by the tiles' numbers; only that is copied.
std::vector<PackedTile> packed_tiles_in(Staging::Slot& slot, const packed_tiles::Tiling& tiles);

}  // namespace desert_sim
