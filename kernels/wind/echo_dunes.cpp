/// The laws and the step of echo_dunes.hpp; compiled once for each backend.
#include "kernels/wind/echo_dunes.hpp"

#include "kernels/backend/loops.hpp"
#include "kernels/field/surface.hpp"
#include "kernels/wind/marching.hpp"
#include "src/core/elementary.hpp"
#include "src/core/parameter_table.hpp"

namespace desert_sim::echo_dunes {

struct CliffHeight {
  Grid grid;
  float quantum;
  const float *heights, *wind_x, *wind_y;
  float steepness;  ///< tangent
  float highest;
  float* cliff;  ///< height of the cliff [m], 0 where there is none

  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    const float speed = hypotenuse(wind_x[i], wind_y[i]);
    cliff[i] = 0.0f;
    if (!(speed > 1e-6f)) return;
    const int dx = to_fixed_point(-wind_x[i] / speed), dy = to_fixed_point(-wind_y[i] / speed);
    const float drop = steepness * grid.cell_size / quantum;  // [quanta per step]
    float last = 0.0f, rise = 0.0f;  // of the previous sample above this cell, and of this cell above it
    for (int j = 1; rise * quantum < highest; ++j) {
      const marching::SamplePosition position(x, y, j * dx, j * dy);
      const float next = marching::height_at(grid, heights, position) - heights[i];
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
    const int dx = to_fixed_point(u / speed), dy = to_fixed_point(v / speed);
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
      sticky = maximum(sticky, clamp(p.sticky_start - (distance - lane) / (end - lane), 0.0f, 1.0f));
    }
    echo[i] = sticky;
  }
};

template <class E>
void step(E& exec, const TerrainView& t, const EchoDuneParameters& p, const surface::Heights& heights,
          float* cliff) {
  const auto steepness = static_cast<float>(elementary::tan_deg(p.cliff_deg));
  for_each_cell(exec, t.grid,
                CliffHeight{t.grid, t.quantum, heights.cell_heights.data(), t.real(Layer::wind_x),
                            t.real(Layer::wind_y), steepness, p.highest, cliff});
  for_each_cell(
      exec, t.grid,
      Classify{t.grid, cliff, t.real(Layer::wind_x), t.real(Layer::wind_y), p, t.real(Layer::echo)});
}

template void step(Backend&, const TerrainView&, const EchoDuneParameters&, const surface::Heights&, float*);

}  // namespace desert_sim::echo_dunes
