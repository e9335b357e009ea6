#pragma once
/// Decodes the tiles of an update; LayerTile.msg describes their format. The node encodes tiles with the
/// same arithmetic, so that it knows exactly which elevations its subscribers have.

#include <desert_sim/LayerTile.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/view/quantised_steps.hpp"

namespace desert_sim {

/// Size of the packed changes [bytes]; `bits` per change is 8 or 4.
inline std::size_t change_bytes(std::size_t changes, int bits) {
  return bits == 4 ? (changes + 1) / 2 : changes;
}
/// Size of a tile's mask [bytes].
inline std::size_t mask_bytes(std::size_t cells) { return (cells + 7) / 8; }
/// Whether the mask selects the cell with this number.
inline bool mask_bit(const std::vector<std::uint8_t>& mask, std::size_t cell) {
  return (mask[cell / 8] >> (7 - cell % 8)) & 1;
}

/// Decodes tiles cell by cell, in the order of the tile. A tile must be valid: see validation_error() in
/// layer_messages.hpp.
class TileDecoder {
 public:
  /// Starts with the first cell of a tile, which must outlive the calls of apply_next().
  void begin(const LayerTile& tile);
  /// Applies the next `cells` cells of the tile to `elevations`; cells that did not change stay.
  void apply_next(float* elevations, std::size_t cells);

 private:
  const LayerTile* tile_ = nullptr;
  std::size_t cell_ = 0, value_ = 0;
  std::vector<std::int8_t> changes_;     ///< unpacked changes of the selected cells
  std::vector<float> expanded_changes_;  ///< changes of all cells, 0 if not selected
};

}  // namespace desert_sim
