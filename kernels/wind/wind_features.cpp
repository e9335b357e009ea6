/// The laws and the step of wind_features.hpp; compiled once for each backend.
#include "kernels/wind/wind_features.hpp"

#include <vector>

#include "kernels/backend/buffer.hpp"
#include "kernels/backend/for_each.hpp"
#include "kernels/backend/loops.hpp"
#include "kernels/field/math.hpp"
#include "kernels/field/random.hpp"
#include "src/core/parameters.hpp"

namespace desert_sim::wind_features {

struct StreamFunction {
  Grid grid;
  const Prepared* features;
  int count;
  float time;
  float* stream;

  /// Coordinate difference [m], to the nearest image on a periodic axis; `extent`: length of the axis [m].
  DESERT_HD static float shortest(float d, float extent, bool periodic) {
    return periodic ? d - extent * rintf(d / extent) : d;
  }

  DESERT_HD float feature_stream(const Prepared& p, float x, float y) const {
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
      sum += feature_stream(features[n], (x + 0.5f) * grid.cell_size, (y + 0.5f) * grid.cell_size);
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

template <class E>
void step(E& exec, const Grid& grid, const Buffer<Prepared>& features, float time, float* stream,
          float* perturbation_x, float* perturbation_y) {
  for_each_cell(exec, grid,
                StreamFunction{grid, features.data(), static_cast<int>(features.size()), time, stream});
  for_each_cell(exec, grid, Curl{grid, stream, perturbation_x, perturbation_y});
}

template void step(Backend&, const Grid&, const Buffer<Prepared>&, float, float*, float*, float*);

}  // namespace desert_sim::wind_features
