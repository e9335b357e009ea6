#include "src/rviz/terrain_source.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>

#include "src/rviz/map_windows.hpp"
#include "src/rviz/names.hpp"

namespace desert_sim {

namespace {

using render::CellRectangle;

/// The smallest rectangle of these cells that has all differences between two maps; NaN equals NaN.
CellRectangle difference(const LayerMap& a, const LayerMap& b, const CellRectangle& cells) {
  const std::vector<float> before = values_in(a, cells), after = values_in(b, cells);
  const auto same = [&](int x, int y) {
    const auto n =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(cells.width) + static_cast<std::size_t>(x);
    return before[n] == after[n] || (std::isnan(before[n]) && std::isnan(after[n]));
  };
  CellRectangle changed;
  if (std::memcmp(before.data(), after.data(), before.size() * sizeof(float)) == 0) return changed;
  for (int y = 0; y < cells.height; ++y) {
    int first = 0, last = cells.width - 1;
    while (first < cells.width && same(first, y)) ++first;
    if (first == cells.width) continue;
    while (same(last, y)) --last;
    changed.include({cells.x + first, cells.y + y, last - first + 1, 1});
  }
  return changed;
}

/// The tiles of a grid, row-major; those at the north and east edges can be smaller.
struct Tiles {
  int width, height, columns, rows;

  explicit Tiles(const LayerMap::Info& info)
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
  const LayerMap& map = *change.map;
  std::shared_ptr<const LayerMap>& last = last_[map.info().layer];
  const Tiles tiles(map.info());
  const bool replaced = change.replaced || !last || !map.same_geometry(*last);
  std::vector<CellRectangle> changed(static_cast<std::size_t>(tiles.columns) *
                                     static_cast<std::size_t>(tiles.rows));
  const CellRectangle rectangle{static_cast<int>(change.cells.x), static_cast<int>(change.cells.y),
                                static_cast<int>(change.cells.width), static_cast<int>(change.cells.height)};
  for (int row = 0; row < tiles.rows && !replaced; ++row)
    for (int column = 0; column < tiles.columns; ++column) {
      const CellRectangle cells = tiles.cells(column, row).clipped(rectangle);
      if (!cells.empty())
        changed[static_cast<std::size_t>(row * tiles.columns + column)] = difference(*last, map, cells);
    }
  last = change.map;
  const std::lock_guard<std::mutex> lock(mutex_);
  Pending& pending = pending_[map.info().layer];
  pending.change.map = change.map;
  ++pending.change.messages;
  pending.change.replaced = pending.change.replaced || replaced;
  pending.tiles.resize(changed.size());  // where the size is another one, all counts as changed anyway
  for (std::size_t n = 0; n < changed.size(); ++n) pending.tiles[n].include(changed[n]);
}

std::vector<CollectedChange> PendingChanges::take() {
  std::map<std::string, Pending> taken;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::swap(taken, pending_);
  }
  std::vector<CollectedChange> changes;
  for (auto& [layer, pending] : taken) {
    CollectedChange& change = pending.change;
    const Tiles tiles(change.map->info());
    std::copy_if(pending.tiles.begin(), pending.tiles.end(), std::back_inserter(change.changed),
                 [](const CellRectangle& cells) { return !cells.empty(); });
    if (change.replaced) change.changed = {{0, 0, tiles.width, tiles.height}};
    changes.insert(layer == "elevation" ? changes.begin() : changes.end(), std::move(change));
  }
  return changes;
}

TerrainSource::TerrainSource(const std::string& elevation_topic) {
  TerrainClient::Options options;
  options.elevation_topic = full_name(elevation_topic, "topic");
  options.updates_topic = options.elevation_topic + "_updates";
  options.node = node_ = options.elevation_topic.substr(0, options.elevation_topic.rfind('/'));
  options.layers.clear();  // later ones are subscribed to by the client's own thread, for which nobody waits
  options.on_change = [this](const MapChange& change) { changes_.add(change); };
  client_ = std::make_unique<TerrainClient>(ros::NodeHandle(), options);
}

bool TerrainSource::is_known(const std::string& layer) {
  const std::vector<std::string>& known = TerrainClient::known_layers();
  return std::find(known.begin(), known.end(), layer) != known.end();
}

void TerrainSource::set_layers(const std::vector<std::string>& layers) {
  for (const std::string& layer : client_->layers())
    if (std::find(layers.begin(), layers.end(), layer) == layers.end()) client_->unsubscribe_layer(layer);
  for (const std::string& layer : layers)
    if (is_known(layer)) client_->subscribe_layer(layer);
}

}  // namespace desert_sim
