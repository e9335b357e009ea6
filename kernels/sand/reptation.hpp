#pragma once
/// Reptation: grains that saltation hits creep down the slope. Nilles 2024 §3.7 and its later version, Paris
/// 2019 §5.1; physics.md B5. r is the strength that saltation left: (deposited + bounced)(1 − v) [m].
///
///   adaptive_repose  tan θ = lerp(tan θ_sand exp(−k_r r |w| (1 − r_s use_shadow)), tan θ_vegetated, v) ·
///   moisture,
///                    the donor's angle in the avalanche that follows
///   smoothing        flux between neighbours k_r |Δh|/(l d) ½(r_i + r_j) ½(|w_i| + |w_j|) Δt, down the
///   slope, at most
///                    the donor's sand, mean over 8; in as many sub-steps as its diffusion number needs
///   steepest         with probability (1 − v)(1 − e^(−r)), `slab`·Δt to the two steepest neighbours, by
///   their slopes
///
/// Saltation's deposit sets the angles, of every choice (without r but for adaptive_repose), in the same
/// pass: see Impacts. Reads sand, bedrock, soil, wind, wind_shadow, vegetation, moisture; writes sand and the
/// scratch layer of repose tangents.

#include "kernels/backend/for_each.hpp"
#include "kernels/field/random.hpp"
#include "kernels/sand/repose.hpp"
#include "src/core/parameters.hpp"

namespace desert_sim {

enum class ReptationMethod : int { off, adaptive_repose, smoothing, steepest };
constexpr const char* reptation_methods[] = {"off", "adaptive_repose", "smoothing", "steepest"};

struct ReptationParameters {
  ReptationMethod method = ReptationMethod::adaptive_repose;
  float strength = 0.1f;
  bool use_shadow = true;
  float slab = 0.1f;
};

constexpr auto parameter_table(const ReptationParameters*) {
  using P = ReptationParameters;
  return std::make_tuple(
      parameter("method", &P::method, reptation_methods, "How saltation's impacts move sand down the slope."),
      parameter("strength", &P::strength, 0, 10, "s/m^2", "Strength of adaptive_repose and smoothing (k_r)."),
      parameter("use_shadow", &P::use_shadow,
                "Whether adaptive_repose spares what lies in the wind's shadow."),
      parameter("slab", &P::slab, 0, 10, "m", "Sand that one event of `steepest` moves in 1 s."));
}
static_assert(table_is_complete<ReptationParameters>());

namespace reptation {

/// The angle of repose of a cell's sand where impacts of strength r [m] loosen it, in the wind's speed [m/s].
struct Angle {
  repose::Tangents tangents;
  float loosening;  ///< k_r of adaptive_repose, else 0
  float sparing;    ///< share of the loosening from which the wind's shadow spares: 1 or 0
  float* repose;

  Angle(const ReptationParameters& p, const ReposeParameters& repose_parameters, float* tangents_of_repose)
      : tangents(repose_parameters),
        loosening(p.method == ReptationMethod::adaptive_repose ? p.strength : 0.0f),
        sparing(p.use_shadow ? 1.0f : 0.0f),
        repose(tangents_of_repose) {}

  /// The tangent of dry bare sand.
  DESERT_HD float loosened(float r, float speed, float shadow) const {
    if (!(loosening > 0.0f)) return tangents.sand;
    return tangents.sand * exp_negative(loosening * r * speed * (1.0f - shadow * sparing));
  }
  /// v vegetation, m relative moisture.
  DESERT_HD float of(float dry_and_bare, float v, float m) const {
    return lerp(dry_and_bare, tangents.vegetated, v) * repose::moisture_factor(m);
  }
};

/// What saltation leaves behind in a cell: its angle, and the strength itself where somebody needs it.
struct Impacts {
  Angle angle;
  float* strength;  ///< [m], or null

  DESERT_HD void set(int i, float r, float loosened_angle, float v, float m) const {
    angle.repose[i] = angle.of(loosened_angle, v, m);
    if (strength) strength[i] = r;
  }
};

/// Angles of repose where there is no saltation that sets them.
struct SetAngles {
  Grid grid;
  Angle angle;
  const float *strength, *wind_x, *wind_y, *wind_shadow, *vegetation;  ///< strength: null where nothing hits
  repose::RelativeMoisture moisture;

  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    const float speed = hypotenuse(wind_x[i], wind_y[i]);
    const float dry = angle.loosened(value_or_zero(strength, i), speed, value_or_zero(wind_shadow, i));
    angle.repose[i] = angle.of(dry, value_or_zero(vegetation, i), moisture(i));
  }
};
template <class E>
void set_angles(E& exec, const TerrainView& t, const Angle& angle, const ReposeParameters& p,
                const float* strength) {
  for_each_cell(
      exec, t.grid,
      SetAngles{t.grid, angle, strength, t.real(Layer::wind_x), t.real(Layer::wind_y),
                t.real(Layer::wind_shadow), t.real(Layer::vegetation), repose::RelativeMoisture(t, p)});
}

/// Whether step() does anything: adaptive_repose has done with the angles.
inline bool moves_sand(const ReptationParameters& p) {
  return p.method == ReptationMethod::steepest ||
         (p.method == ReptationMethod::smoothing && p.strength > 0.0f);
}

/// What the laws below share: heights, and the change of sand that they write.
struct Surface {
  Grid grid;
  const Quanta *bedrock, *soil, *sand;
  const float *reptation_strength, *wind_x, *wind_y, *obstacle;

