#include "src/ros/topics/elevation_tiles.hpp"

#include <algorithm>

#include "kernels/field/cell_box.hpp"
#include "src/client/elevation_tile.hpp"

namespace desert_sim {

namespace {

CellBox changed_cells(const TileChange& change) {
  CellBox found;
  std::size_t row = 0;
  for (int y = 0; y < change.height; ++y, row += static_cast<std::size_t>(change.width)) {
    const auto changed = [&](int x) { return change.changed(row + static_cast<std::size_t>(x)); };
    int x0 = 0, x1 = change.width;
    while (x0 < x1 && !changed(x0)) ++x0;
    while (x0 < x1 && !changed(x1 - 1)) --x1;
    if (x0 < x1) found = found.with({x0, y, x1, y + 1});
  }
  return found;
}

/// The cells of a box, one behind the other.
template <class Value>
std::vector<Value> cut(const std::vector<Value>& tile, int width, const CellBox& box) {
  std::vector<Value> cells;
  cells.reserve(static_cast<std::size_t>(box.width()) * static_cast<std::size_t>(box.height()));
  for (int y = box.y0; y < box.y1; ++y) {
    const auto row = tile.begin() + static_cast<std::ptrdiff_t>(y) * width;
    cells.insert(cells.end(), row + box.x0, row + box.x1);
  }
  return cells;
}

/// Leaves the cells that changed, without a branch for each. Returns the mask of them; empty if all did.
template <class Value>
std::vector<std::uint8_t> keep_changed(std::vector<Value>& cells, Value unchanged) {
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

/// Two in each byte, the first in its high half.
std::vector<std::int8_t> in_pairs(std::vector<std::int8_t> changes) {
  const std::size_t bytes = change_bytes(changes.size(), 4);
  changes.resize(2 * bytes, 0);
  for (std::size_t n = 0; n < bytes; ++n)
    changes[n] = static_cast<std::int8_t>(changes[2 * n] * 16 | (changes[2 * n + 1] & 15));
  changes.resize(bytes);
  return changes;
}

}  // namespace

ElevationTile tile_message(const TileChange& change) {
  const CellBox box = changed_cells(change);
  ElevationTile tile;
  tile.x = static_cast<std::uint32_t>(change.x + box.x0);
  tile.y = static_cast<std::uint32_t>(change.y + box.y0);
  tile.width = static_cast<std::uint32_t>(box.width());
  tile.height = static_cast<std::uint32_t>(box.height());
  tile.bits = static_cast<std::uint8_t>(change.bits);
  tile.resolution = change.resolution;
  if (change.bits == 0) {
    tile.data = cut(change.elevations, change.width, box);
    tile.changed = keep_changed(tile.data, held_elevation::no_elevation);
    return tile;
  }
  std::vector<std::int8_t> steps = cut(change.steps, change.width, box);
  tile.changed = keep_changed(steps, held_elevation::no_step);
  tile.changes = change.bits == 4 ? in_pairs(std::move(steps)) : std::move(steps);
  return tile;
}

}  // namespace desert_sim
