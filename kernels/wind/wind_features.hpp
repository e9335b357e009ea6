#pragma once
/// Local features of the wind: a divergence-free perturbation from a stream function ψ (curl noise, Bridson
/// 2007).
///
///   vortex       ψ = speed R exp(½ (1 − r²/R²))
///   jet          ψ = speed η exp(−½ (ξ²/length² + η²/R²))
///   turbulence   ψ = ¾ speed scale noise(ξ/scale, η/scale, t/life_time) (1 − r²/R²)²   where r < R
///
///   u =  ∂ψ/∂y
///   v = −∂ψ/∂x
///
/// ξ and η are the distances from the feature's centre along and across its direction, r² = ξ² + η², R its
/// radius. A vortex is fastest at r = R, with `speed`; it turns counter-clockwise, or clockwise if `speed` is
/// negative. A jet blows with `speed` along `direction_deg` in its middle, with return flow beside it.
/// Derivatives are central differences, for which the discrete divergence is 0. Reads no layer, and writes
/// the perturbation only.

#include <vector>

#include "kernels/backend/buffer.hpp"
#include "kernels/field/grid.hpp"
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

/// A feature prepared on the host: its position relative to the grid's south-west corner, its direction as a
/// unit vector.
struct Prepared {
  WindFeature feature;
  float cos = 1, sin = 0;
};

/// `perturbation_x`, `perturbation_y` [m/s] and the scratch `stream` [m²/s]: one float a cell. `time`:
/// simulated time [s], which drives turbulence.
template <class E>
void step(E& exec, const Grid& grid, const Buffer<Prepared>& features, float time, float* stream,
          float* perturbation_x, float* perturbation_y);

}  // namespace wind_features
}  // namespace desert_sim
