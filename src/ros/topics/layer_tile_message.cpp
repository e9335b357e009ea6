#include "src/ros/topics/layer_tile_message.hpp"

#include <utility>

#include "kernels/field/cell_box.hpp"
#include "src/client/layer_tile.hpp"

namespace desert_sim {

namespace {

/// The smallest box with all cells that changed.
CellBox changed_cells(const TileChange& change) {
  CellBox found;
  std::size_t row = 0;
  for (int y = 0; y < change.height; ++y, row += static_cast<std::size_t>(change.width)) {
    const auto changed = [&](int x) { return change.changed(row + static_cast<std::size_t>(x)); };
    int x0 = 0, x1 = change.width;
    while (x0 < x1 && !changed(x0)) ++x0;
    while (x0 < x1 && !changed(x1 - 1)) --x1;
    if (x0 < x1) found = found.united_with({x0, y, x1, y + 1});
  }
  return found;
}

/// The cells of `box`, row-major, from a tile that is `width` cells wide.
template <class Value>
std::vector<Value> cells_in(const std::vector<Value>& tile, int width, const CellBox& box) {
  std::vector<Value> cells;
  cells.reserve(static_cast<std::size_t>(box.width()) * static_cast<std::size_t>(box.height()));
  for (int y = box.y0; y < box.y1; ++y) {
    const auto row = tile.begin() + static_cast<std::ptrdiff_t>(y) * width;
    cells.insert(cells.end(), row + box.x0, row + box.x1);
  }
  return cells;
}

/// Removes the cells that did not change, without a branch for each cell. Returns the bit mask of those that
/// did, or an empty one if all did.
template <class Value>
std::vector<std::uint8_t> compact_changed(std::vector<Value>& cells, Value unchanged) {
  std::vector<std::uint8_t> mask(mask_bytes(cells.size()), 0);
  std::size_t kept = 0;
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    const unsigned changed = cells[cell] != unchanged ? 1 : 0;
    mask[cell / 8] = static_cast<std::uint8_t>(mask[cell / 8] | changed << (7 - cell % 8));
    cells[kept] = cells[cell];
    kept += changed;
  }
  if (kept == cells.size()) mask.clear();
  cells.resize(kept);
  return mask;
}

/// Packs two changes of four bits into each byte, the first into its high half.
std::vector<std::int8_t> packed_nibbles(std::vector<std::int8_t> changes) {
  const std::size_t bytes = change_bytes(changes.size(), 4);
  changes.resize(2 * bytes, 0);
  for (std::size_t n = 0; n < bytes; ++n)
    changes[n] = static_cast<std::int8_t>(changes[2 * n] * 16 | (changes[2 * n + 1] & 15));
  changes.resize(bytes);
  return changes;
}

}  // namespace

LayerTile tile_message(const TileChange& change) {
  const CellBox box = changed_cells(change);
  LayerTile tile;
  tile.x = static_cast<std::uint32_t>(change.x + box.x0);
  tile.y = static_cast<std::uint32_t>(change.y + box.y0);
  tile.width = static_cast<std::uint32_t>(box.width());
  tile.height = static_cast<std::uint32_t>(box.height());
  tile.bits = static_cast<std::uint8_t>(change.bits);
  tile.resolution = change.resolution;
  if (change.bits == 0) {
    tile.data = cells_in(change.values, change.width, box);
    tile.changed = compact_changed(tile.data, held_layer::unchanged_value);
    return tile;
  }
  std::vector<std::int8_t> steps = cells_in(change.steps, change.width, box);
  tile.changed = compact_changed(steps, held_layer::unchanged_step);
  tile.changes = change.bits == 4 ? packed_nibbles(std::move(steps)) : std::move(steps);
  return tile;
}

}  // namespace desert_sim
