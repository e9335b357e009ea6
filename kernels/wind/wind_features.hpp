#pragma once
/// Local features of the wind: a divergence-free perturbation from a stream function ψ (curl noise: Bridson
/// 2007); physics.md A5. With distances ξ along and η across the feature's direction, r² = ξ² + η²:
///
///   vortex      ψ = speed R exp(½(1 − r²/R²)): fastest, `speed`, at r = R; counter-clockwise, or clockwise
///   if < 0 jet         ψ = speed η exp(−½(ξ²/length² + η²/R²)): `speed` along `direction_deg` in the middle,
///   return flow beside turbulence  ψ = ¾ speed · scale · noise(ξ/scale, η/scale, t/life_time) (1 − r²/R²)²
///   inside R
///
///   u = ∂ψ/∂y, v = −∂ψ/∂x by central differences, whose discrete divergence is 0. Writes the perturbation
///   only.

#include <vector>

#include "kernels/backend/buffer.hpp"
#include "kernels/backend/for_each.hpp"
#include "kernels/field/math.hpp"
#include "kernels/field/random.hpp"
#include "src/core/parameters.hpp"

namespace desert_sim {

enum class WindFeatureKind : int { vortex, jet, turbulence };
constexpr const char* wind_feature_kinds[] = {"vortex", "jet", "turbulence"};

struct WindFeature {
  WindFeatureKind kind = WindFeatureKind::vortex;
  float x = 0, y = 0;
  float radius = 50;
  float speed = 3;
  float direction_deg = 0;
  float length = 100;
  float scale = 20;
  float life_time = 30;
  int seed = 1;
  int id = 0;
};

constexpr auto parameter_table(const WindFeature*) {
  using P = WindFeature;
  return std::make_tuple(
      parameter("kind", &P::kind, wind_feature_kinds, "What the feature is."),
      parameter("x", &P::x, -1e6, 1e6, "m", "Centre, in the terrain's frame."),
      parameter("y", &P::y, -1e6, 1e6, "m", "Centre, in the terrain's frame."),
      parameter("radius", &P::radius, 0.1, 1e5, "m", "Radius of a vortex or patch; half width of a jet."),
      parameter("speed", &P::speed, -100, 100, "m/s",
                "Greatest speed it adds; of turbulence about the root mean square."),
      parameter("direction_deg", &P::direction_deg, -360, 360, "deg",
                "Where a jet blows to, counter-clockwise from +x."),
      parameter("length", &P::length, 0.1, 1e5, "m", "Half length of a jet."),
      parameter("scale", &P::scale, 0.1, 1e5, "m", "Size of a turbulence patch's eddies."),
      parameter("life_time", &P::life_time, 0.01, 1e6, "s", "Time in which turbulence renews itself."),
      parameter("seed", &P::seed, 0, 2147483647, "1", "Seed of turbulence."),
      parameter("id", &P::id, 0, 2147483647, "1", "What edit_wind knows it by, if not 0; not two alike."));
}
static_assert(table_is_complete<WindFeature>());

namespace wind_features {

/// A feature made ready on the host: positions relative to the grid's lower-left corner, direction as a unit
/// vector.
struct Prepared {
  WindFeature feature;
  float cos = 1, sin = 0;
};

struct StreamFunction {
  Grid grid;
  const Prepared* features;
  int count;
  float time;
  float* stream;

  /// Distance on a torus is the shortest; `extent` of the axis in metres.
  DESERT_HD static float shortest(float d, float extent, bool periodic) {
    return periodic ? d - extent * rintf(d / extent) : d;
  }

  DESERT_HD float one(const Prepared& p, float x, float y) const {
    const WindFeature& f = p.feature;
    const float dx = shortest(x - f.x, grid.width * grid.cell_size, grid.periodic_x);
    const float dy = shortest(y - f.y, grid.height * grid.cell_size, grid.periodic_y);
    const float along = dx * p.cos + dy * p.sin, across = dy * p.cos - dx * p.sin;
    const float r2 = (dx * dx + dy * dy) / (f.radius * f.radius);
    if (f.kind == WindFeatureKind::vortex) return f.speed * f.radius * 1.64872127f * exp_negative(0.5f * r2);
    if (f.kind == WindFeatureKind::jet) {
      const float a = along / f.length, b = across / f.radius;
      return f.speed * across * exp_negative(0.5f * (a * a + b * b));
    }
    if (r2 >= 1.0f) return 0.0f;
    const float window = (1.0f - r2) * (1.0f - r2);
    return 0.75f * f.speed * f.scale * window *
           value_noise(static_cast<std::uint64_t>(f.seed), Purpose::turbulence, along / f.scale,
                       across / f.scale, time / f.life_time);
  }

  DESERT_HD void operator()(int x, int y) const {
    float sum = 0.0f;
    for (int n = 0; n < count; ++n)
      sum += one(features[n], (x + 0.5f) * grid.cell_size, (y + 0.5f) * grid.cell_size);
    stream[grid.index(x, y)] = sum;
  }
};

struct Curl {
  Grid grid;
  const float* stream;
  float *perturbation_x, *perturbation_y;

  DESERT_HD void operator()(int x, int y) const {
    const float scale = 0.5f / grid.cell_size;
    const int i = grid.index(x, y);
    perturbation_x[i] = (stream[sample_index(grid, x, y + 1)] - stream[sample_index(grid, x, y - 1)]) * scale;
    perturbation_y[i] = (stream[sample_index(grid, x - 1, y)] - stream[sample_index(grid, x + 1, y)]) * scale;
  }
};

/// `perturbation_x/y` and `stream`: one float a cell. `time`: simulated [s]; turbulence lives by it.
template <class E>
void step(E& exec, const Grid& grid, const Buffer<Prepared>& features, float time, float* stream,
          float* perturbation_x, float* perturbation_y) {
  for_each_cell(exec, grid,
                StreamFunction{grid, features.data(), static_cast<int>(features.size()), time, stream});
  for_each_cell(exec, grid, Curl{grid, stream, perturbation_x, perturbation_y});
}

}  // namespace wind_features
}  // namespace desert_sim
