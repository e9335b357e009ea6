/// The laws and the step of wind_shadow.hpp; compiled once for each backend.
#include "kernels/wind/wind_shadow.hpp"

#include "kernels/backend/buffer.hpp"
#include "kernels/backend/for_each.hpp"
#include "kernels/backend/loops.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/surface.hpp"
#include "kernels/wind/tuned/shadow_marches.hpp"
#include "kernels/wind/wind_shadow_march.hpp"
#include "src/core/parameter_table.hpp"

namespace desert_sim::wind_shadow {

/// Steps of a march up to which vectors of cells are faster on a CPU than to skip pieces.
constexpr int short_march = 20;

template <class E>
Shadow straight_shadow(E& exec, const TerrainView& t, const WindShadowParameters& p,
                       const surface::Heights& heights, const Workspace& work,
                       MarchDirection* march_directions) {
  const FindMarchDirection find{t.grid, t.real(Layer::wind_x), t.real(Layer::wind_y)};
  if (march_directions || work.highest_nearby)
    for_each_cell(exec, heights.blocks,
                  PrepareBlock{{find, heights.blocks, march_directions},
                               {heights.blocks, heights.highest.data(), work.highest_nearby.data()}});
  return {find,
          p.distance / t.grid.cell_size,
          march_steps(t.grid, p),
          ShadowFromSlope(p.start_deg, p.full_deg, t.grid.cell_size * t.quanta_per_metre),
          heights.cell_heights.data(),
          work.reciprocals.data(),
          t.real(Layer::wind_shadow),
          heights.blocks,
          march_directions,
          work.highest_nearby.data()};
}

template <class E>
void step(E& exec, const TerrainView& t, const WindShadowParameters& p, const surface::Heights& heights,
          const Workspace& work) {
  // A separate pass over the blocks pays where it also lets marches skip pieces, and where rows of cells are
  // vectors.
  MarchDirection* march_directions =
      vectorises_rows<E> || work.highest_nearby ? work.march_directions.data() : nullptr;
  const Shadow shadow = straight_shadow(exec, t, p, heights, work, march_directions);
  if (p.curved) {
    for_each_cell(exec, t.grid,
                  CurvedShadow{t.grid, shadow.shadow_from_slope, shadow.heights, shadow.find.wind_x,
                               shadow.find.wind_y, shadow.reciprocals, shadow.steps, shadow.wind_shadow});
    return;
  }
  if constexpr (vectorises_rows<E>)
    if (!shadow.highest_nearby || shadow.steps <= short_march)
      return for_each_cell(exec, shadow.blocks, ShadowOfBlock{shadow});
  const ShadowOfFour four{shadow};
  for_each_cell(exec, four.fours(), four);
}

template Shadow straight_shadow(Backend&, const TerrainView&, const WindShadowParameters&,
                                const surface::Heights&, const Workspace&, MarchDirection*);
template void step(Backend&, const TerrainView&, const WindShadowParameters&, const surface::Heights&,
                   const Workspace&);

}  // namespace desert_sim::wind_shadow
