#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/sand/continuum.hpp"
#include "kernels/sand/continuum_laws.hpp"
#include "src/core/constants.hpp"

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
  const double response = std::hypot(stress.in_phase, stress.in_quadrature, slope);
  constexpr double part = 1.5;
  return static_cast<float>(part * std::hypot(1.0, length) / (q * k * k * response));
}

Workspace make_workspace(Exec& exec, const Grid& grid) {
  const auto cells = static_cast<std::size_t>(grid.cells());
  Workspace work;
  for (Buffer<float>* buffer : {&work.decay, &work.gain}) *buffer = Buffer<float>(exec, cells);
  for (Buffer<Quanta>* buffer : {&work.shift, &work.lying, &work.entering, &work.change, &work.out})
    *buffer = Buffer<Quanta>(exec, cells);
  work.sides = Buffer<std::uint32_t>(exec, cells);
  work.lines = Buffer<Quanta>(
      exec, words_for_lines(HandedOn::places, HandedOn::reach, std::max(grid.width, grid.height)));
  return work;
}

std::size_t Workspace::bytes() const {
  return decay.bytes() + gain.bytes() + shift.bytes() + sides.bytes() + lying.bytes() + entering.bytes() +
         change.bytes() + out.bytes() + lines.bytes();
}

}  // namespace desert_sim::continuum
