#pragma once
/// Echo dunes: the eddy in front of a cliff keeps a lane free of sand, and sand piles up ahead of it. Tsoar
/// 1983, Taylor & Keyser 2023; physics.md A7.
///
///   cliff    (h(here) − h(one cell upwind))/l ≥ tan `cliff_deg`; its height H = min(rise over the cliff,
///   `highest`) erosion  a cliff of height H within `erosion_reach`·H downwind: r_e = −k_e sticky   within
///   `sticky_reach`·H: r_e = clamp(1.1 − (d − erosion_reach H)/((sticky_reach − erosion_reach) H), 0, 1)
///
/// The rise is taken over the whole cliff: from this cell upwind to where the ground stops being a cliff.
/// Erosion wins; else the stickiest cliff counts. Reads the heights, wind_x, wind_y; writes echo.

#include "kernels/field/surface.hpp"
#include "kernels/wind/marching.hpp"
#include "src/core/parameters.hpp"

namespace desert_sim {

struct EchoDuneParameters {
  bool enabled = false;
  float cliff_deg = 55.0f;
  float highest = 30.0f;
  float erosion_reach = 0.4f;
  float sticky_reach = 2.0f;
  float erosion_rate = 1.0f;
};

constexpr auto parameter_table(const EchoDuneParameters*) {
  using P = EchoDuneParameters;
  return std::make_tuple(
      parameter("enabled", &P::enabled, "Whether cliffs hold sand off and pile it up ahead of them."),
      parameter("cliff_deg", &P::cliff_deg, 30, 89, "deg", "Windward slope from which ground is a cliff."),
      parameter("highest", &P::highest, 0.1, 500, "m", "Height at which a cliff's effect stops growing."),
      parameter("erosion_reach", &P::erosion_reach, 0, 10, "1",
                "Length of the sand-free lane, in heights of the cliff."),
      parameter("sticky_reach", &P::sticky_reach, 0, 20, "1",
                "How far ahead sand is held, in heights of the cliff."),
      parameter("erosion_rate", &P::erosion_rate, 0, 10, "m", "Extra sand lifted in the lane a step (k_e)."));
}
static_assert(table_is_complete<EchoDuneParameters>());

namespace echo_dunes {

struct CliffHeight {
  Grid grid;
  float quantum;
  const float *heights, *wind_x, *wind_y;
  float steepness;  ///< tangent
  float highest;
  float* cliff;  ///< [m], 0 where there is none

  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    const float speed = hypotenuse(wind_x[i], wind_y[i]);
    cliff[i] = 0.0f;
    if (!(speed > 1e-6f)) return;
    const int dx = subcells(-wind_x[i] / speed), dy = subcells(-wind_y[i] / speed);
    const float drop = steepness * grid.cell_size / quantum;  // quanta a step
    float last = 0.0f, rise = 0.0f;  // heights here and below it, relative to this cell
    for (int j = 1; rise * quantum < highest; ++j) {
      const marching::Place place(x, y, j * dx, j * dy);
      const float next = marching::height_at(grid, heights, place) - heights[i];
      if (last - next < drop) break;
      last = next;
      rise = -next;
    }
    cliff[i] = minimum(rise * quantum, highest);
  }
};

struct Classify {
  Grid grid;
  const float* cliff;
  const float *wind_x, *wind_y;
  EchoDuneParameters p;
  float* echo;

  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    float u = wind_x[i], v = wind_y[i];
    const float speed = hypotenuse(u, v);
    echo[i] = 0.0f;
    if (!(speed > 1e-6f)) return;
    const int dx = subcells(u / speed), dy = subcells(v / speed);
    const int steps = static_cast<int>(p.sticky_reach * p.highest / grid.cell_size);
    float sticky = 0.0f;
    for (int j = 1; j <= steps; ++j) {
      const float height = cliff[sample_index(grid, x + nearest_cell(j * dx), y + nearest_cell(j * dy))];
      const float distance = j * grid.cell_size, lane = p.erosion_reach * height,
                  end = p.sticky_reach * height;
      if (height <= 0.0f || distance > end) continue;
      if (distance <= lane) {
        echo[i] = -p.erosion_rate;
        return;
      }
      sticky = maximum(sticky, clamp(1.1f - (distance - lane) / (end - lane), 0.0f, 1.0f));
    }
    echo[i] = sticky;
  }
};

/// `cliff` is scratch memory of one float a cell.
template <class E>
void step(E& exec, const TerrainView& t, const EchoDuneParameters& p, const surface::Heights& heights,
          float* cliff) {
  const float steepness = tanf(p.cliff_deg * 3.14159265358979f / 180.0f);
  for_each_cell(exec, t.grid,
                CliffHeight{t.grid, t.quantum, heights.of_cells.data(), t.real(Layer::wind_x),
                            t.real(Layer::wind_y), steepness, p.highest, cliff});
  for_each_cell(
      exec, t.grid,
      Classify{t.grid, cliff, t.real(Layer::wind_x), t.real(Layer::wind_y), p, t.real(Layer::echo)});
}

}  // namespace echo_dunes
}  // namespace desert_sim
