#include <cmath>

#include "kernels/sand/saturated_flux.hpp"

namespace desert_sim::continuum {

double saturation_length(const ContinuumParameters& p) {
  const double drag_length = static_cast<double>(p.grain_density) / p.air_density * p.grain_diameter;
  return p.saturation_length > 0 ? static_cast<double>(p.saturation_length) : 2.2 * drag_length;
}

SaturatedFlux::SaturatedFlux(const ContinuumParameters& p, double shear_velocity_per_wind) {
  const FluxLaw law = p.flux_law;
  constexpr double reference_diameter = 0.00025, of_source[] = {7.8, 1.8, 2.78, 4.2};
  const double d = p.grain_diameter, ratio = static_cast<double>(p.grain_density) / p.air_density;
  const double velocity_squared = (ratio - 1) * p.gravity * d;  // u_*² at Θ = 1
  const double c =
      p.flux_coefficient > 0 ? static_cast<double>(p.flux_coefficient) : of_source[static_cast<int>(law)];
  shields_per_wind_squared =
      static_cast<float>(shear_velocity_per_wind * shear_velocity_per_wind / velocity_squared);
  threshold = p.threshold * p.threshold;
  double q = c * velocity_squared * std::sqrt(velocity_squared) / (ratio * p.gravity);
  if (law == FluxLaw::quadratic) q = c * static_cast<double>(p.threshold) * d * std::sqrt(velocity_squared);
  if (law == FluxLaw::bagnold || law == FluxLaw::lettau) q *= std::sqrt(d / reference_diameter);
  const auto factor_if = [&](FluxLaw holds) {
    return law == holds ? static_cast<float>(q / p.packing) : 0.0f;
  };
  quadratic = factor_if(FluxLaw::quadratic);
  bagnold = factor_if(FluxLaw::bagnold);
  kawamura = factor_if(FluxLaw::kawamura);
  lettau = factor_if(FluxLaw::lettau);
}

}  // namespace desert_sim::continuum
