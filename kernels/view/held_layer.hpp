#pragma once
/// Incremental updates of a layer: the device keeps the values that subscribers hold, compares them tile by
/// tile with the current ones, and packs the tiles that changed one after another, so that only they are
/// copied to the host. Reads the layer (for the elevation bedrock, soil and sand, because no step fills it);
/// writes what is held. A layer that is not in use is 0 everywhere.

#include <cmath>
#include <cstdint>

#include "kernels/field/layers.hpp"
#include "kernels/view/layer_values.hpp"
#include "kernels/view/packed_tiles.hpp"

namespace desert_sim::held_layer {

using packed_tiles::Tiling;

/// Stand for a cell that did not change: no step is so long, and no value is infinite.
constexpr std::int8_t unchanged_step = -128;

constexpr float unchanged_value = -HUGE_VALF;

/// How far what is held may be off, in the layer's unit. A cell changed if it is off by more; a change from
/// or to NaN always counts.
struct Tolerance {
  float threshold = 0;           ///< at least 0
  bool zero_is_special = false;  ///< a change from or to 0 always counts, too
};

/// Sets the held values to the current ones, for the whole grid.
template <class E>
void set_held(E& exec, const TerrainView& t, Layer layer, const QuantaToMetres& metres, float* held);

/// Packs the cells of `tiles` that changed, and updates what is held of them. `pack` must have room for
/// max_packed_bytes().
template <class E>
void pack_changes(E& exec, const TerrainView& t, Layer layer, const QuantaToMetres& metres,
                  const Tiling& tiles, const Tolerance& tolerance, float* held, char* pack);

}  // namespace desert_sim::held_layer
