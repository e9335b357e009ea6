#pragma once
/// How a tile of an update is read; see ElevationTile.msg. The node writes tiles with the same arithmetic, so
/// that it knows to the bit what its subscribers hold.

#include <desert_sim/ElevationTile.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/view/elevation_step.hpp"

namespace desert_sim {

/// Bytes that so many changes take; `bits` is 8 or 4.
inline std::size_t change_bytes(std::size_t changes, int bits) {
  return bits == 4 ? (changes + 1) / 2 : changes;
}
inline std::size_t mask_bytes(std::size_t cells) { return (cells + 7) / 8; }
inline bool mask_has(const std::vector<std::uint8_t>& mask, std::size_t cell) {
  return (mask[cell / 8] >> (7 - cell % 8)) & 1;
}

/// Reads tiles cell by cell, in their order. A tile must be sound: see fault_of() in elevation_map.hpp.
class TileReader {
 public:
  void begin(const ElevationTile& tile);
  /// Writes the next cells over what is held, where they changed.
  void write_next(float* held, std::size_t cells);

 private:
  const ElevationTile* tile_ = nullptr;
  std::size_t cell_ = 0, value_ = 0;
  std::vector<std::int8_t> changes_;  ///< of the cells that changed
  std::vector<float> steps_;          ///< of all cells, 0 where they did not
};

}  // namespace desert_sim
