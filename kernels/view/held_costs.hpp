#pragma once
/// What others hold of the costs of a terrain, and what they lack.
///
///   cost   lethal where the traversability is 0, else 99 (1 − traversability) rounded, 0 … 99; unknown where
///          it is NaN
///
/// A cell has changed if its cost is off by more than a threshold; to and from lethal and unknown always. The
/// smallest box with all cells that changed is brought up to date; tiles of it that differ at all from what
/// is held are packed. Reads what traversability reads; writes the costs of now, and what is held.

#include "kernels/field/cell_box.hpp"
#include "kernels/rover/traversability.hpp"
#include "kernels/view/packed_tiles.hpp"

namespace desert_sim::held_costs {

using packed_tiles::Tiling;

constexpr std::int8_t unknown_cost = -1, lethal_cost = 100;

/// No cost: where nothing is held.
constexpr std::int8_t no_cost = -128;

DESERT_HD std::int8_t cost_of(float traversability) {
  if (!(traversability == traversability)) return unknown_cost;
  if (traversability <= 0.0f) return lethal_cost;
  return static_cast<std::int8_t>(nearest(99.0f * (1.0f - minimum(traversability, 1.0f))));
}

/// A box that cells are added to, in numbers that grow with it; all 0 while it is empty.
struct GrowingBox {
  int west = 0, south = 0, east = 0, north = 0;  ///< width − x0, height − y0, x1, y1
  DESERT_HD CellBox cells(const Grid& grid) const {
    return {grid.width - west, grid.height - south, east, north};
  }
};

/// The costs of now, of all cells. `elevation` must be up to date.
template <class E>
void judge(E& exec, const TerrainView& t, const TraversabilityParameters& p, const ReposeParameters& repose,
           std::int8_t* now);

/// Writes to `box`.
template <class E>
void find_changes(E& exec, const Tiling& tiles, const std::int8_t* now, const std::int8_t* held,
                  int threshold, GrowingBox* box);

/// See TakeBox; `pack` has room for most_packed().
template <class E>
void take_box(E& exec, const Tiling& tiles, const std::int8_t* now, std::int8_t* held,
              const GrowingBox* changed, const CellBox& recent, char* pack);

}  // namespace desert_sim::held_costs
