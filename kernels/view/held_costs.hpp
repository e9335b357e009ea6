#pragma once
/// Incremental updates of the costs of a terrain: the device keeps the costs that subscribers hold, and finds
/// where they are out of date.
///
/// A cell has changed if its cost differs from the held one by more than a threshold; a change to or from
/// lethal and unknown always counts. Each tile that has a changed cell is brought up to date as a whole, and
/// packed. Reads what traversability reads; writes the current and the held costs.

#include "kernels/rover/traversability.hpp"
#include "kernels/view/cell_cost.hpp"
#include "kernels/view/packed_tiles.hpp"

namespace desert_sim::held_costs {

using packed_tiles::Tiling;

/// Not a cost: stands where nothing is held yet.
constexpr std::int8_t no_cost = -128;

/// Computes the current costs of all cells. `elevation` must be up to date.
template <class E>
void compute_costs(E& exec, const TerrainView& t, const traversability::Rover& rover, std::int8_t* now);

/// Brings held costs up to date, see CopyTiles. `pack` must have room for max_packed_bytes().
template <class E>
void copy_tiles(E& exec, const Tiling& tiles, const std::int8_t* now, std::int8_t* held, int threshold,
                char* pack);

}  // namespace desert_sim::held_costs
