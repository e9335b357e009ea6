#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/backend/for_each.hpp"
#include "kernels/particles/starts.hpp"
#include "kernels/particles/wang.hpp"
#include "kernels/wind/shear_stress.hpp"
#include "src/core/elementary.hpp"

namespace desert_sim::particles {

namespace {

double root_of_gravity_and_diameter(const ParticleParameters& p) {
  return std::sqrt(static_cast<double>(p.gravity) * static_cast<double>(p.grain_diameter));
}

float half_turns(float degrees) { return degrees / 180.0f; }

/// Of runs over level ground, over lift-offs evenly spread over their ranges.
struct MeanRun {
  double gain;      ///< Δv [m/s]
  double exposure;  ///< cot α, the mean over impacts [1]

  MeanRun(const ParticleParameters& p, const Air& air, float shear_velocity) {
    constexpr int parts = 8;
    const Starts starts = make_starts(p);
    double gains = 0, steepness = 0;
    int impacts = 0;
    const auto share = [](int k) { return (static_cast<float>(k) + 0.5f) / parts; };
    for (int n = 0; n < parts; ++n)
      for (int m = 0; m < parts; ++m) {
        const float up = lerp(starts.lift_lowest, starts.lift_highest, share(n)) * shear_velocity;
        const Direction angle(lerp(starts.angle_lowest, starts.angle_highest, share(m)));
        const LevelRun run = level_run(p, air, up, up * angle.cosine / angle.sine);
        gains += static_cast<double>(run.gain);
        steepness += static_cast<double>(run.steepness);
        impacts += 1 + run.bounces;
      }
    gain = gains / (parts * parts);
    exposure = steepness / impacts;
  }
};

}  // namespace

float least_rise(const ParticleParameters& p) {
  return static_cast<float>(std::sqrt(2.0) * root_of_gravity_and_diameter(p));
}

LevelRun level_run(const ParticleParameters& p, const Air& air, float up, float forward) {
  // Level ground is the same everywhere: the steps are those over the cells that are meant for the model.
  const FlatBed bed{0.01f};
  Grain g{0.0f, 0.0f, 0.0f, forward * air.along_x, forward * air.along_y, up};
  LevelRun run{0.0f, 0.0f, 0.0f, 0};
  float rise = up;
  for (;; ++run.bounces) {
    const float before = g.velocity_x * air.along_x + g.velocity_y * air.along_y;
    const Surface hit = hop(bed, air, rise, g, [](float, float) {});
    const float after = g.velocity_x * air.along_x + g.velocity_y * air.along_y;
    run.gain += after - before;
    run.steepness -= after / g.velocity_z;
    if (run.bounces == 0) run.first_hop = hypotenuse(g.x, g.y);
    rise = bounce(hit, p.normal_restitution, p.tangential_restitution, g);
    if (rise < least_rise(p) || run.bounces == p.most_bounces) return run;
  }
}

Starts make_starts(const ParticleParameters& p) {
  const double root = root_of_gravity_and_diameter(p);
  const elementary::UnitVector splash = elementary::direction_deg(p.splash_deg);
  const auto splash_number = static_cast<double>(p.splash_number);
  return {p.lift_lowest,
          p.lift_highest,
          half_turns(p.lift_lowest_deg),
          half_turns(p.lift_highest_deg),
          half_turns(p.spread_deg),
          half_turns(p.splash_spread_deg),
          static_cast<float>(splash.y),
          static_cast<float>(splash.x),
          splash_number > 0
              ? static_cast<float>(static_cast<double>(p.splash_momentum) * root / splash_number)
              : 0.0f,
          static_cast<float>(1 / (static_cast<double>(p.splash_speed) * root))};
}

Wind::Wind(const ParticleParameters& p, wind::Vector above) {
  const double speed = elementary::hypot(above.x, above.y), d = static_cast<double>(p.grain_diameter),
               roughness = 1.0 / static_cast<double>(p.grains_per_roughness) * d,
               grain = static_cast<double>(p.grain_density), density = static_cast<double>(p.air_density);
  const double kappa = shear_stress::von_karman;
  const double focus = static_cast<double>(p.focus_height), near = elementary::log(focus / roughness);
  const double at_threshold =
      static_cast<double>(p.threshold) * std::sqrt(grain / density - 1) * root_of_gravity_and_diameter(p);
  // A wind that carries no grains has one profile down to the ground.
  const double bare = kappa * speed / elementary::log(static_cast<double>(p.wind_height) / roughness);
  const double u = bare > at_threshold ? (kappa * speed - at_threshold * near) /
                                             elementary::log(static_cast<double>(p.wind_height) / focus)
                                       : bare;
  const double at_bed = std::min(u, at_threshold);
  shear_velocity = static_cast<float>(u);
  threshold = static_cast<float>(at_threshold);
  air = {{static_cast<float>(at_bed / kappa), 0.0f},
         {static_cast<float>(u / kappa), static_cast<float>((at_bed - u) / kappa * near)},
         p.focus_height,
         static_cast<float>(1 / roughness),
         static_cast<float>(0.75 * static_cast<double>(p.drag_coefficient) * density / (grain * d)),
         p.gravity,
         speed > 0 ? static_cast<float>(static_cast<double>(above.x) / speed) : 1.0f,
         speed > 0 ? static_cast<float>(static_cast<double>(above.y) / speed) : 0.0f};
  lift_rate = exposure = 0.0f;
  if (!(u > at_threshold)) return;
  const MeanRun run(p, air, shear_velocity);
  const double excess = density * (u * u - at_threshold * at_threshold);
  lift_rate = static_cast<float>(excess / (static_cast<double>(p.packing) * grain * run.gain));
  exposure = static_cast<float>(run.exposure);
}

float longest_step(const ParticleParameters& p, const Grid& grid, wind::Vector above) {
  const Wind wind(p, above);
  if (!(wind.lift_rate > 0.0f)) return std::numeric_limits<float>::infinity();
  return 0.01f * grid.cell_size / wind.lift_rate;
}

Workspace make_workspace(Exec& exec, const Grid& grid) {
  const auto cells = static_cast<std::size_t>(grid.cells());
  Workspace work;
  work.columns = Buffer<Column>(exec, cells);
  work.lines = Buffer<Quanta>(exec, words_for_lines(2, 0, std::max(grid.width, grid.height)));
  for (Buffer<Quanta>* sums : {&work.impacts, &work.splash, &work.landed})
    *sums = Buffer<Quanta>(exec, cells);
  return work;
}

}  // namespace desert_sim::particles
