#pragma once
/// Local features of the wind: a divergence-free perturbation from a stream function ψ (curl noise, Bridson
/// 2007), and the flow of sinks, which is the gradient of a potential χ.
///
///   vortex       ψ = speed R exp(½ (1 − r²/R²))
///   jet          ψ = speed η exp(−½ (ξ²/length² + η²/R²)) / max(1, R / (e length))
///   turbulence   ψ = 0.925 speed scale noise(X/scale, Y/scale, t/life_time) (1 − r²/R²)²   where r < R
///
///   sink         χ = speed R exp(½ (1 − r²/R²))
///
///   u =  ∂ψ/∂y + ∂χ/∂x
///   v = −∂ψ/∂x + ∂χ/∂y
///
/// X and Y are the distances from the feature's centre, ξ and η those along and across its direction,
/// r² = X² + Y², R its radius. Along a periodic axis of length E a distance d enters the stream function as
///
///   d   →  E/2π [(1 + β/2) sin θ − 3β/10 sin 2θ + β/30 sin 3θ],   θ = 2π d/E
///   d²  →  twice its integral
///
/// which are d and d² near the centre and smooth on the torus, so that radius and length may be as large as
/// the terrain, or larger. β is 1 for features small against the terrain, for which the terms up to d⁶ are
/// those of d, and falls to 0 for large ones, which would exceed their speed at the seam. The lattice of the
/// noise is stretched to a whole number of cells, at least two.
///
/// A vortex is fastest at r = R, with `speed`; it turns counter-clockwise, or clockwise if `speed` is
/// negative. A jet blows with `speed` along `direction_deg` in its middle, with return flow beside it; one
/// that is wider than e times its length is fastest in that return flow. No vortex or jet exceeds its speed.
/// The factor 0.925 makes `speed` the root mean square in the middle of turbulence. Its time is counted in
/// whole life times and a share of one, in double precision, so that it never freezes. The air of a sink
/// flows towards its centre, or away from it if `speed` is negative, fastest at r = R, with `speed`.
///
/// A feature is there while begin ≤ t < end. Its centre moves from (x, y) at t = begin with its velocity, or
/// along its path: linearly from one point to the next, and it stands before the first and after the last.
///
/// Derivatives of ψ are central differences, for which the discrete divergence is 0; those of χ are exact.
/// Reads no layer, and writes the perturbation only.

#include <cstdint>
#include <vector>

#include "kernels/backend/buffer.hpp"
#include "kernels/base/grid.hpp"
#include "kernels/wind/vector.hpp"
#include "src/core/parameter_table.hpp"

namespace desert_sim {

enum class WindFeatureKind : int { vortex, jet, turbulence, sink };
constexpr const char* wind_feature_kinds[] = {"vortex", "jet", "turbulence", "sink"};

struct WindFeatureParameters {
  WindFeatureKind kind = WindFeatureKind::vortex;
  double x = 0, y = 0;
  float radius = 50;
  float speed = 3;
  float direction_deg = 0;
  float length = 100;
  float scale = 20;
  float life_time = 30;
  int seed = 1;
  int id = 0;
  double begin = 0, end = 0;
  float velocity_x = 0, velocity_y = 0;
};

constexpr auto parameter_table(const WindFeatureParameters*) {
  using P = WindFeatureParameters;
  return std::make_tuple(
      parameter("kind", &P::kind, wind_feature_kinds, "What the feature is."),
      parameter("x", &P::x, -1e9, 1e9, "m", "Centre, in the terrain's frame."),
      parameter("y", &P::y, -1e9, 1e9, "m", "Centre, in the terrain's frame."),
      parameter("radius", &P::radius, 0.1, 1e5, "m",
                "Radius of a vortex, patch or sink; half width of a jet."),
      parameter("speed", &P::speed, -100, 100, "m/s",
                "Greatest speed it adds; of turbulence the root mean square in its middle."),
      parameter("direction_deg", &P::direction_deg, -360, 360, "deg",
                "Where a jet blows to, counter-clockwise from +x."),
      parameter("length", &P::length, 0.1, 1e5, "m", "Half length of a jet."),
      parameter("scale", &P::scale, 0.1, 1e5, "m", "Size of a turbulence patch's eddies."),
      parameter("life_time", &P::life_time, 0.01, 1e6, "s", "Time in which turbulence renews itself."),
      parameter("seed", &P::seed, 0, 2147483647, "1", "Seed of turbulence."),
      parameter("id", &P::id, 0, 2147483647, "1", "What edit_wind knows it by, if not 0; not two alike."),
      parameter("begin", &P::begin, 0, 1e12, "s", "Simulated time from which it is there."),
      parameter("end", &P::end, 0, 1e12, "s", "Simulated time from which it is gone; 0: never."),
      parameter("velocity_x", &P::velocity_x, -100, 100, "m/s",
                "How fast its centre moves, from x, y at `begin`."),
      parameter("velocity_y", &P::velocity_y, -100, 100, "m/s",
                "How fast its centre moves, from x, y at `begin`."));
}
static_assert(table_is_complete<WindFeatureParameters>());

/// Where a feature is at a time.
struct WindPathPoint {
  double time = 0;
  double x = 0, y = 0;
};
constexpr auto parameter_table(const WindPathPoint*) {
  using P = WindPathPoint;
  return std::make_tuple(
      parameter("time", &P::time, 0, 1e12, "s", "Simulated time, later than that of the point before."),
      parameter("x", &P::x, -1e9, 1e9, "m", "Centre, in the terrain's frame."),
      parameter("y", &P::y, -1e9, 1e9, "m", "Centre, in the terrain's frame."));
}
static_assert(table_is_complete<WindPathPoint>());

struct WindFeature : WindFeatureParameters {
  std::vector<WindPathPoint> path;  ///< in the place of centre and velocity, its times ascending; empty: none
};

/// Whether it ends, if ever, after it begins.
inline bool ends_after_begin(const WindFeatureParameters& f) { return f.end == 0 || f.end > f.begin; }
constexpr const char* end_before_begin = "must be above `begin`, or 0 for never";

namespace wind_features {

/// An axis: cells of the noise per metre, and after how many cells it repeats (0: never).
struct FeatureAxis {
  float per_metre = 1;
  int period = 0;
  float fidelity = 1;  ///< β
};

/// A feature prepared on the host.
struct Prepared {
  WindFeatureParameters feature;
  float x = 0, y = 0;            ///< centre, from the grid's south-west corner [m]
  wind::Vector direction{1, 0};  ///< unit vector
  float amplitude = 0;           ///< of ψ or χ without its lengths [m/s]; 0 while it is not there
  FeatureAxis axis_x, axis_y;
  std::uint32_t life = 0;   ///< whole life times since the start, modulo 2³²
  float share_of_life = 0;  ///< and the rest, 0 … 1
};

/// `origin_x`, `origin_y`: the grid's south-west corner in the terrain's frame [m]; `direction`: unit vector
/// of direction_deg; `time`: simulated time [s].
Prepared prepare(const WindFeature& feature, wind::Vector direction, const Grid& grid, double origin_x,
                 double origin_y, double time);
/// Goes on to another time. `feature` is what it was prepared of.
void set_time(Prepared& prepared, const WindFeature& feature, const Grid& grid, double origin_x,
              double origin_y, double time);

/// `perturbation_x`, `perturbation_y` [m/s] and the scratch `stream` [m²/s]: one float a cell.
template <class E>
void step(E& exec, const Grid& grid, const Buffer<Prepared>& features, float* stream, float* perturbation_x,
          float* perturbation_y);

}  // namespace wind_features
}  // namespace desert_sim
