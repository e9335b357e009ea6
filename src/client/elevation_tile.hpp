#pragma once
/// How a tile of an update is read; see ElevationTile.msg. The node writes tiles with the same arithmetic, so
/// that it knows to the bit what its subscribers hold.

#include <desert_sim/ElevationTile.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "desert_sim/kernels/elevation_step.hpp"

namespace desert_sim {

/// Bytes that so many changes take, and change number n of them; `bits` is 8 or 4.
inline std::size_t change_bytes(std::size_t changes, int bits) {
  return bits == 4 ? (changes + 1) / 2 : changes;
}
inline std::int8_t change_at(const std::vector<std::int8_t>& changes, int bits, std::size_t n) {
  if (bits == 8) return changes[n];
  const int both = changes[n / 2];
  return static_cast<std::int8_t>(n % 2 == 0 ? both >> 4 : ((both & 15) ^ 8) - 8);
}
inline void change_add(std::vector<std::int8_t>& changes, int bits, std::size_t n, int change) {
  if (bits == 8 || n % 2 == 0)
    changes.push_back(static_cast<std::int8_t>(bits == 8 ? change : change * 16));
  else
    changes.back() = static_cast<std::int8_t>(changes.back() | (change & 15));
}

inline std::size_t mask_bytes(std::size_t cells) { return (cells + 7) / 8; }
inline bool mask_has(const std::vector<std::uint8_t>& mask, std::size_t cell) {
  return (mask[cell / 8] >> (7 - cell % 8)) & 1;
}
inline void mask_add(std::vector<std::uint8_t>& mask, std::size_t cell) {
  mask[cell / 8] = static_cast<std::uint8_t>(mask[cell / 8] | 1u << (7 - cell % 8));
}

/// Reads a tile cell by cell, in its order. The tile must be sound: see fault_of() in elevation_map.hpp.
class TileReader {
 public:
  explicit TileReader(const ElevationTile& tile) : tile_(tile) {}
  /// Writes the next cell over what is held, if it changed.
  void write_next(float& held) {
    const std::size_t cell = cell_++;
    if (!tile_.changed.empty() && !mask_has(tile_.changed, cell)) return;
    held = tile_.changes.empty()
               ? tile_.data[value_]
               : changed_elevation(held, change_at(tile_.changes, tile_.bits, value_), tile_.resolution);
    ++value_;
  }

 private:
  const ElevationTile& tile_;
  std::size_t cell_ = 0, value_ = 0;
};

}  // namespace desert_sim
