#pragma once
/// Avalanching of soil and of bedrock: one synchronous iteration a step, where they changed. Physics.md
/// B6–B7.
///
/// Soil slides over rock at its own angle (45° bare … 68° under vegetation, times the moisture factor), by
/// the laws of avalanching_laws.hpp. Bedrock breaks where it is steeper than `bedrock_deg`, by its own height
/// alone, and falls as sand or as rock. Reads and writes bedrock, soil, sand.

#include "kernels/avalanching/parameters.hpp"
#include "kernels/backend/buffer.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/sand/repose.hpp"

namespace desert_sim::avalanching {

/// Scratch for the ground's avalanches: one value a cell each.
struct GroundWorkspace {
  Buffer<Quanta> received;
  Buffer<float> share;
};

GroundWorkspace make_ground_workspace(Exec& exec, const Grid& grid);

/// `given`: scratch, and afterwards what each cell gave.
template <class E>
void step_soil(E& exec, const TerrainView& t, const AvalanchingParameters& p, const ReposeParameters& repose,
               Quanta* given, GroundWorkspace& work);

template <class E>
void step_bedrock(E& exec, const TerrainView& t, const AvalanchingParameters& p,
                  const ReposeParameters& repose, LedgerView ledger, Quanta* given, GroundWorkspace& work);

}  // namespace desert_sim::avalanching