  DESERT_HD Quanta height(int i) const { return bedrock[i] + value_or_zero(soil, i) + sand[i]; }
  DESERT_HD float speed(int i) const { return hypotenuse(wind_x[i], wind_y[i]); }
  DESERT_HD bool solid(int i) const { return value_or_zero(obstacle, i) > 0.0f; }
};

struct SmoothingFlux {
  Surface s;
  float strength;  ///< k_r Δt / (sub-steps · l)
  Quanta* change;

  /// What i gives to its neighbour j (negative: gets), the same number whichever of the two computes it.
  DESERT_HD Quanta flux(int i, int j, int k) const {
    const Quanta drop = s.height(i) - s.height(j);
    const float steep = strength * static_cast<float>(drop < 0 ? -drop : drop) / Neighbours::distance(k) *
                        0.5f * (s.reptation_strength[i] + s.reptation_strength[j]) * 0.5f *
                        (s.speed(i) + s.speed(j));
    const Quanta available = s.sand[drop > 0 ? i : j];
    const Quanta moved = (steep < static_cast<float>(available) ? static_cast<Quanta>(steep) : available) / 8;
    return drop > 0 ? moved : -moved;
  }

  DESERT_HD void operator()(int x, int y) const {
    const int i = s.grid.index(x, y);
    Quanta given = 0;
    if (!s.solid(i))
      for (int k = 0; k < Neighbours::count; ++k) {
        const int j = neighbour_index(s.grid, x + Neighbours::dx(k), y + Neighbours::dy(k));
        if (j >= 0 && !s.solid(j)) given += flux(i, j, k);
      }
    change[i] = -given;
  }
};

/// Greatest diffusivity r |w|, which sets the number of sub-steps.
struct Diffusivity {
  Surface s;
  DESERT_HD float operator()(int x, int y) const {
    const int i = s.grid.index(x, y);
    return s.reptation_strength[i] * s.speed(i);
  }
};

struct SteepestEvent {
  Surface s;
  const float* vegetation;
  std::uint64_t seed, tick;
  float slab, quanta_per_metre;
  Quanta* change;

  DESERT_HD float chance(int cell) const {
    return random_unit(seed, Purpose::reptation, static_cast<std::uint32_t>(cell),
                       static_cast<std::uint32_t>(tick), static_cast<std::uint32_t>(tick >> 32));
  }

  DESERT_HD void operator()(int x, int y) const {
    const int i = s.grid.index(x, y);
    const float probability =
        (1.0f - value_or_zero(vegetation, i)) * (1.0f - exp_negative(s.reptation_strength[i]));
    if (s.sand[i] <= 0 || s.solid(i) || chance(i) >= probability) return;
    int first = -1, second = -1;
    float first_slope = 0.0f, second_slope = 0.0f;
    for (int k = 0; k < Neighbours::count; ++k) {
      const int j = neighbour_index(s.grid, x + Neighbours::dx(k), y + Neighbours::dy(k));
      if (j < 0 || s.solid(j)) continue;
      const float slope = static_cast<float>(s.height(i) - s.height(j)) / Neighbours::distance(k);
      if (slope > first_slope) {
        second = first;
        second_slope = first_slope;
        first = j;
        first_slope = slope;
      } else if (slope > second_slope) {
        second = j;
        second_slope = slope;
      }
    }
    if (first < 0) return;
    // No more than evens out the steepest pair, so that events do not overshoot.
    const float level = 0.5f * first_slope;
    const Quanta moved = take(minimum(slab, level / quanta_per_metre), quanta_per_metre, s.sand[i]);
    const Quanta to_second =
        second < 0 ? 0 : static_cast<Quanta>(moved * (second_slope / (first_slope + second_slope)));
    atomic_add(&change[i], -moved);
    atomic_add(&change[first], moved - to_second);
    if (second >= 0) atomic_add(&change[second], to_second);
  }
};

struct ApplyChange {
  Grid grid;
  const Quanta* change;
  Quanta* sand;
  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    sand[i] += change[i];
  }
};

/// Moves sand. Scratch: `change` (quanta) one a cell. `seed` and `tick` (steps done) draw the events of
/// `steepest`.
template <class E>
void step(E& exec, const TerrainView& t, const ReptationParameters& p, float time_step, std::uint64_t seed,
          std::uint64_t tick, const float* reptation_strength, Quanta* change) {
  if (!moves_sand(p)) return;
  const Surface surface{t.grid,
                        t.quanta(Layer::bedrock),
                        t.quanta(Layer::soil),
                        t.quanta(Layer::sand),
                        reptation_strength,
                        t.real(Layer::wind_x),
                        t.real(Layer::wind_y),
                        t.real(Layer::obstacle)};
  const ApplyChange apply{t.grid, change, t.quanta(Layer::sand)};
  if (p.method == ReptationMethod::smoothing) {
    // Stable while a cell gives less than half of what would level it with all eight: strength · r |w| ≤ ½.
    const float strength = p.strength * time_step / t.grid.cell_size;
    const float diffusivity = max_cells(exec, t.grid, Diffusivity{surface});
    const int substeps = static_cast<int>(clamp(ceilf(strength * diffusivity / 0.5f), 1.0f, 1000.0f));
    for (int n = 0; n < substeps; ++n) {
      for_each_cell(exec, t.grid, SmoothingFlux{surface, strength / substeps, change});
      for_each_cell(exec, t.grid, apply);
    }
  } else {
    exec.set_zero(change, sizeof(Quanta) * t.grid.cells());
    for_each_cell(exec, t.grid,
                  SteepestEvent{surface, t.real(Layer::vegetation), seed, tick, p.slab * time_step,
                                t.quanta_per_metre, change});
    for_each_cell(exec, t.grid, apply);
  }
}

}  // namespace reptation
}  // namespace desert_sim
