#pragma once
/// What others hold of the surface, and what they lack: cells are compared with what is held, tile by tile,
/// and tiles that changed are packed one behind the other, so that only they need to go to the host.
/// Reads elevation; writes what is held.

#include <cstdint>

#include "desert_sim/kernels/elevation_step.hpp"
#include "desert_sim/kernels/for_each.hpp"
#include "desert_sim/kernels/layer_values.hpp"
#include "desert_sim/kernels/math.hpp"

namespace desert_sim::held_elevation {

/// Before the tiles: bytes of all of them, without this.
struct PackedHead {
  unsigned long long bytes = 0, reserved = 0;
};
/// Before the cells of a tile, which are row-major: steps (int8) of `resolution`, of what so many bits tell;
/// or elevations (float [m]) if `bits` is 0.
struct TileHead {
  std::int32_t tile = 0;  ///< its number, row-major
  std::int32_t bits = 0;  ///< 0, 4 or 8
  float resolution = 0;   ///< [m]
  std::int32_t reserved = 0;
};
/// In the place of a cell that did not change: no step is so long, and no elevation is infinite.
constexpr std::int8_t no_step = -128;
constexpr float no_elevation = -HUGE_VALF;

constexpr std::size_t pack_unit = sizeof(TileHead);
static_assert(sizeof(PackedHead) == pack_unit, "what lies in a pack lies at multiples of this");
/// What a tile takes in a pack.
DESERT_HD constexpr std::size_t packed_bytes(std::size_t cells, int bits) {
  const std::size_t payload = bits == 0 ? cells * sizeof(float) : cells;
  return pack_unit + (payload + pack_unit - 1) / pack_unit * pack_unit;
}

/// What tiles of so many cells in all take at most, with what stands before them.
constexpr std::size_t most_packed(std::size_t tiles, std::size_t cells) {
  return sizeof(PackedHead) + tiles * (2 * pack_unit) + cells * sizeof(float);
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

struct Surface {
  const Quanta* elevation;
  Metres metres;
  DESERT_HD float operator()(int i) const { return metres(elevation[i]); }
};

struct Hold {
  Grid grid;
  Surface now;
  float* held;
  DESERT_HD void operator()(int x, int y) const { held[grid.index(x, y)] = now(grid.index(x, y)); }
};

/// |v| ≤ 2³⁰, halves go away from zero.
DESERT_HD int nearest(float v) {
  const int whole = static_cast<int>(v);
  const float rest = v - static_cast<float>(whole);
  return whole + (rest >= 0.5f ? 1 : 0) - (rest <= -0.5f ? 1 : 0);
}

/// Of a tile in which a cell is off by more than the threshold: packs the cells that are, after which they
/// are held: as steps, the error of which is within the threshold, or as elevations, where steps in eight
/// bits would be too coarse.
struct TakeChanges {
  Tiling tiles;
  Surface now;
  float* held;
  float threshold;
  char* pack;

  template <class Team>
  static constexpr int scratch_bytes = sizeof(unsigned long long);

  /// Half a step is the largest error; a little less than the threshold, so that rounding does not exceed it.
  DESERT_HD bool tells(int bits, float largest) const {
    const float step = largest / static_cast<float>(most_steps(bits));
    return step > 0.0f && step <= 1.99f * threshold;
  }

  template <class Team>
  DESERT_HD void operator()(const Team& team, int column, int row_of_band) const {
    const int row = tiles.first_row + row_of_band;
    const Part part{*this, column, row};
    // Floats that are not negative order like their bits: minus the bits of the largest change.
    const int least = team.lowest(part.width, part.height, [part](int x, int y) DESERT_INLINE {
      const float change = fabsf(part.change(part.index(x, y)));
      return change > part.threshold ? -static_cast<int>(bits_of(change)) : 0;
    });
    if (least == 0) return;
    TileHead head;
    const float largest = float_of(static_cast<std::uint32_t>(-least));
    head.tile = row * tiles.columns() + column;
    head.bits = tells(4, largest) ? 4 : (tells(8, largest) ? 8 : 0);
    head.resolution = head.bits ? largest / static_cast<float>(most_steps(head.bits)) : 0.0f;
    char* const cells = begin_tile(team, head, static_cast<std::size_t>(part.width) * part.height);
    if (head.bits == 0)
      write_elevations(team, part, reinterpret_cast<float*>(cells));
    else
      write_steps(team, part, head, reinterpret_cast<std::int8_t*>(cells));
  }

 private:
  /// A tile and what its cells need, by value: the compiler then knows that nothing of it changes while
  /// cells are written. No branches either, so that it can make vectors of them.
  struct Part {
    Surface now;
    float* held;
    float threshold;
    int first, pitch, width, height;

    DESERT_HD Part(const TakeChanges& law, int column, int row)
        : now(law.now),
          held(law.held),
          threshold(law.threshold),
          first(law.tiles.grid.index(column * law.tiles.side, row * law.tiles.side)),
          pitch(law.tiles.grid.width),
          width(law.tiles.width(column)),
          height(law.tiles.height(row)) {}
    DESERT_HD int index(int x, int y) const { return first + y * pitch + x; }
    DESERT_HD float change(int i) const { return now(i) - held[i]; }
  };

  template <class Team>
  DESERT_HD void write_elevations(const Team& team, const Part& part, float* to) const {
    team.for_each(part.width, part.height, [part, to](int x, int y) DESERT_INLINE {
      const int i = part.index(x, y);
      const float before = part.held[i], after = part.now(i);
      const bool changed = fabsf(after - before) > part.threshold;
      part.held[i] = changed ? after : before;
      to[y * part.width + x] = changed ? after : float{no_elevation};
    });
  }

  template <class Team>
  DESERT_HD void write_steps(const Team& team, const Part& part, const TileHead& head,
                             std::int8_t* to) const {
    const int most = most_steps(head.bits);
    const float resolution = head.resolution;
    team.for_each(part.width, part.height, [part, most, resolution, to](int x, int y) DESERT_INLINE {
      const int i = part.index(x, y);
      const float before = part.held[i], change = part.change(i);
      const bool changed = fabsf(change) > part.threshold;
      const int steps = nearest(change / resolution), low = steps < -most ? -most : steps;
      const auto step = static_cast<std::int8_t>(low > most ? most : low);
      const float after = changed_elevation(before, step, resolution);
      part.held[i] = changed ? after : before;
      to[y * part.width + x] = changed ? step : std::int8_t{no_step};
    });
  }

  /// Tiles lie in the order in which they come to this. Returns where the tile's cells go.
  template <class Team>
  DESERT_HD char* begin_tile(const Team& team, const TileHead& head, std::size_t cells) const {
    auto* const place = reinterpret_cast<unsigned long long*>(team.scratch);
    team.for_each(1, [&](int) {
      auto* const used = &reinterpret_cast<PackedHead*>(pack)->bytes;
      *place = atomic_add(used, static_cast<unsigned long long>(packed_bytes(cells, head.bits)));
      *reinterpret_cast<TileHead*>(pack + sizeof(PackedHead) + *place) = head;
    });
    return pack + sizeof(PackedHead) + *place + sizeof(TileHead);
  }
};

/// Holds the whole surface.
template <class E>
void hold(E& exec, const TerrainView& t, const Metres& metres, float* held) {
  for_each_cell(exec, t.grid, Hold{t.grid, {t.quanta(Layer::elevation), metres}, held});
}

/// Packs what changed by more than `threshold` [m] ≥ 0 in `tiles`; `pack` has room for most_packed().
template <class E>
void take_changes(E& exec, const TerrainView& t, const Metres& metres, const Tiling& tiles, float threshold,
                  float* held, char* pack) {
  exec.set_zero(pack, sizeof(PackedHead));
  for_each_tile(exec, tiles, TakeChanges{tiles, {t.quanta(Layer::elevation), metres}, held, threshold, pack});
}

}  // namespace desert_sim::held_elevation
