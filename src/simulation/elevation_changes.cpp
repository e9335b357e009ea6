#include "desert_sim/simulation/elevation_changes.hpp"

#include <algorithm>
#include <cstring>

#include "desert_sim/core/error.hpp"
#include "desert_sim/simulation/simulation.hpp"

namespace desert_sim {

using namespace held_elevation;

namespace {

/// Copied before anybody knows how much there is; takes a few microseconds.
constexpr std::size_t at_first = std::size_t{256} << 10;
/// Of tiles at a time: a GPU takes no more.
constexpr std::size_t most_rows = 65535;

template <class T>
T read(const char* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

TileChange unpacked(const TileHead& head, const char* cells, const Tiling& tiles) {
  const int column = head.tile % tiles.columns(), row = head.tile / tiles.columns();
  TileChange tile;
  tile.x = column * tiles.side;
  tile.y = row * tiles.side;
  tile.width = tiles.width(column);
  tile.height = tiles.height(row);
  tile.bits = head.bits;
  tile.resolution = head.resolution;
  const std::size_t count = static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height);
  if (head.bits) {
    const auto* steps = reinterpret_cast<const std::int8_t*>(cells);
    tile.steps.assign(steps, steps + count);
  } else {
    const auto* elevations = reinterpret_cast<const float*>(cells);
    tile.elevations.assign(elevations, elevations + count);
  }
  return tile;
}

}  // namespace

std::vector<TileChange> unpacked_changes(Staging::Slot& slot, const Tiling& tiles) {
  const auto packed = read<PackedHead>(slot.host(sizeof(PackedHead)));
  const char* at = slot.host(sizeof(PackedHead) + packed.bytes) + sizeof(PackedHead);
  std::vector<std::pair<TileHead, const char*>> found;
  for (const char* const end = at + packed.bytes; at < end;) {
    const auto head = read<TileHead>(at);
    const std::size_t cells = static_cast<std::size_t>(tiles.width(head.tile % tiles.columns())) *
                              static_cast<std::size_t>(tiles.height(head.tile / tiles.columns()));
    found.emplace_back(head, at + sizeof(TileHead));
    at += packed_bytes(cells, head.bits);
  }
  // They lie in the order in which they happened to be done.
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return a.first.tile < b.first.tile; });
  std::vector<TileChange> changes;
  changes.reserve(found.size());
  for (const auto& [head, cells] : found) changes.push_back(unpacked(head, cells, tiles));
  return changes;
}

void Simulation::hold_elevation() {
  if (!held_) held_ = Buffer<float>(exec(), static_cast<std::size_t>(terrain_.grid().cells()));
  with_backend(exec(), [this](auto& e) {
    surface::fill_elevation(e, terrain_.view());
    held_elevation::hold(e, terrain_.view(), terrain_.metres(Layer::elevation), held_.data());
  });
}

Pending<ElevationChanges> Simulation::take_elevation_changes(double threshold, int tile) {
  if (!held_) throw StateError("changes of the elevation were asked for, but none is held");
  auto changes = std::make_shared<ElevationChanges>();
  auto readback = std::make_shared<Readback>();
  Tiling all{terrain_.grid(), tile, 0, 0};
  all.row_count = all.across(all.grid.height);
  const std::size_t row_bytes =
      most_packed(static_cast<std::size_t>(all.columns()),
                  static_cast<std::size_t>(all.grid.width) * static_cast<std::size_t>(all.height(0)));
  const int most = static_cast<int>(std::clamp<std::size_t>(staging_.slot_bytes() / row_bytes, 1, most_rows));
  with_backend(exec(), [this](auto& e) { surface::fill_elevation(e, terrain_.view()); });
  for (int row = 0; row < all.row_count; row += most)
    send_changes(changes, {all.grid, tile, row, std::min(most, all.row_count - row)},
                 static_cast<float>(threshold), readback);
  return {changes, readback};
}

void Simulation::send_changes(const std::shared_ptr<ElevationChanges>& changes, const Tiling& tiles,
                              float threshold, const std::shared_ptr<Readback>& readback) {
  const std::size_t width = static_cast<std::size_t>(tiles.grid.width),
                    south = static_cast<std::size_t>(tiles.first_row) * static_cast<std::size_t>(tiles.side),
                    north = std::min(static_cast<std::size_t>(tiles.grid.height),
                                     south + static_cast<std::size_t>(tiles.row_count) *
                                                 static_cast<std::size_t>(tiles.side)),
                    bytes = most_packed(static_cast<std::size_t>(tiles.count()), width * (north - south));
  Staging::Slot& slot = staging_.next(bytes);
  with_backend(exec(), [&](auto& e) {
    take_changes(e, terrain_.view(), terrain_.metres(Layer::elevation), tiles, threshold, held_.data(),
                 slot.device());
  });
  staging_.send(slot, std::min(bytes, at_first), readback,
                [waited = std::weak_ptr<ElevationChanges>(changes), tiles](Staging::Slot& arrived) {
                  const std::shared_ptr<ElevationChanges> all = waited.lock();
                  if (!all) return;
                  for (TileChange& tile : unpacked_changes(arrived, tiles))
                    all->tiles.push_back(std::move(tile));
                });
}

}  // namespace desert_sim
