/// Laws and functions of held_layer.hpp; compiled once for each backend.
#include "kernels/view/held_layer.hpp"

#include <cstdint>
#include <type_traits>

#include "kernels/backend/loops.hpp"
#include "kernels/base/math.hpp"
#include "kernels/view/layer_values_laws.hpp"
#include "kernels/view/packed_tiles.hpp"
#include "kernels/view/quantised_steps.hpp"

namespace desert_sim::held_layer {

using packed_tiles::TileHeader;

using packed_tiles::TileOfGrid;

template <class Values>
struct SetHeld {
  Grid grid;
  Values now;
  float* held;
  DESERT_HD void operator()(int x, int y) const { held[grid.index(x, y)] = now(grid.index(x, y)); }
};

/// If a cell of a tile changed, packs all such cells of the tile and updates what is held of them. They are
/// packed as steps, whose error is within the threshold, or as values, where steps of eight bits would be too
/// coarse, and where a change is one from or to NaN or a special 0, which counts as infinitely large.
template <class Values>
struct PackChanges {
  Tiling tiles;
  Values now;
  float* held;
  Tolerance tolerance;
  char* pack;

  template <class Team>
  static constexpr int scratch_bytes = packed_tiles::scratch_bytes;

  /// Whether steps of `bits` bits are fine enough. The largest error is half a step, which has to be a little
  /// less than the threshold, so that rounding does not exceed it.
  DESERT_HD bool step_is_fine_enough(int bits, float largest) const {
    const float step = largest / static_cast<float>(max_steps(bits));
    return step > 0.0f && step <= 1.99f * tolerance.threshold;
  }

  template <class Team>
  DESERT_HD void operator()(const Team& team, int column, int row_of_band) const {
    const HeldTile tile{*this, {tiles, column, tiles.first_row + row_of_band}};
    // Floats that are not negative compare like their bits. This is minus the bits of the largest change.
    const int least = team.min_of(tile.width, tile.height, [tile](int x, int y) DESERT_INLINE {
      const int i = tile.index(x, y);
      const float size = tile.size_of_change(tile.held[i], tile.now(i));
      return size > tile.tolerance.threshold ? -static_cast<int>(bits_of(size)) : 0;
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
      write_values(team, tile, reinterpret_cast<float*>(cells));
    else
      write_steps(team, tile, head, reinterpret_cast<std::int8_t*>(cells));
  }

 private:
  /// A tile and what its cells need, by value, so that the compiler knows that writing cells does not change
  /// it. The loops over it have no branches either, so that they vectorise.
  struct HeldTile : TileOfGrid {
    Values now;
    float* held;
    Tolerance tolerance;

    DESERT_HD HeldTile(const PackChanges& law, const TileOfGrid& tile)
        : TileOfGrid(tile), now(law.now), held(law.held), tolerance(law.tolerance) {}
    /// How much a change counts; 0 from NaN to NaN.
    DESERT_HD float size_of_change(float before, float after) const {
      const float size = fabsf(after - before);
      if constexpr (!Values::may_be_nan) return size;
      const bool from_or_to_nan = (before == before) != (after == after);
      const bool from_or_to_zero = tolerance.zero_is_special && (before == 0.0f) != (after == 0.0f);
      if (from_or_to_nan || from_or_to_zero) return HUGE_VALF;
      return size == size ? size : 0.0f;
    }
    DESERT_HD bool changed(float before, float after) const {
      return size_of_change(before, after) > tolerance.threshold;
    }
  };

  template <class Team>
  DESERT_HD void write_values(const Team& team, const HeldTile& tile, float* to) const {
    team.for_each(tile.width, tile.height, [tile, to](int x, int y) DESERT_INLINE {
      const int i = tile.index(x, y);
      const float before = tile.held[i], after = tile.now(i);
      const bool changed = tile.changed(before, after);
      tile.held[i] = changed ? after : before;
      to[y * tile.width + x] = changed ? after : float{unchanged_value};
    });
  }

  template <class Team>
  DESERT_HD void write_steps(const Team& team, const HeldTile& tile, const TileHeader& head,
                             std::int8_t* to) const {
    const int most = max_steps(head.bits);
    const float resolution = head.resolution;
    team.for_each(tile.width, tile.height, [tile, most, resolution, to](int x, int y) DESERT_INLINE {
      const int i = tile.index(x, y);
      const float before = tile.held[i], after = tile.now(i);
      const bool changed = tile.changed(before, after);
      const float change = Values::may_be_nan && !changed ? 0.0f : after - before;
      const int steps = round_to_int(change / resolution), low = steps < -most ? -most : steps;
      const auto step = static_cast<std::int8_t>(low > most ? most : low);
      tile.held[i] = changed ? apply_steps(before, step, resolution) : before;
      to[y * tile.width + x] = changed ? step : std::int8_t{unchanged_step};
    });
  }
};

template <class E>
void set_held(E& exec, const TerrainView& t, Layer layer, const QuantaToMetres& metres, float* held) {
  layer_values::with_values(t, layer, metres, [&](const auto& now) {
    for_each_cell(exec, t.grid, SetHeld<std::decay_t<decltype(now)>>{t.grid, now, held});
  });
}

template <class E>
void pack_changes(E& exec, const TerrainView& t, Layer layer, const QuantaToMetres& metres,
                  const Tiling& tiles, const Tolerance& tolerance, float* held, char* pack) {
  exec.set_zero(pack, sizeof(packed_tiles::PackHeader));
  layer_values::with_values(t, layer, metres, [&](const auto& now) {
    for_each_tile(exec, tiles, PackChanges<std::decay_t<decltype(now)>>{tiles, now, held, tolerance, pack});
  });
}

template void set_held(Backend&, const TerrainView&, Layer, const QuantaToMetres&, float*);
template void pack_changes(Backend&, const TerrainView&, Layer, const QuantaToMetres&, const Tiling&,
                           const Tolerance&, float*, char*);

}  // namespace desert_sim::held_layer
