/// The laws and the step of wind_features.hpp; compiled once for each backend.
#include "kernels/wind/wind_features.hpp"

#include <vector>

#include "kernels/backend/buffer.hpp"
#include "kernels/backend/for_each.hpp"
#include "kernels/backend/loops.hpp"
#include "kernels/base/math.hpp"
#include "kernels/field/random.hpp"
#include "src/core/parameter_table.hpp"

namespace desert_sim::wind_features {

/// A distance along an axis and its square as they enter a stream function.
struct Distance {
  float odd, square;

  DESERT_HD Distance(float d, float extent, bool periodic, float fidelity) : odd(d), square(d * d) {
    if (!periodic) return;
    const float ratio = d / extent, turns = ratio - rintf(ratio);  // −½ … ½
    const float half_sine = sine_of_half_turns(turns), half_cosine = sine_of_half_turns(0.5f - fabsf(turns));
    const float sine = 2.0f * half_sine * half_cosine, versine = 2.0f * half_sine * half_sine;
    const float cosine = 1.0f - versine, unit = extent / 6.28318531f, b = fidelity;
    odd = unit * sine * (1.0f + 0.5f * b - 0.6f * b * cosine + b / 30.0f * (4.0f * cosine * cosine - 1.0f));
    const float third = 2.0f * cosine + 1.0f;  // 1 − cos 3θ = (1 − cos θ)(2 cos θ + 1)²
    square = 2.0f * unit * unit *
             ((1.0f + 0.5f * b) * versine - 0.3f * b * sine * sine + b / 90.0f * versine * third * third);
  }
};

/// The distances of a place from a feature's centre along both axes.
struct Offset {
  Distance dx, dy;

  DESERT_HD Offset(const Grid& grid, const Prepared& p, float x, float y)
      : dx(x - p.x, grid.width * grid.cell_size, grid.periodic_x, p.axis_x.fidelity),
        dy(y - p.y, grid.height * grid.cell_size, grid.periodic_y, p.axis_y.fidelity) {}
  /// r²/R²
  DESERT_HD float relative_square(const WindFeatureParameters& f) const {
    return (dx.square + dy.square) / (f.radius * f.radius);
  }
};

struct StreamFunction {
  Grid grid;
  const Prepared* features;
  int count;
  float* stream;

  DESERT_HD float feature_stream(const Prepared& p, float x, float y) const {
    const WindFeatureParameters& f = p.feature;
    if (f.kind == WindFeatureKind::sink) return 0.0f;
    const Offset offset(grid, p, x, y);
    const Distance &dx = offset.dx, &dy = offset.dy;
    const float r2 = offset.relative_square(f);
    if (f.kind == WindFeatureKind::vortex) return p.amplitude * f.radius * exp_negative(0.5f * r2);
    if (f.kind == WindFeatureKind::jet) {
      const float c = p.direction.x, s = p.direction.y, mixed = 2.0f * c * s * dx.odd * dy.odd;
      const float along2 = c * c * dx.square + mixed + s * s * dy.square;
      const float across2 = s * s * dx.square - mixed + c * c * dy.square;
      const float q = along2 / (f.length * f.length) + across2 / (f.radius * f.radius);
      return p.amplitude * (dy.odd * c - dx.odd * s) * exp_negative(0.5f * maximum(q, 0.0f));
    }
    if (r2 >= 1.0f) return 0.0f;
    const float window = (1.0f - r2) * (1.0f - r2);
    const float width = grid.width * grid.cell_size, height = grid.height * grid.cell_size;
    return p.amplitude * f.scale * window *
           value_noise(static_cast<std::uint64_t>(f.seed), Purpose::turbulence,
                       lattice(x - p.x, width, grid.periodic_x, p.axis_x),
                       lattice(y - p.y, height, grid.periodic_y, p.axis_y), p.life, p.share_of_life,
                       p.axis_x.period, p.axis_y.period);
  }
  DESERT_HD static float lattice(float d, float extent, bool periodic, const FeatureAxis& axis) {
    return (periodic ? d - extent * rintf(d / extent) : d) * axis.per_metre;
  }

  DESERT_HD void operator()(int x, int y) const {
    float sum = 0.0f;
    for (int n = 0; n < count; ++n)
      sum += feature_stream(features[n], (x + 0.5f) * grid.cell_size, (y + 0.5f) * grid.cell_size);
    stream[grid.index(x, y)] = sum;
  }
};

/// The curl of the stream function, and the flow into sinks.
struct Flow {
  Grid grid;
  const Prepared* features;
  int count;
  const float* stream;
  float *perturbation_x, *perturbation_y;

  DESERT_HD void operator()(int x, int y) const {
    const float scale = 0.5f / grid.cell_size;
    const int i = grid.index(x, y);
    float u = (stream[sample_index(grid, x, y + 1)] - stream[sample_index(grid, x, y - 1)]) * scale;
    float v = (stream[sample_index(grid, x - 1, y)] - stream[sample_index(grid, x + 1, y)]) * scale;
    for (int n = 0; n < count; ++n) {
      const Prepared& p = features[n];
      if (p.feature.kind != WindFeatureKind::sink) continue;
      const Offset offset(grid, p, (x + 0.5f) * grid.cell_size, (y + 0.5f) * grid.cell_size);
      const float speed =
          p.amplitude / p.feature.radius * exp_negative(0.5f * offset.relative_square(p.feature));
      u -= speed * offset.dx.odd;
      v -= speed * offset.dy.odd;
    }
    perturbation_x[i] = u;
    perturbation_y[i] = v;
  }
};

template <class E>
void step(E& exec, const Grid& grid, const Buffer<Prepared>& features, float* stream, float* perturbation_x,
          float* perturbation_y) {
  const int count = static_cast<int>(features.size());
  for_each_cell(exec, grid, StreamFunction{grid, features.data(), count, stream});
  for_each_cell(exec, grid, Flow{grid, features.data(), count, stream, perturbation_x, perturbation_y});
}

template void step(Backend&, const Grid&, const Buffer<Prepared>&, float*, float*, float*);

}  // namespace desert_sim::wind_features
