#include "src/simulation/views/cost_changes.hpp"

#include <algorithm>

#include "kernels/field/surface.hpp"
#include "src/simulation/views/tile_transfer.hpp"
#include "src/simulation/views/view_sections.hpp"
#include "src/simulation/views/views.hpp"

namespace desert_sim {

using packed_tiles::Tiling;

constexpr int tile_side = 32;

std::vector<CellBox> CostChanges::write_to(std::vector<std::int8_t>& held, int width) const {
  std::vector<CellBox> changed;
  for (const Tile& tile : tiles) {
    CellBox differs;
    auto from = tile.costs.begin();
    for (int y = tile.cells.y0; y < tile.cells.y1; ++y)
      for (int x = tile.cells.x0; x < tile.cells.x1; ++x, ++from) {
        std::int8_t& to =
            held[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
        if (to != *from) differs = differs.united_with({x, y, x + 1, y + 1});
        to = *from;
      }
    if (!differs.empty()) changed.push_back(differs);
  }
  return changed;
}

HeldCosts::HeldCosts(Exec& exec, const Grid& grid)
    : grid_(grid), now_(exec, static_cast<std::size_t>(grid.cells())), held_(exec, now_.size()) {
  held_.upload(std::vector<std::int8_t>(held_.size(), held_costs::no_cost));
}

PendingCosts HeldCosts::begin_copy(Exec& exec, Staging& staging, const CostQuery& query) {
  PendingCosts pending;
  if (query.update && complete_) pending.update = copy_tiles(exec, staging, query.threshold);
  if (query.whole || !complete_) pending.whole = copy_tiles(exec, staging, 0);
  complete_ = true;
  return pending;
}

Pending<CostChanges> HeldCosts::copy_tiles(Exec& exec, Staging& staging, int threshold) {
  auto changes = std::make_shared<CostChanges>();
  auto readback = std::make_shared<Readback>();
  TileTransfer transfer;
  transfer.tiles = packed_tiles::tiling(grid_, tile_side);
  transfer.pack = [&](const Tiling& rows, char* to) {
    with_backend(exec,
                 [&](auto& e) { held_costs::copy_tiles(e, rows, now_.data(), held_.data(), threshold, to); });
  };
  transfer.unpack = [waited = std::weak_ptr<CostChanges>(changes)](Staging::Slot& arrived,
                                                                   const Tiling& rows) {
    const std::shared_ptr<CostChanges> all = waited.lock();
    if (!all) return;
    for (const PackedTile& tile : packed_tiles_in(arrived, rows)) {
      const packed_tiles::TileOfGrid& at = tile.place;
      const auto* costs = reinterpret_cast<const std::int8_t*>(tile.cells);
      all->tiles.push_back(
          {{at.x0, at.y0, at.x0 + at.width, at.y0 + at.height}, {costs, costs + at.cells()}});
    }
  };
  send_tiles(staging, transfer, readback);
  return {changes, readback};
}

PendingCosts Views::begin_costs(const CostQuery& query) {
  if (!query.update && !query.whole) return {};
  if (!costs_) costs_ = HeldCosts(state_.exec(), state_.terrain.grid());
  with_backend(state_.exec(), [&](auto& e) {
    surface::fill_elevation(e, state_.terrain.view());
    held_costs::compute_costs(e, state_.terrain.view(), rover_of(state_.scenario), costs_.now());
  });
  return costs_.begin_copy(state_.exec(), staging_, query);
}

}  // namespace desert_sim
