#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "kernels/sand/continuum.hpp"
#include "src/core/constants.hpp"
#include "src/core/error.hpp"

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

/// A GPU keeps what a line hands on in the memory that a block of threads shares.
void require_lines_that_fit(const Exec& exec, const Grid& grid) {
  if (std::string(exec.backend()) != "cuda") return;
  constexpr std::size_t bytes_a_place = 2 * 4 * 5, most_places = 8192, every_gpu_has = 48 * 1024;
  const std::size_t memory = std::max(every_gpu_has, exec.memory_for_lines());
  const std::size_t longest = std::min(most_places, memory / bytes_a_place);
  for (const auto& [key, cells] :
       {std::pair{"grid.width", grid.width}, std::pair{"grid.height", grid.height}})
    if (static_cast<std::size_t>(cells) > longest)
      throw ConfigError("saltation.model: continuum on this GPU: " + std::string(key) + ": = " +
                        std::to_string(cells) + " (allowed: at most " + std::to_string(longest) + ")");
}

Workspace make_workspace(Exec& exec, const Grid& grid) {
  require_lines_that_fit(exec, grid);
  const auto cells = static_cast<std::size_t>(grid.cells());
  Workspace work;
  for (Buffer<float>* buffer : {&work.decay, &work.gain}) *buffer = Buffer<float>(exec, cells);
  for (Buffer<Quanta>* buffer : {&work.shift, &work.lying, &work.entering, &work.change, &work.out})
    *buffer = Buffer<Quanta>(exec, cells);
  work.sides = Buffer<std::uint32_t>(exec, cells);
  return work;
}

std::size_t Workspace::bytes() const {
  return decay.bytes() + gain.bytes() + shift.bytes() + sides.bytes() + lying.bytes() + entering.bytes() +
         change.bytes() + out.bytes();
}

}  // namespace desert_sim::continuum
