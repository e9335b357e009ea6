#pragma once
/// Wind shadow: how far a cell lies in the lee. Nilles 2024 eq. 4; physics.md A6.
///
///   t = max over steps of Δh / distance, marching upwind one cell a step up to `distance`
///   r_s = clamp((t − tan start) / (tan full − tan start), 0, 1)
///
/// Heights are sampled bilinearly, through periodic borders; beyond an open edge the edge goes on. `curved`
/// re-reads the wind at every step. Reads elevation, wind_x, wind_y; writes wind_shadow.

#include "desert_sim/core/parameters.hpp"
#include "desert_sim/kernels/for_each.hpp"
#include "desert_sim/kernels/layers.hpp"
#include "desert_sim/kernels/math.hpp"

namespace desert_sim {

struct WindShadowParameters {
  bool enabled = true;
  float distance = 10.0f;
  float start_deg = 10.0f;
  float full_deg = 15.0f;
  bool curved = false;
};

constexpr auto parameter_table(const WindShadowParameters*) {
  using P = WindShadowParameters;
  return std::make_tuple(
      parameter("enabled", &P::enabled, "Whether terrain shelters the ground behind it."),
      parameter("distance", &P::distance, 0, 1000, "m",
                "How far upwind shelter is looked for; at least one cell."),
      parameter("start_deg", &P::start_deg, 0, 89, "deg", "Angle to the shelter at which shadow begins."),
      parameter("full_deg", &P::full_deg, 0, 89, "deg", "Angle to the shelter from which shadow is full."),
      parameter("curved", &P::curved, "Whether the march follows the wind as it turns."));
}
static_assert(table_is_complete<WindShadowParameters>());

namespace wind_shadow {

/// Bilinear height above `base` [quanta] at cell (x, y) + (dx, dy)/65536 cells. The four terms are formed so
/// that mirrored or turned terrain gives the same bits.
DESERT_HD float height_above(const Grid& g, const Quanta* h, Quanta base, int x, int y, int dx, int dy) {
  const int x0 = x + (dx >> 16), y0 = y + (dy >> 16);
  const float fx = (dx & 65535) * (1.0f / 65536.0f), fy = (dy & 65535) * (1.0f / 65536.0f);
  int i00, i10, i01, i11;
  if (g.inside(x0, y0) && g.inside(x0 + 1, y0 + 1)) {
    i00 = g.index(x0, y0);
    i10 = i00 + 1;
    i01 = i00 + g.width;
    i11 = i01 + 1;
  } else {
    i00 = sample_index(g, x0, y0);
    i10 = sample_index(g, x0 + 1, y0);
    i01 = sample_index(g, x0, y0 + 1);
    i11 = sample_index(g, x0 + 1, y0 + 1);
  }
  const float a = static_cast<float>(h[i00] - base) * ((1.0f - fx) * (1.0f - fy));
  const float b = static_cast<float>(h[i10] - base) * (fx * (1.0f - fy));
  const float c = static_cast<float>(h[i01] - base) * ((1.0f - fx) * fy);
  const float d = static_cast<float>(h[i11] - base) * (fx * fy);
  return (a + d) + (b + c);
}

struct Shadow {
  Grid grid;
  float quantum;
  const Quanta* elevation;
  const float *wind_x, *wind_y;
  int steps;
  float start, full;  ///< tangents
  bool curved;
  float* wind_shadow;

  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    const Quanta base = elevation[i];
    float u = wind_x[i], v = wind_y[i];
    float steepest = 0.0f;  // quanta per step
    int dx = 0, dy = 0;
    for (int j = 1; j <= steps; ++j) {
      if (j == 1 || curved) {
        const float speed = hypotenuse(u, v);
        if (!(speed > 1e-6f)) break;
        u /= speed;
        v /= speed;
      }
      dx -= subcells(u);
      dy -= subcells(v);
      steepest = maximum(steepest, height_above(grid, elevation, base, x, y, dx, dy) / static_cast<float>(j));
      if (curved) {
        const int there = sample_index(grid, x + nearest_cell(dx), y + nearest_cell(dy));
        u = wind_x[there];
        v = wind_y[there];
      }
    }
    wind_shadow[i] = clamp((steepest * quantum / grid.cell_size - start) / (full - start), 0.0f, 1.0f);
  }
};

template <class E>
void step(E& exec, const TerrainView& t, const WindShadowParameters& p) {
  const float degree = 3.14159265358979f / 180.0f;
  const float start = tanf(p.start_deg * degree);
  const float full = maximum(tanf(p.full_deg * degree), start + 1e-6f);
  const int steps = static_cast<int>(maximum(1.0f, floorf(p.distance / t.grid.cell_size)));
  for_each_cell(exec, t.grid,
                Shadow{t.grid, t.quantum, t.quanta(Layer::elevation), t.real(Layer::wind_x),
                       t.real(Layer::wind_y), steps, start, full, p.curved, t.real(Layer::wind_shadow)});
}

}  // namespace wind_shadow
}  // namespace desert_sim
