#pragma once
/// Avalanching of soil and of bedrock: one synchronous sweep a step, while something wears the ground, or
/// changes the soil's angle of repose, or it still slides. Equations in avalanching.hpp.
///
///   soil      tan θ = lerp(tan θ_bare, tan θ_vegetated, v) · M
///   bedrock   tan θ = tan θ_bedrock
///
/// By default θ_bare is 45°, the others are 68°. v is the density of vegetation, M the moisture factor
/// (kernels/sand/repose.hpp). Soil slides over rock. Bedrock breaks where it is too steep, considering its
/// own height only, and falls as sand or as rock. Both use the laws of laws.hpp. Reads and writes bedrock,
/// soil and sand.

#include "kernels/avalanching/avalanching_parameters.hpp"
#include "kernels/backend/buffer.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/sand/repose.hpp"

namespace desert_sim::avalanching {

/// Work buffers for avalanches of the ground, with one value a cell each.
struct GroundWorkspace {
  Buffer<Quanta> received;
  Buffer<float> share;
  std::size_t bytes() const { return received.bytes() + share.bytes(); }
};

GroundWorkspace make_ground_workspace(Exec& exec, const Grid& grid);

/// `given` is a work buffer, which holds what each cell gave when the step is done.
template <class E>
void step_soil(E& exec, const TerrainView& t, const AvalanchingParameters& p, const ReposeParameters& repose,
               Quanta* given, GroundWorkspace& work);

template <class E>
void step_bedrock(E& exec, const TerrainView& t, const AvalanchingParameters& p,
                  const ReposeParameters& repose, LedgerView ledger, Quanta* given, GroundWorkspace& work);

}  // namespace desert_sim::avalanching
