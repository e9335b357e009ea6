#include "desert_sim/ros/elevation_tiles.hpp"

#include "desert_sim/client/elevation_tile.hpp"
#include "desert_sim/ros/cell_box.hpp"

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
  const std::size_t count = static_cast<std::size_t>(tile.width) * tile.height;
  tile.changed.resize(mask_bytes(count), 0);
  std::size_t cell = 0, changed = 0;
  for (int y = box.y0; y < box.y1; ++y)
    for (int x = box.x0; x < box.x1; ++x, ++cell) {
      const std::size_t i =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(change.width) + static_cast<std::size_t>(x);
      if (!change.changed(i)) continue;
      mask_add(tile.changed, cell);
      if (change.bits)
        change_add(tile.changes, change.bits, changed, change.steps[i]);
      else
        tile.data.push_back(change.elevations[i]);
      ++changed;
    }
  if (changed == count) tile.changed.clear();
  return tile;
}

}  // namespace desert_sim
