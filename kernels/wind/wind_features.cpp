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

struct StreamFunction {
  Grid grid;
  const Prepared* features;
  int count;
  float* stream;

  DESERT_HD float feature_stream(const Prepared& p, float x, float y) const {
    const WindFeature& f = p.feature;
    const float width = grid.width * grid.cell_size, height = grid.height * grid.cell_size;
    const Distance dx(x - p.x, width, grid.periodic_x, p.axis_x.fidelity),
        dy(y - p.y, height, grid.periodic_y, p.axis_y.fidelity);
    const float r2 = (dx.square + dy.square) / (f.radius * f.radius);
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
void step(E& exec, const Grid& grid, const Buffer<Prepared>& features, float* stream, float* perturbation_x,
          float* perturbation_y) {
  for_each_cell(exec, grid, StreamFunction{grid, features.data(), static_cast<int>(features.size()), stream});
  for_each_cell(exec, grid, Curl{grid, stream, perturbation_x, perturbation_y});
}

template void step(Backend&, const Grid&, const Buffer<Prepared>&, float*, float*, float*);

}  // namespace desert_sim::wind_features
