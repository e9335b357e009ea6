#pragma once
/// Wind shadow: how far a cell lies in the lee. Nilles 2024 eq. 4; physics.md A6.
///
///   t = max over steps of Δh / distance, marching upwind up to `distance`
///   r_s = clamp((t − tan start) / (tan full − tan start), 0, 1)
///
/// Cells of a block of 4 × 4 march in one direction, the wind's in its middle: the wind turns over many
/// blocks, and cells beside each other then share what they look at. A step goes to the next column of cells,
/// or the next row if the wind crosses rows faster, and looks between two cells there. `curved` goes one cell
/// width a step, between four cells, against each cell's own wind, which it re-reads at every step. Marches
/// go through periodic borders; beyond an open edge the edge goes on. Reads the heights, wind_x, wind_y;
/// writes wind_shadow. Laws: wind_shadow_march.hpp.

#include "kernels/backend/buffer.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/surface.hpp"
#include "kernels/wind/wind_shadow_march.hpp"
#include "kernels/wind/wind_shadow_parameters.hpp"

namespace desert_sim {

namespace wind_shadow {

/// `around` is empty where marches are too short for it to pay, or blocks do not fit a periodic axis; it and
/// `courses` where marches follow the wind.
struct Workspace {
  Buffer<float> reciprocals, around;
  Buffer<Course> courses;
};

inline int march_steps(const Grid& grid, const WindShadowParameters& p) {
  return static_cast<int>(maximum(1.0f, floorf(p.distance / grid.cell_size)));
}

Workspace make_workspace(Exec& exec, const Grid& grid, const WindShadowParameters& p);

/// The law of straight marches, ready for the terrain as it is. `courses`: those of the workspace, or
/// null, where that spares a pass.
template <class E>
Shadow straight_shadow(E& exec, const TerrainView& t, const WindShadowParameters& p,
                       const surface::Heights& heights, const Workspace& work, Course* courses);

template <class E>
void step(E& exec, const TerrainView& t, const WindShadowParameters& p, const surface::Heights& heights,
          const Workspace& work);

}  // namespace wind_shadow
}  // namespace desert_sim
