#include "src/simulation/views/elevation_changes.hpp"

#include "src/core/error.hpp"
#include "src/simulation/views/tile_transfer.hpp"
#include "src/simulation/views/views.hpp"

namespace desert_sim {

namespace {

TileChange unpacked(const PackedTile& packed) {
  const packed_tiles::TileOfGrid& place = packed.place;
  TileChange tile;
  tile.x = place.x0;
  tile.y = place.y0;
  tile.width = place.width;
  tile.height = place.height;
  tile.bits = packed.head.bits;
  tile.resolution = packed.head.resolution;
  if (tile.bits) {
    const auto* steps = reinterpret_cast<const std::int8_t*>(packed.cells);
    tile.steps.assign(steps, steps + place.cells());
  } else {
    const auto* elevations = reinterpret_cast<const float*>(packed.cells);
    tile.elevations.assign(elevations, elevations + place.cells());
  }
  return tile;
}

}  // namespace

std::vector<TileChange> unpacked_changes(Staging::Slot& slot, const packed_tiles::Tiling& tiles) {
  std::vector<TileChange> changes;
  for (const PackedTile& tile : packed_tiles_in(slot, tiles)) changes.push_back(unpacked(tile));
  return changes;
}

void Views::hold_elevation() {
  if (!held_elevation_)
    held_elevation_ = Buffer<float>(state_.exec(), static_cast<std::size_t>(state_.terrain.grid().cells()));
  with_backend(state_.exec(), [this](auto& e) {
    held_elevation::set_held(e, state_.terrain.view(), state_.terrain.metres(Layer::elevation),
                             held_elevation_.data());
  });
}

Pending<ElevationChanges> Views::begin_elevation_changes(double threshold, int tile) {
  if (!held_elevation_)
    throw StateError("changes of the elevation were requested, but no held elevation exists");
  auto changes = std::make_shared<ElevationChanges>();
  auto readback = std::make_shared<Readback>();
  TileTransfer transfer;
  transfer.tiles = packed_tiles::tiling(state_.terrain.grid(), tile);
  transfer.bytes_of_cell = sizeof(float);
  transfer.pack = [&](const packed_tiles::Tiling& rows, char* to) {
    with_backend(state_.exec(), [&](auto& e) {
      held_elevation::pack_changes(e, state_.terrain.view(), state_.terrain.metres(Layer::elevation), rows,
                                   static_cast<float>(threshold), held_elevation_.data(), to);
    });
  };
  transfer.unpack = [waited = std::weak_ptr<ElevationChanges>(changes)](Staging::Slot& arrived,
                                                                        const packed_tiles::Tiling& rows) {
    const std::shared_ptr<ElevationChanges> all = waited.lock();
    if (!all) return;
    for (TileChange& changed : unpacked_changes(arrived, rows)) all->tiles.push_back(std::move(changed));
  };
  send_tiles(staging_, transfer, readback);
  return {changes, readback};
}

}  // namespace desert_sim
