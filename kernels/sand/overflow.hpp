#pragma once
/// Sand that comes in over an open edge for ever would fill the terrain beyond what heights can count. What
/// lies above fill_limit is taken away, and the ledger books it out. Sources ask for room themselves
/// (quanta.hpp: with_room()); this is for what moved on from there, and piled up elsewhere.
///
/// take_overflow() reads bedrock, soil, sand, water; it writes sand.

#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"

namespace desert_sim::overflow {

template <class E>
void take_overflow(E& exec, const TerrainView& t, LedgerView ledger);

}  // namespace desert_sim::overflow
