#include "src/simulation/views/layer_changes.hpp"

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
    const auto* values = reinterpret_cast<const float*>(packed.cells);
    tile.values.assign(values, values + place.cells());
  }
  return tile;
}

}  // namespace

std::vector<TileChange> unpacked_changes(Staging::Slot& slot, const packed_tiles::Tiling& tiles) {
  std::vector<TileChange> changes;
  for (const PackedTile& tile : packed_tiles_in(slot, tiles)) changes.push_back(unpacked(tile));
  return changes;
}

PendingChanges Views::begin_changes(const HeldQueries& queries) {
  using Hold = HeldQuery::Hold;
  const auto takes_present = [this](Layer layer, Hold hold) {
    return hold == Hold::present || (hold == Hold::present_if_none && !holds(layer));
  };
  std::vector<Layer> needed;
  for (const auto& [layer, query] : queries)
    if ((query.changes && holds(layer)) || takes_present(layer, query.hold)) needed.push_back(layer);
  update_layers(needed, {0, state_.terrain.grid().height});
  PendingChanges changes;
  for (const auto& [layer, query] : queries) {
    if (query.changes && holds(layer)) changes[layer] = send_changes(layer, query);
    if (takes_present(layer, query.hold)) hold(layer);
    if (query.hold == Hold::none) forget(layer);
  }
  return changes;
}

/// The layer must be up to date.
void Views::hold(Layer layer) {
  Buffer<float>& held = held_[layer];
  if (!held) held = Buffer<float>(state_.exec(), static_cast<std::size_t>(state_.terrain.grid().cells()));
  with_backend(state_.exec(), [&](auto& e) {
    held_layer::set_held(e, state_.terrain.view(), layer, state_.terrain.metres(layer), held.data());
  });
}

/// The layer must be up to date, and held.
Pending<LayerChanges> Views::send_changes(Layer layer, const HeldQuery& query) {
  auto changes = std::make_shared<LayerChanges>();
  auto readback = std::make_shared<Readback>();
  TileTransfer transfer;
  transfer.tiles = packed_tiles::tiling(state_.terrain.grid(), query.tile);
  transfer.bytes_of_cell = sizeof(float);
  transfer.pack = [&](const packed_tiles::Tiling& rows, char* to) {
    with_backend(state_.exec(), [&](auto& e) {
      held_layer::pack_changes(e, state_.terrain.view(), layer, state_.terrain.metres(layer), rows,
                               query.tolerance, held_[layer].data(), to);
    });
  };
  transfer.unpack = [waited = std::weak_ptr<LayerChanges>(changes)](Staging::Slot& arrived,
                                                                    const packed_tiles::Tiling& rows) {
    const std::shared_ptr<LayerChanges> all = waited.lock();
    if (!all) return;
    for (TileChange& changed : unpacked_changes(arrived, rows)) all->tiles.push_back(std::move(changed));
  };
  send_tiles(staging_, transfer, readback);
  return {changes, readback};
}

}  // namespace desert_sim
