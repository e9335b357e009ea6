#pragma once
/// What others hold of the surface, and what they lack: cells are compared with what is held, tile by tile,
/// and tiles that changed are packed one behind the other, so that only they need to go to the host.
/// Reads bedrock, soil, sand; writes what is held.

#include <cmath>
#include <cstdint>

#include "kernels/field/layers.hpp"
#include "kernels/view/layer_values.hpp"
#include "kernels/view/packed_tiles.hpp"

namespace desert_sim::held_elevation {

using packed_tiles::Tiling;

/// In the place of a cell that did not change: no step is so long, and no elevation is infinite.
constexpr std::int8_t no_step = -128;

constexpr float no_elevation = -HUGE_VALF;

/// Holds the whole surface.
template <class E>
void hold(E& exec, const TerrainView& t, const Metres& metres, float* held);

/// Packs what changed by more than `threshold` [m] ≥ 0 in `tiles`; `pack` has room for most_packed().
template <class E>
void take_changes(E& exec, const TerrainView& t, const Metres& metres, const Tiling& tiles, float threshold,
                  float* held, char* pack);

}  // namespace desert_sim::held_elevation
