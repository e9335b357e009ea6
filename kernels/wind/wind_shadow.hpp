#pragma once
/// Wind shadow: how far a cell lies in the lee of higher ground. Nilles 2024 §3.4, eq. 4.
///
///   tan α = max over samples of (h(sample) − h(here)) / distance to the sample
///   r_s   = clamp((tan α − tan `start_deg`) / (tan `full_deg` − tan `start_deg`), 0, 1)
///
/// Samples are those of a march upwind up to `distance`. The cells of a block of 4 × 4 march in one
/// direction, that of the wind in the block's middle: the wind turns over many blocks, and adjacent cells
/// then share their samples. The first sample lies at one cell's distance in every direction, on the
/// quadratic surface through the nine cells around (RiseOverOneCell). Then a step goes to the next column of
/// cells, or to the next row where the line crosses rows faster, and interpolates linearly between two cells
/// there. With `curved` each cell marches against its own wind, one cell width per step with bilinear samples
/// after the first, and reads the wind again at every step. Marches wrap around periodic edges; beyond an
/// open edge the height of the edge continues.
///
/// Steps shorter than `run.hold_time`, 1 s, share the shadow of the first one of this time. Dunes depend
/// on this delay as on a constant of nature: what the wind lifts in it makes cells that shelter those
/// behind them, from which dunes grow; where the shadow follows the sand at once, the barchans of
/// config/scenarios run out into streaks.
///
/// Reads bedrock, soil, sand and, with plants, canopy_height through `heights`, wind_x, wind_y; writes
/// wind_shadow. The laws are in wind_shadow_march.hpp.

#include "kernels/backend/buffer.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/surface.hpp"
#include "kernels/wind/wind_shadow_march.hpp"
#include "kernels/wind/wind_shadow_parameters.hpp"

namespace desert_sim {

namespace wind_shadow {

/// `reciprocals`: 1/j for each step j. `highest_nearby` is empty where marches are too short for it to pay,
/// or where blocks do not divide a periodic axis. Both `highest_nearby` and `march_directions` are empty with
/// `curved`.
struct Workspace {
  Buffer<float> reciprocals, highest_nearby;
  Buffer<MarchDirection> march_directions;
  std::size_t bytes() const {
    return reciprocals.bytes() + highest_nearby.bytes() + march_directions.bytes();
  }
};

inline int march_steps(const Grid& grid, const WindShadowParameters& p) {
  return static_cast<int>(maximum(1.0f, floorf(p.distance / grid.cell_size)));
}

Workspace make_workspace(Exec& exec, const Grid& grid, const WindShadowParameters& p);

/// The law of straight marches over the terrain as it is now. `march_directions`: those of the workspace, or
/// null where each cell computes its own, which saves a pass over the blocks.
template <class E>
Shadow straight_shadow(E& exec, const TerrainView& t, const WindShadowParameters& p,
                       const surface::Heights& heights, const Workspace& work,
                       MarchDirection* march_directions);

template <class E>
void step(E& exec, const TerrainView& t, const WindShadowParameters& p, const surface::Heights& heights,
          const Workspace& work);

}  // namespace wind_shadow
}  // namespace desert_sim
