#pragma once
/// Sources and sinks of surface water: springs, the sea, evaporation. Nilles 2025 §3.4.3 and 3.4.5, eq. 34.
///
/// springs       w += Q Δt/(n l²)                 on the n cells of a disc, with the discharge Q [m³/s] sea
/// w ← max(w, level − elevation)    on the border or everywhere evaporation   w ← w e^(−φ Δt)
///
/// The ledger records what is added as inflow, and what evaporates, or finds no room in a cell that is full,
/// as outflow. add_spring() and evaporate() read and write water; fill_sea() reads bedrock, soil, sand, water
/// and writes water, in each sub-step of the flow (virtual_pipes.hpp).

#include <cstdint>

#include "kernels/field/dice.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/water/water_parameters.hpp"

namespace desert_sim {

namespace water_sources {

/// `x`, `y` [m] from the terrain's south-west corner.
template <class E>
void add_spring(E& exec, const TerrainView& t, const Spring& spring, double x, double y, float time_step,
                std::uint64_t tick, LedgerView ledger);

template <class E>
void fill_sea(E& exec, const TerrainView& t, Sea sea, Quanta level, LedgerView ledger);

template <class E>
void evaporate(E& exec, const TerrainView& t, float rate, float time_step, const Dice& dice,
               LedgerView ledger);

}  // namespace water_sources
}  // namespace desert_sim
