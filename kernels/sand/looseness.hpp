#pragma once
/// Looseness λ of the ground's surface: 0 packed … 1 fresh. Grains that settle where no others hit them,
/// and sand that slides, lie loosely; the impacts of saltation pack what they hit (Bagnold 1941: the
/// windward side of a dune is firm, and soft where sand comes to rest); water and crusts hold grains
/// together. In a step, or part of one, of Δt
///
///   deposit and impacts   dλ/dt = a (1 − λ) − b λ,   a = max(Δs, 0)/(d Δt)
///                                                    b = (r/T)(1 − r_s)/d_i + k_f w
///                         λ ← λ + (a/(a + b) − λ)(1 − e^(−(a + b) Δt))
///   slides                λ ← λ + (1 − λ)(1 − e^(−u |Δs_a|/d)),   u = clamp(2 tan θ/tan θ₀ − 1, 0, 1)
///   a brush adds sand     λ ← λ + (1 − λ)(1 − e^(−Δs/d))
///
/// Δs is what saltation and reptation together add to the sand [m], Δs_a what avalanches add or take; d is
/// `fresh_depth`, d_i `impact_depth`, k_f `firming`. r is the strength of impacts (reptation.hpp), the sand
/// that comes down in the time T of a hop [m], without vegetation's share; in the wind shadow r_s it
/// settles without an impact. θ is the angle of repose that avalanches have reached, θ₀ that without
/// impacts: where impacts have lowered it by much, sand creeps (reptation, method adaptive_repose), and is
/// packed as it does, so that no more than the share u is an avalanche. w = min(2 m, 1) is how wet the
/// ground is (m relative moisture; half-wet ground is firmest), and 1 where it lies bare of sand (less than
/// `bare_depth`), because soil has a crust and rock is hard.
///
/// Rates are integrated exactly, so that n parts of a step with the same rates are the step to rounding,
/// and the result does not depend on how long a step is. Looseness is that of the surface: sand that the
/// wind lays bare keeps the looseness of what lay on it, until it is hit. Nothing reads it but what rovers
/// see of the ground.
///
/// Reads sand, soil, moisture, vegetation, wind_shadow; writes looseness.

#include "kernels/base/math.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/sand/repose.hpp"
#include "src/core/parameter_table.hpp"

namespace desert_sim {

struct LoosenessParameters {
  bool enabled = false;
  float initial = 0.3f;
  float fresh_depth = 0.05f;
  float impact_depth = 0.5f;
  float firming = 0.01f;
  float bare_depth = 0.001f;
};

constexpr auto parameter_table(const LoosenessParameters*) {
  using P = LoosenessParameters;
  return std::make_tuple(
      parameter("enabled", &P::enabled,
                "Whether sand is loose where it comes to rest, and packed by impacts."),
      parameter("initial", &P::initial, 0, 1, "1",
                "Looseness at the beginning, where no step of the terrain fills it."),
      parameter("fresh_depth", &P::fresh_depth, 1e-4, 100, "m",
                "Depth of fresh or sliding sand that loosens the surface by a share of 1 - 1/e (d)."),
      parameter("impact_depth", &P::impact_depth, 1e-4, 1e4, "m",
                "Depth of saltating sand whose impacts pack the surface by that share (d_i)."),
      parameter("firming", &P::firming, 0, 1e3, "1/s", "How fast wet or crusted ground becomes firm (k_f)."),
      parameter("bare_depth", &P::bare_depth, 0, 1, "m",
                "Depth of sand below which the ground counts as bare."));
}
static_assert(table_is_complete<LoosenessParameters>());

namespace looseness {

/// λ after fresh sand of `depths` = Δs/d ≥ 0 has come to lie on it, or slid over it.
DESERT_HD float loosened(float looseness, float depths) {
  return looseness + (1.0f - looseness) * lost_share(depths);
}

/// λ after a time in which it was loosened by a Δt and packed by b Δt, both ≥ 0.
DESERT_HD float after(float looseness, float loosening, float packing) {
  const float both = loosening + packing;
  if (!(both > 0.0f)) return looseness;
  return clamp(looseness + (loosening / both - looseness) * lost_share(both), 0.0f, 1.0f);
}

/// Keeps the depth of sand, `before`, for what comes next.
template <class E>
void record(E& exec, const TerrainView& t, Quanta* before);

struct StepInputs {
  float time_step, hop_time;  ///< [s]
  const float* impacts;       ///< r in a hop's time [m]
};

/// Deposits, impacts and firming since record(). Writes the present depth of sand to `before`.
template <class E>
void step(E& exec, const TerrainView& t, const LoosenessParameters& p, const ReposeParameters& repose,
          const StepInputs& in, Quanta* before);

/// Slides since step(). `tangents`: of the angles of repose by which avalanches slid.
template <class E>
void slides(E& exec, const TerrainView& t, const LoosenessParameters& p, const ReposeParameters& repose,
            const float* tangents, const Quanta* before);

template <class E>
void fill(E& exec, const TerrainView& t, float value);

}  // namespace looseness
}  // namespace desert_sim
