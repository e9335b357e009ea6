#pragma once
/// A step in the life of all plants: they drink, grow, suffer and die, and new ones come up. The laws are in
/// drinking.hpp, growth.hpp and spawning.hpp. Reads the ground's layers, water, obstacle, canopy_height,
/// illumination, illumination_canopy and what cover() found; writes moisture and humus.
///
/// Plants are kept sorted by their key in the look-up, so that neighbours stand together in memory. The sort
/// is stable, so that their order, and with it every sum, depends on the state alone.

#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/plants/workspace.hpp"
#include "kernels/sand/repose.hpp"

namespace desert_sim::plants {

/// Brings the first `all` plants of `later` in order, of which so many are dead and left out.
template <class E>
void order(E& exec, int all, int dead, Workspace& work);

template <class E>
void live(E& exec, const TerrainView& t, const VegetationParameters& p, const ReposeParameters& repose,
          const surface::Heights& heights, float time_step, std::uint64_t seed, std::uint64_t step,
          LedgerView ledger, Workspace& work);

}  // namespace desert_sim::plants
