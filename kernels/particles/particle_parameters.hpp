#pragma once
/// Parameters of the particle model; see wang.hpp.

#include "src/core/parameter_table.hpp"

namespace desert_sim {

/// Grain, air, lift-off and roughness are those of Wang & Hu 2012, but for the diameter, of which a later
/// account says 15 mm: 0.15 mm is meant. Threshold and focus are Bagnold's (1941). The shelter ends six
/// heights behind a crest, where a separated flow comes back to the ground. ℓ is the longest distance of
/// real ripples, and z_e lies in the middle of the layer in which most grains fly; it sets how high ripples
/// become. A bounce leaves up to half the speed (Rice et al. 1995 found 0.5 to 0.6). a_s is that of Kok &
/// Renno 2009, and α twice their 0.15, because thrown grains have to cross cells of a centimetre. λ_c was
/// chosen so that bumps of single cells vanish.
struct ParticleParameters {
  float grain_diameter = 0.00015f;
  float grain_density = 2655.0f;
  float air_density = 1.1644f;
  float drag_coefficient = 0.5f;
  float gravity = 9.81f;
  float packing = 0.6f;
  float threshold = 0.1f;
  float wind_height = 10.0f;
  float focus_height = 0.003f;
  float lift_lowest = 0.8f;
  float lift_highest = 2.0f;
  float lift_lowest_deg = 21.0f;
  float lift_highest_deg = 90.0f;
  float spread_deg = 15.0f;
  float normal_restitution = 0.5f;
  float tangential_restitution = 0.4f;
  int most_bounces = 12;
  float shelter_deg = 10.0f;
  float upwind_length = 0.3f;
  float exposed_height = 0.007f;
  float splash_number = 0.02f;
  float splash_momentum = 0.3f;
  float splash_deg = 50.0f;
  float splash_spread_deg = 30.0f;
  float creep_length = 0.004f;
  float splash_speed = 40.0f;
  float grains_per_roughness = 30.0f;
  float shear_height = 10.0f;
};

constexpr auto parameter_table(const ParticleParameters*) {
  using P = ParticleParameters;
  return std::make_tuple(
      parameter("grain_diameter", &P::grain_diameter, 2e-5, 0.005, "m", "Diameter of the grains (d)."),
      parameter("grain_density", &P::grain_density, 100, 20000, "kg/m^3", "Density of the grains (rho_s)."),
      parameter("air_density", &P::air_density, 0.001, 100, "kg/m^3", "Density of the air (rho_a)."),
      parameter("drag_coefficient", &P::drag_coefficient, 0.01, 10, "1",
                "Drag coefficient of a grain (C_d)."),
      parameter("gravity", &P::gravity, 0.01, 100, "m/s^2", "Gravity (g)."),
      parameter("packing", &P::packing, 0.3, 0.8, "1", "Share of the bed's volume that is grains."),
      parameter("threshold", &P::threshold, 0.01, 1, "1",
                "Threshold shear velocity over sqrt((rho_s/rho_a - 1) g d) (a)."),
      parameter("wind_height", &P::wind_height, 0.1, 1000, "m", "Height above ground of the given wind."),
      parameter("focus_height", &P::focus_height, 1e-4, 0.1, "m",
                "Height below which flying grains hold the wind at its threshold (z_f)."),
      parameter("lift_lowest", &P::lift_lowest, 0.1, 5, "1",
                "Lowest vertical speed of grains that lift off, over the shear velocity (B)."),
      parameter("lift_highest", &P::lift_highest, 0.1, 5, "1", "Highest of the same."),
      parameter("lift_lowest_deg", &P::lift_lowest_deg, 5, 90, "deg", "Lowest angle of lift-off."),
      parameter("lift_highest_deg", &P::lift_highest_deg, 5, 90, "deg", "Highest angle of lift-off."),
      parameter("spread_deg", &P::spread_deg, 0, 60, "deg",
                "Standard deviation of the directions of lift-off about that of the wind."),
      parameter("normal_restitution", &P::normal_restitution, 0, 0.95, "1",
                "Share of the speed normal to the ground that a bounce leaves."),
      parameter("tangential_restitution", &P::tangential_restitution, 0, 1, "1",
                "Share of the speed along the ground that a bounce leaves."),
      parameter("most_bounces", &P::most_bounces, 0, 100, "1", "Bounces after which a grain stays."),
      parameter("shelter_deg", &P::shelter_deg, 1, 80, "deg",
                "Angle at which the shelter behind a crest comes down to the ground."),
      parameter("upwind_length", &P::upwind_length, 0.01, 100, "m",
                "Length (l) over which the ground upwind counts as the level from which crests stand out."),
      parameter("exposed_height", &P::exposed_height, 0.001, 10, "m",
                "Height (z_e) at which crests meet the wind above that level."),
      parameter("splash_number", &P::splash_number, 0, 1, "1",
                "Grains that an impact throws up, for a speed of sqrt(g d) (a_s); 0: none."),
      parameter("splash_momentum", &P::splash_momentum, 0, 1, "1",
                "Share of the momentum of an impact that they carry away."),
      parameter("splash_deg", &P::splash_deg, 5, 85, "deg", "Angle at which they are thrown up."),
      parameter("splash_spread_deg", &P::splash_spread_deg, 0, 60, "deg",
                "Standard deviation of their directions about that of the wind."),
      parameter("creep_length", &P::creep_length, 0, 1, "m",
                "How far what impacts throw up creeps, too, down a slope of 1."),
      parameter("splash_speed", &P::splash_speed, 1, 1e4, "1",
                "Speed of an impact, over sqrt(g d), at which what it throws up has 1 - 1/e of its greatest "
                "speed (n_s; Kok & Renno 2009)."),
      parameter("grains_per_roughness", &P::grains_per_roughness, 1, 1000, "1",
                "Diameter of the grains over the roughness length of the bed, d/z_0 (n_0; Wang & Hu 2012)."),
      parameter("shear_height", &P::shear_height, 1, 1e4, "1",
                "Height, in grains, of the wind by which a shelter lessens the lift."));
}
static_assert(table_is_complete<ParticleParameters>());

}  // namespace desert_sim
