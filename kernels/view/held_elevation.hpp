#pragma once
/// Incremental updates of the elevation: the device keeps the elevation that subscribers hold, compares it
/// tile by tile with the current one, and packs the tiles that changed one after another, so that only they
/// are copied to the host. Reads bedrock, soil and sand; writes the held elevation.

#include <cmath>
#include <cstdint>

#include "kernels/field/layers.hpp"
#include "kernels/view/layer_values.hpp"
#include "kernels/view/packed_tiles.hpp"

namespace desert_sim::held_elevation {

using packed_tiles::Tiling;

/// Stand for a cell that did not change: no step is so long, and no elevation is infinite.
constexpr std::int8_t unchanged_step = -128;

constexpr float unchanged_elevation = -HUGE_VALF;

/// Sets the held elevation to the current one, for the whole grid.
template <class E>
void set_held(E& exec, const TerrainView& t, const QuantaToMetres& metres, float* held);

/// Packs the cells of `tiles` that changed by more than `threshold` [m] ≥ 0, and updates what is held of
/// them. `pack` must have room for max_packed_bytes().
template <class E>
void pack_changes(E& exec, const TerrainView& t, const QuantaToMetres& metres, const Tiling& tiles,
                  float threshold, float* held, char* pack);

}  // namespace desert_sim::held_elevation
