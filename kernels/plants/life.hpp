#pragma once
/// One step of all plants: water uptake (water_uptake.hpp), growth, damage and death (growth.hpp), and new
/// plants (spawning.hpp), where the equations are.
///
/// Plants are kept in the order of plant_order.hpp.
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

struct StepInputs {
  VegetationParameters vegetation;
  ReposeParameters repose;          ///< for the ground's capacity of moisture
  const surface::Heights& heights;  ///< of the ground's surface
  float time_step;                  ///< [s]
  std::uint64_t seed, tick;         ///< key and counter (steps done) of the random numbers of new plants
};

template <class E>
void grow_and_spawn(E& exec, const TerrainView& t, const StepInputs& in, const Dice& dice, LedgerView ledger,
                    Workspace& work);

}  // namespace desert_sim::plants
