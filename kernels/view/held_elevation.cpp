/// Laws and functions of held_elevation.hpp; compiled once for each backend.
#include "kernels/view/held_elevation.hpp"

#include <cstdint>

#include "kernels/backend/loops.hpp"
#include "kernels/field/math.hpp"
#include "kernels/view/elevation_step.hpp"
#include "kernels/view/layer_values_laws.hpp"
#include "kernels/view/packed_tiles.hpp"

namespace desert_sim::held_elevation {

using packed_tiles::TileHeader;

using packed_tiles::TileOfGrid;

using layer_values::Surface;

struct SetHeld {
  Grid grid;
  Surface now;
  float* held;
  DESERT_HD void operator()(int x, int y) const { held[grid.index(x, y)] = now(grid.index(x, y)); }
};

/// If a cell of a tile is off by more than the threshold, packs all such cells of the tile and updates what
/// is held of them. They are packed as steps, whose error is within the threshold, or as elevations, where
/// steps of eight bits would be too coarse.
struct PackChanges {
  Tiling tiles;
  Surface now;
  float* held;
  float threshold;
  char* pack;

  template <class Team>
  static constexpr int scratch_bytes = packed_tiles::scratch_bytes;

  /// Whether steps of `bits` bits are fine enough. The largest error is half a step, which has to be a little
  /// less than the threshold, so that rounding does not exceed it.
  DESERT_HD bool step_is_fine_enough(int bits, float largest) const {
    const float step = largest / static_cast<float>(max_steps(bits));
    return step > 0.0f && step <= 1.99f * threshold;
  }

  template <class Team>
  DESERT_HD void operator()(const Team& team, int column, int row_of_band) const {
    const HeldTile tile{*this, {tiles, column, tiles.first_row + row_of_band}};
    // Floats that are not negative compare like their bits. This is minus the bits of the largest change.
    const int least = team.min_of(tile.width, tile.height, [tile](int x, int y) DESERT_INLINE {
      const float change = fabsf(tile.change(tile.index(x, y)));
      return change > tile.threshold ? -static_cast<int>(bits_of(change)) : 0;
    });
    if (least == 0) return;
    TileHeader head;
    const float largest = float_from_bits(static_cast<std::uint32_t>(-least));
    head.tile = tile.number;
    head.bits = step_is_fine_enough(4, largest) ? 4 : (step_is_fine_enough(8, largest) ? 8 : 0);
    head.resolution = head.bits ? largest / static_cast<float>(max_steps(head.bits)) : 0.0f;
    const std::size_t bytes = tile.cells() * (head.bits == 0 ? sizeof(float) : 1);
    char* const cells = packed_tiles::reserve_tile(team, pack, head, bytes);
    if (head.bits == 0)
      write_elevations(team, tile, reinterpret_cast<float*>(cells));
    else
      write_steps(team, tile, head, reinterpret_cast<std::int8_t*>(cells));
  }

 private:
  /// A tile and what its cells need, by value, so that the compiler knows that writing cells does not change
  /// it. The loops over it have no branches either, so that they vectorise.
  struct HeldTile : TileOfGrid {
    Surface now;
    float* held;
    float threshold;

    DESERT_HD HeldTile(const PackChanges& law, const TileOfGrid& tile)
        : TileOfGrid(tile), now(law.now), held(law.held), threshold(law.threshold) {}
    DESERT_HD float change(int i) const { return now(i) - held[i]; }
  };

  template <class Team>
  DESERT_HD void write_elevations(const Team& team, const HeldTile& tile, float* to) const {
    team.for_each(tile.width, tile.height, [tile, to](int x, int y) DESERT_INLINE {
      const int i = tile.index(x, y);
      const float before = tile.held[i], after = tile.now(i);
      const bool changed = fabsf(after - before) > tile.threshold;
      tile.held[i] = changed ? after : before;
      to[y * tile.width + x] = changed ? after : float{unchanged_elevation};
    });
  }

  template <class Team>
  DESERT_HD void write_steps(const Team& team, const HeldTile& tile, const TileHeader& head,
                             std::int8_t* to) const {
    const int most = max_steps(head.bits);
    const float resolution = head.resolution;
    team.for_each(tile.width, tile.height, [tile, most, resolution, to](int x, int y) DESERT_INLINE {
      const int i = tile.index(x, y);
      const float before = tile.held[i], change = tile.change(i);
      const bool changed = fabsf(change) > tile.threshold;
      const int steps = round_to_int(change / resolution), low = steps < -most ? -most : steps;
      const auto step = static_cast<std::int8_t>(low > most ? most : low);
      const float after = apply_steps(before, step, resolution);
      tile.held[i] = changed ? after : before;
      to[y * tile.width + x] = changed ? step : std::int8_t{unchanged_step};
    });
  }
};

template <class E>
void set_held(E& exec, const TerrainView& t, const QuantaToMetres& metres, float* held) {
  for_each_cell(exec, t.grid, SetHeld{t.grid, {surface::SolidHeight(t), metres}, held});
}

template <class E>
void pack_changes(E& exec, const TerrainView& t, const QuantaToMetres& metres, const Tiling& tiles,
                  float threshold, float* held, char* pack) {
  exec.set_zero(pack, sizeof(packed_tiles::PackHeader));
  for_each_tile(exec, tiles, PackChanges{tiles, {surface::SolidHeight(t), metres}, held, threshold, pack});
}

template void set_held(Backend&, const TerrainView&, const QuantaToMetres&, float*);
template void pack_changes(Backend&, const TerrainView&, const QuantaToMetres&, const Tiling&, float, float*,
                           char*);

}  // namespace desert_sim::held_elevation
