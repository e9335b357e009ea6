#include <algorithm>
#include <limits>

#include "kernels/backend/for_each.hpp"
#include "kernels/sand/continuum.hpp"
#include "src/core/constants.hpp"
#include "src/core/elementary.hpp"

namespace desert_sim::continuum {

float longest_step(const ContinuumParameters& p, const ShearStressParameters& stress, const Grid& grid,
                   float wind_speed) {
  const SaturatedFlux flux(p, shear_stress::shear_velocity_per_wind(stress));
  const double crests = 2;  // their stress over that of level ground
  const double shields = crests * flux.shields_per_wind_squared * wind_speed * wind_speed;
  const double q = flux(static_cast<float>(shields), flux.threshold);
  if (!(q > 0)) return std::numeric_limits<float>::infinity();
  const double k = pi / std::max(stress.stress_cell, grid.cell_size), length = k * saturation_length(p);
  const double slope = flux.threshold / (static_cast<double>(p.slope_friction) * shields);
  const double response = elementary::hypot(stress.in_phase, stress.in_quadrature, slope);
  constexpr double part = 1.5;
  return static_cast<float>(part * elementary::hypot(1.0, length) / (q * k * k * response));
}

Workspace make_workspace(Exec& exec, const Grid& grid) {
  const auto cells = static_cast<std::size_t>(grid.cells());
  Workspace work;
  for (Buffer<float>* buffer : {&work.lead, &work.decay, &work.gain, &work.level_gain})
    *buffer = Buffer<float>(exec, cells);
  for (Buffer<Quanta>* buffer : {&work.lying, &work.entering, &work.change, &work.out})
    *buffer = Buffer<Quanta>(exec, cells);
  work.turn = Buffer<std::uint32_t>(exec, cells);
  work.over_ends = Buffer<Quanta>(exec, 2 * static_cast<std::size_t>(std::max(grid.width, grid.height)));
  work.lines = Buffer<Quanta>(
      exec, words_for_lines(words_handed_on, reach_of_words, std::max(grid.width, grid.height)));
  return work;
}

std::size_t Workspace::bytes() const {
  return lead.bytes() + decay.bytes() + gain.bytes() + level_gain.bytes() + turn.bytes() + lying.bytes() +
         entering.bytes() + change.bytes() + out.bytes() + over_ends.bytes() + lines.bytes();
}

}  // namespace desert_sim::continuum
