#include "src/rviz/terrain_source.hpp"

#include <cstring>

namespace desert_sim {

namespace {

using render::CellRectangle;

std::vector<float> values(const ElevationMap& map, const CellRectangle& r) {
  return map.elevations({static_cast<std::uint32_t>(r.x), static_cast<std::uint32_t>(r.y),
                         static_cast<std::uint32_t>(r.width), static_cast<std::uint32_t>(r.height)});
}

/// Bit by bit, so that NaN equals NaN.
bool differ(const ElevationMap& a, const ElevationMap& b, const CellRectangle& cells) {
  const std::vector<float> before = values(a, cells), after = values(b, cells);
  return std::memcmp(before.data(), after.data(), before.size() * sizeof(float)) != 0;
}

/// The tiles of a grid, row-major; those at the north and east edges can be smaller.
struct Tiles {
  int width, height, columns, rows;

  explicit Tiles(const ElevationMap::Info& info)
      : width(static_cast<int>(info.width)),
        height(static_cast<int>(info.height)),
        columns((width + PendingChanges::tile_side - 1) / PendingChanges::tile_side),
        rows((height + PendingChanges::tile_side - 1) / PendingChanges::tile_side) {}
  CellRectangle cells(int column, int row) const {
    constexpr int side = PendingChanges::tile_side;
    return CellRectangle{column * side, row * side, side, side}.clipped({0, 0, width, height});
  }
};

}  // namespace

void PendingChanges::add(const MapChange& change) {
  const ElevationMap& map = *change.map;
  const Tiles tiles(map.info());
  const bool replaced = change.replaced || !last_ || !map.same_geometry(*last_);
  std::vector<char> changed(static_cast<std::size_t>(tiles.columns) * static_cast<std::size_t>(tiles.rows),
                            0);
  const CellRectangle rectangle{static_cast<int>(change.cells.x), static_cast<int>(change.cells.y),
                                static_cast<int>(change.cells.width), static_cast<int>(change.cells.height)};
  for (int row = 0; row < tiles.rows && !replaced; ++row)
    for (int column = 0; column < tiles.columns; ++column) {
      const CellRectangle cells = tiles.cells(column, row).clipped(rectangle);
      if (!cells.empty() && differ(*last_, map, cells))
        changed[static_cast<std::size_t>(row * tiles.columns + column)] = 1;
    }
  last_ = change.map;
  const std::lock_guard<std::mutex> lock(mutex_);
  pending_.map = change.map;
  ++pending_.messages;
  pending_.replaced = pending_.replaced || replaced;
  if (replaced || tiles_.size() != changed.size()) {
    tiles_ = std::move(changed);
  } else {
    for (std::size_t n = 0; n < changed.size(); ++n) tiles_[n] |= changed[n];
  }
}

TerrainChange PendingChanges::take() {
  TerrainChange taken;
  std::vector<char> changed;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::swap(taken, pending_);
    std::swap(changed, tiles_);
  }
  if (!taken.map) return taken;
  const Tiles tiles(taken.map->info());
  if (taken.replaced) {
    taken.changed = {{0, 0, tiles.width, tiles.height}};
    return taken;
  }
  for (int row = 0; row < tiles.rows; ++row)
    for (int column = 0; column < tiles.columns; ++column)
      if (changed[static_cast<std::size_t>(row * tiles.columns + column)])
        taken.changed.push_back(tiles.cells(column, row));
  return taken;
}

std::string node_of_topic(const std::string& elevation_topic) {
  const std::size_t slash = elevation_topic.rfind('/');
  return slash == std::string::npos || slash == 0 ? "" : elevation_topic.substr(0, slash);
}

TerrainSource::TerrainSource(const std::string& elevation_topic) {
  TerrainClient::Options options;
  options.node = node_of_topic(elevation_topic);
  options.elevation_topic = elevation_topic;
  options.updates_topic = elevation_topic + "_updates";
  options.on_change = [this](const MapChange& change) { changes_.add(change); };
  client_ = std::make_unique<TerrainClient>(ros::NodeHandle(), options);
}

}  // namespace desert_sim
