#pragma once
/// Tiles of a grid, packed one after another in a buffer, so that only tiles in which something changed are
/// copied to the host.

#include <cstddef>
#include <cstdint>

#include "kernels/backend/for_each.hpp"

namespace desert_sim::packed_tiles {

/// Header of the buffer: size of all tiles [bytes], without this header.
struct PackHeader {
  unsigned long long bytes = 0, reserved = 0;
};
/// Header of a tile. Its cells follow, row-major.
struct TileHeader {
  std::int32_t tile = 0;    ///< number of the tile, row-major
  std::uint32_t units = 0;  ///< size with this header [pack_unit]
  std::int32_t bits = 0;    ///< bits of a step; 0: cells are values, not steps
  float resolution = 0;     ///< size of a step, in the values' unit
};

constexpr std::size_t pack_unit = sizeof(TileHeader);
static_assert(sizeof(PackHeader) == pack_unit, "what lies in a pack lies at multiples of this");
/// Size of a tile with its header, whose cells take `bytes_of_cells` bytes [pack_unit].
DESERT_HD constexpr std::size_t packed_units(std::size_t bytes_of_cells) {
  return 1 + (bytes_of_cells + pack_unit - 1) / pack_unit;
}

/// Upper bound of the size of `tiles` tiles with `cells` cells in all, with all headers [bytes].
constexpr std::size_t max_packed_bytes(std::size_t tiles, std::size_t cells, std::size_t bytes_of_cell) {
  return sizeof(PackHeader) + tiles * (2 * pack_unit) + cells * bytes_of_cell;
}

/// Tiles of at most side × side cells over rows of a grid, the first one in its south-west corner.
struct Tiling {
  Grid grid;
  int side = 1;
  int first_row = 0, row_count = 0;  ///< rows of tiles

  DESERT_HD int tiles_along(int cells) const { return (cells - 1) / side + 1; }
  DESERT_HD int columns() const { return tiles_along(grid.width); }
  DESERT_HD int rows() const { return row_count; }
  DESERT_HD int count() const { return columns() * rows(); }
  DESERT_HD int width(int column) const { return clipped_side(grid.width - column * side); }
  DESERT_HD int height(int row) const { return clipped_side(grid.height - row * side); }
  DESERT_HD int clipped_side(int cells) const { return cells < side ? cells : side; }
};

/// The tiling of a whole grid.
inline Tiling tiling(const Grid& grid, int side) {
  Tiling all{grid, side, 0, 0};
  all.row_count = all.tiles_along(grid.height);
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

/// The part of Law::scratch_bytes that reserve_tile() needs.
constexpr int scratch_bytes = sizeof(unsigned long long);

/// Reserves room in the buffer for a tile whose cells take `bytes_of_cells` bytes, and returns where they go.
/// Tiles lie in the order of these calls.
template <class Team>
DESERT_HD char* reserve_tile(const Team& team, char* pack, TileHeader head, std::size_t bytes_of_cells) {
  auto* const place = reinterpret_cast<unsigned long long*>(team.scratch);
  head.units = static_cast<std::uint32_t>(packed_units(bytes_of_cells));
  team.for_each(1, [&](int) {
    auto* const used = &reinterpret_cast<PackHeader*>(pack)->bytes;
    *place = atomic_add(used, static_cast<unsigned long long>(head.units) * pack_unit);
    *reinterpret_cast<TileHeader*>(pack + sizeof(PackHeader) + *place) = head;
  });
  return pack + sizeof(PackHeader) + *place + sizeof(TileHeader);
}

}  // namespace desert_sim::packed_tiles
