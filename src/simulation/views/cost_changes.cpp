#include "src/simulation/views/cost_changes.hpp"

#include <algorithm>

#include "kernels/field/surface.hpp"
#include "src/simulation/views/tile_transfer.hpp"
#include "src/simulation/views/views.hpp"

namespace desert_sim {

using held_costs::BoundingBox;
using packed_tiles::Tiling;

namespace {

constexpr int tile_side = 32;
static_assert(sizeof(BoundingBox) % packed_tiles::pack_unit == 0, "it stands before the tiles");

/// Adds what has arrived.
void unpack(CostChanges& changes, Staging::Slot& slot, const Tiling& rows, const CellBox& recent,
            bool whole) {
  const auto* found = reinterpret_cast<const BoundingBox*>(slot.host(sizeof(BoundingBox)));
  changes.changed = whole ? recent : found->cells(rows.grid);
  changes.box = changes.changed.empty() ? CellBox{} : changes.changed.united_with(recent);
  for (const PackedTile& tile : packed_tiles_in(slot, rows, sizeof(BoundingBox))) {
    const packed_tiles::TileOfGrid& at = tile.place;
    const auto* costs = reinterpret_cast<const std::int8_t*>(tile.cells);
    changes.tiles.push_back(
        {{at.x0, at.y0, at.x0 + at.width, at.y0 + at.height}, {costs, costs + at.cells()}});
  }
}

}  // namespace

void CostChanges::write_to(std::vector<std::int8_t>& held, int width) const {
  for (const Tile& tile : tiles) {
    auto from = tile.costs.begin();
    for (int y = tile.cells.y0; y < tile.cells.y1; ++y, from += tile.cells.width())
      std::copy_n(from, tile.cells.width(),
                  held.begin() + static_cast<std::ptrdiff_t>(y) * width + tile.cells.x0);
  }
}

HeldCosts::HeldCosts(Exec& exec, const Grid& grid)
    : grid_(grid),
      now_(exec, static_cast<std::size_t>(grid.cells())),
      held_(exec, now_.size()),
      changed_(exec, 1) {
  held_.upload(std::vector<std::int8_t>(held_.size(), held_costs::no_cost));
}

PendingCosts HeldCosts::begin_copy(Exec& exec, Staging& staging, const CostQuery& query) {
  PendingCosts pending;
  if (query.update && complete_) {
    with_backend(exec, [&](auto& e) {
      held_costs::find_changed_box(e, packed_tiles::tiling(grid_, tile_side), now_.data(), held_.data(),
                                   query.threshold, changed_.data());
    });
    pending.update = copy_region(exec, staging, changed_.data(), query.recent);
  }
  if (query.whole || !complete_)
    pending.whole = copy_region(exec, staging, nullptr, {0, 0, grid_.width, grid_.height});
  complete_ = true;
  return pending;
}

/// What changed, with `recent`; `recent` alone if `changed` is null.
Pending<CostChanges> HeldCosts::copy_region(Exec& exec, Staging& staging, const BoundingBox* changed,
                                            const CellBox& recent) {
  auto changes = std::make_shared<CostChanges>();
  auto readback = std::make_shared<Readback>();
  TileTransfer transfer;
  transfer.tiles = packed_tiles::tiling(grid_, tile_side);
  transfer.before = sizeof(BoundingBox);
  transfer.pack = [&](const Tiling& rows, char* to) {
    if (changed) exec.copy(to, changed, sizeof *changed);
    with_backend(exec, [&](auto& e) {
      held_costs::copy_region(e, rows, now_.data(), held_.data(), changed, recent, to + sizeof(BoundingBox));
    });
  };
  transfer.unpack = [waited = std::weak_ptr<CostChanges>(changes), recent, whole = !changed](
                        Staging::Slot& arrived, const Tiling& rows) {
    if (const std::shared_ptr<CostChanges> all = waited.lock()) unpack(*all, arrived, rows, recent, whole);
  };
  send_tiles(staging, transfer, readback);
  return {changes, readback};
}

PendingCosts Views::begin_costs(const CostQuery& query) {
  if (!query.update && !query.whole) return {};
  if (!costs_) costs_ = HeldCosts(state_.exec(), state_.terrain.grid());
  with_backend(state_.exec(), [&](auto& e) {
    surface::fill_elevation(e, state_.terrain.view());
    held_costs::compute_costs(e, state_.terrain.view(), state_.scenario.rover(), costs_.now());
  });
  return costs_.begin_copy(state_.exec(), staging_, query);
}

}  // namespace desert_sim
