#include "src/client/layer_tile.hpp"

#include <algorithm>
#include <array>

namespace desert_sim {

namespace {

// These loops process whole bytes without branches, so that compilers can vectorise them.

constexpr std::size_t padding = 8;  // number of values that are read beyond the last change

void unpack(const std::vector<std::int8_t>& packed, int bits, std::vector<std::int8_t>& changes) {
  const std::size_t bytes = packed.size();
  changes.resize((bits == 4 ? 2 : 1) * bytes + padding);
  const std::int8_t* const from = packed.data();
  std::int8_t* const to = changes.data();
  if (bits == 8) {
    std::copy_n(from, bytes, to);
    return;
  }
  for (std::size_t n = 0; n < bytes; ++n) {
    const int both = from[n];
    to[2 * n] = static_cast<std::int8_t>(both >> 4);
    to[2 * n + 1] = static_cast<std::int8_t>(((both & 15) ^ 8) - 8);
  }
}

/// For each value of a mask byte: the number of its set bits, in all and before each bit.
struct MaskByteRanks {
  std::array<std::array<std::uint8_t, 8>, 256> before{};
  std::array<std::uint8_t, 256> count{};
};
constexpr MaskByteRanks make_ranks() {
  MaskByteRanks ranks;
  for (std::size_t byte = 0; byte < 256; ++byte)
    for (std::size_t n = 0; n < 8; ++n) {
      ranks.before[byte][n] = ranks.count[byte];
      ranks.count[byte] = static_cast<std::uint8_t>(ranks.count[byte] + (byte >> (7 - n) & 1));
    }
  return ranks;
}
constexpr MaskByteRanks ranks = make_ranks();

/// Distributes the changes to all cells of the mask; cells that it does not select get 0.
void expand_changes(const std::int8_t* changes, const std::vector<std::uint8_t>& mask, float* to) {
  for (const std::uint8_t eight : mask) {
    const std::array<std::uint8_t, 8>& before = ranks.before[eight];
    for (std::size_t n = 0; n < 8; ++n)
      to[n] = static_cast<float>(changes[before[n]] & -(eight >> (7 - n) & 1));
    changes += ranks.count[eight];
    to += 8;
  }
}

}  // namespace

void TileDecoder::begin(const LayerTile& tile) {
  tile_ = &tile;
  cell_ = value_ = 0;
  if (tile.changes.empty()) return;
  unpack(tile.changes, tile.bits, changes_);
  if (tile.changed.empty()) {
    expanded_changes_.assign(changes_.begin(), changes_.end());
    return;
  }
  expanded_changes_.resize(8 * tile.changed.size());
  expand_changes(changes_.data(), tile.changed, expanded_changes_.data());
}

void TileDecoder::apply_next(float* elevations, std::size_t cells) {
  const std::size_t first = cell_;
  cell_ += cells;
  if (!tile_->changes.empty()) {
    const float* const steps = expanded_changes_.data() + first;
    const float resolution = tile_->resolution;
    for (std::size_t n = 0; n < cells; ++n) elevations[n] = apply_steps(elevations[n], steps[n], resolution);
  } else if (tile_->changed.empty()) {
    std::copy_n(tile_->data.begin() + static_cast<std::ptrdiff_t>(first), cells, elevations);
  } else {
    for (std::size_t n = 0; n < cells; ++n)
      if (mask_bit(tile_->changed, first + n)) elevations[n] = tile_->data[value_++];
  }
}

}  // namespace desert_sim
