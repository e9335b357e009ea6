#pragma once
/// Tiles of a grid, packed one behind the other: of what others hold, only those need to go to the host in
/// which something changed.

#include <cstddef>
#include <cstdint>

#include "kernels/backend/for_each.hpp"

namespace desert_sim::packed_tiles {

/// Before the tiles: bytes of all of them, without this.
struct PackedHead {
  unsigned long long bytes = 0, reserved = 0;
};
/// Before the cells of a tile, which are row-major.
struct TileHead {
  std::int32_t tile = 0;    ///< its number, row-major
  std::uint32_t units = 0;  ///< that it takes, with this
  std::int32_t bits = 0;    ///< of cells that are steps, how many tell them; 0: cells are values
  float resolution = 0;     ///< of a step, in the values' unit
};

constexpr std::size_t pack_unit = sizeof(TileHead);
static_assert(sizeof(PackedHead) == pack_unit, "what lies in a pack lies at multiples of this");
/// Of a tile whose cells take so many bytes.
DESERT_HD constexpr std::size_t packed_units(std::size_t bytes_of_cells) {
  return 1 + (bytes_of_cells + pack_unit - 1) / pack_unit;
}

/// What tiles of so many cells in all take at most, with what stands before them [bytes].
constexpr std::size_t most_packed(std::size_t tiles, std::size_t cells, std::size_t bytes_of_cell) {
  return sizeof(PackedHead) + tiles * (2 * pack_unit) + cells * bytes_of_cell;
}

/// Tiles of at most side × side cells over rows of a grid, the first one in its south-west corner.
struct Tiling {
  Grid grid;
  int side = 1;
  int first_row = 0, row_count = 0;  ///< of tiles

  DESERT_HD int across(int cells) const { return (cells - 1) / side + 1; }
  DESERT_HD int columns() const { return across(grid.width); }
  DESERT_HD int rows() const { return row_count; }
  DESERT_HD int count() const { return columns() * rows(); }
  DESERT_HD int width(int column) const { return least(grid.width - column * side); }
  DESERT_HD int height(int row) const { return least(grid.height - row * side); }
  DESERT_HD int least(int cells) const { return cells < side ? cells : side; }
};

/// All of a grid.
inline Tiling tiling(const Grid& grid, int side) {
  Tiling all{grid, side, 0, 0};
  all.row_count = all.across(grid.height);
  return all;
}

/// A tile of a tiling and its place on the grid. `row` counts from the grid's first row of tiles.
struct TileOfGrid {
  int number, first, pitch, x0, y0, width, height;

  DESERT_HD TileOfGrid(const Tiling& tiles, int column, int row)
      : number(row * tiles.columns() + column),
        first(tiles.grid.index(column * tiles.side, row * tiles.side)),
        pitch(tiles.grid.width),
        x0(column * tiles.side),
        y0(row * tiles.side),
        width(tiles.width(column)),
        height(tiles.height(row)) {}
  DESERT_HD int index(int x, int y) const { return first + y * pitch + x; }
  DESERT_HD std::size_t cells() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
};

/// Of Law::scratch_bytes, what begin_tile() needs.
constexpr int scratch_bytes = sizeof(unsigned long long);

/// Makes room in the pack for a tile whose cells take so many bytes. Tiles lie in the order in which they
/// come to this. Returns where the cells go.
template <class Team>
DESERT_HD char* begin_tile(const Team& team, char* pack, TileHead head, std::size_t bytes_of_cells) {
  auto* const place = reinterpret_cast<unsigned long long*>(team.scratch);
  head.units = static_cast<std::uint32_t>(packed_units(bytes_of_cells));
  team.for_each(1, [&](int) {
    auto* const used = &reinterpret_cast<PackedHead*>(pack)->bytes;
    *place = atomic_add(used, static_cast<unsigned long long>(head.units) * pack_unit);
    *reinterpret_cast<TileHead*>(pack + sizeof(PackedHead) + *place) = head;
  });
  return pack + sizeof(PackedHead) + *place + sizeof(TileHead);
}

}  // namespace desert_sim::packed_tiles
