#pragma once
/// One step of all plants: water uptake (water_uptake.hpp), growth, damage and death (growth.hpp), and new
/// plants (spawning.hpp), where the equations are.
///
/// Plants are kept sorted by their key in the neighbour look-up, so that neighbours are close in memory. The
/// sort is stable, so that the order of plants, and with it every sum, depends on the state alone.
///
/// Reads bedrock, soil, sand, water, moisture, obstacle, canopy_height, illumination, illumination_canopy,
/// and the densities of the species that cover() wrote to the workspace. Writes moisture, humus and the
/// plants.

#include "kernels/field/dice.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/plants/workspace.hpp"
#include "kernels/sand/repose.hpp"

namespace desert_sim::plants {

template <class E>
void grow_and_spawn(E& exec, const TerrainView& t, const VegetationParameters& p,
                    const ReposeParameters& repose, const surface::Heights& heights, float time_step,
                    std::uint64_t seed, std::uint64_t step, const Dice& dice, LedgerView ledger,
                    Workspace& work);

}  // namespace desert_sim::plants
