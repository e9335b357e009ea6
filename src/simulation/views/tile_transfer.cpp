#include "src/simulation/views/tile_transfer.hpp"

#include <algorithm>
#include <cstring>

namespace desert_sim {

using namespace packed_tiles;

namespace {

/// Copied before anybody knows how much there is; takes a few microseconds.
constexpr std::size_t initial_bytes = std::size_t{256} << 10;
/// Of tiles at a time: a GPU takes no more.
constexpr std::size_t max_rows = 65535;

template <class T>
T read(const char* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

/// At most, of some rows of tiles.
std::size_t bytes_of(const TileTransfer& transfer, const Tiling& rows) {
  const int south = rows.first_row * rows.side;
  const long long north =
      std::min<long long>(rows.grid.height, south + static_cast<long long>(rows.row_count) * rows.side);
  const auto cells = static_cast<std::size_t>(rows.grid.width) * static_cast<std::size_t>(north - south);
  return max_packed_bytes(static_cast<std::size_t>(rows.count()), cells, transfer.bytes_of_cell);
}

}  // namespace

void send_tiles(Staging& staging, const TileTransfer& transfer, const std::shared_ptr<Readback>& readback) {
  const Tiling& all = transfer.tiles;
  const std::size_t row_bytes = bytes_of(transfer, {all.grid, all.side, 0, 1});
  const int most = static_cast<int>(std::clamp<std::size_t>(staging.slot_bytes() / row_bytes, 1, max_rows));
  for (int row = 0; row < all.row_count; row += most) {
    const Tiling rows{all.grid, all.side, row, std::min(most, all.row_count - row)};
    const std::size_t bytes = bytes_of(transfer, rows);
    Staging::Slot& slot = staging.acquire(bytes);
    transfer.pack(rows, slot.device());
    staging.send(slot, std::min(bytes, initial_bytes), readback,
                 [unpack = transfer.unpack, rows](Staging::Slot& arrived) { unpack(arrived, rows); });
  }
}

std::vector<PackedTile> packed_tiles_in(Staging::Slot& slot, const Tiling& tiles) {
  constexpr std::size_t start = sizeof(PackHeader);
  const auto packed = read<PackHeader>(slot.host(start));
  const char* at = slot.host(start + packed.bytes) + start;
  std::vector<PackedTile> found;
  for (const char* const end = at + packed.bytes; at < end;) {
    const auto head = read<TileHeader>(at);
    const TileOfGrid place(tiles, head.tile % tiles.columns(), head.tile / tiles.columns());
    found.push_back({head, place, at + sizeof(TileHeader)});
    at += head.units * pack_unit;
  }
  // They lie in the order in which they happened to be done.
  std::sort(found.begin(), found.end(),
            [](const PackedTile& a, const PackedTile& b) { return a.head.tile < b.head.tile; });
  return found;
}

}  // namespace desert_sim
