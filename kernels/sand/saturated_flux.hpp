#pragma once
/// The flux of sand that a wind carries when it carries all it can, as a volume of bed [m²/s].
///
///   Θ   = τ / ((ρ_s − ρ_a) g d)                  Shields number of the stress τ
///   Θ_t = a² · (1 + (∂h/∂s)/μ)₊ / dryness        its threshold, ∂h/∂s the slope along the stress
///
///   quadratic   q = C a (Θ − Θ_t) d √((ρ_s/ρ_a − 1) g d) / φ            Durán, Claudin & Andreotti 2011
///   bagnold     q = C √(d/D) (ρ_a/g) u_*³ / (ρ_s φ),  Θ > Θ_t            Bagnold 1941
///   kawamura    q = C (ρ_a/g) (u_* − u_*t)(u_* + u_*t)² / (ρ_s φ)        Kawamura 1951
///   lettau      q = C √(d/D) (ρ_a/g) u_*² (u_* − u_*t) / (ρ_s φ)         Lettau & Lettau 1978
///
/// with D = 0.25 mm, φ = `packing`, a = `threshold`, and u_*² = Θ (ρ_s/ρ_a − 1) g d. Where `flux_coefficient`
/// is 0, C is that of the source: 7.8, 1.8, 2.78, 4.2.

#include "kernels/base/math.hpp"
#include "src/core/parameter_table.hpp"

namespace desert_sim {

enum class FluxLaw : int { quadratic, bagnold, kawamura, lettau };
constexpr const char* flux_law_names[] = {"quadratic", "bagnold", "kawamura", "lettau"};

struct ContinuumParameters {
  FluxLaw flux_law = FluxLaw::quadratic;
  float flux_coefficient = 0.0f;
  float air_density = 1.225f;
  float grain_density = 2650.0f;
  float grain_diameter = 0.00025f;
  float packing = 0.6f;
  float gravity = 9.81f;
  float threshold = 0.1f;
  float saturation_length = 0.0f;
  float slope_friction = 0.6f;
  float plant_drag = 16.0f;
};

constexpr auto parameter_table(const ContinuumParameters*) {
  using P = ContinuumParameters;
  return std::make_tuple(
      parameter("flux_law", &P::flux_law, flux_law_names, "Law of the saturated flux."),
      parameter("flux_coefficient", &P::flux_coefficient, 0, 100, "1",
                "Factor C of the law; 0 is that of its source."),
      parameter("air_density", &P::air_density, 0.001, 100, "kg/m^3", "Density of the air."),
      parameter("grain_density", &P::grain_density, 100, 20000, "kg/m^3", "Density of the grains."),
      parameter("grain_diameter", &P::grain_diameter, 2e-5, 0.005, "m", "Diameter of the grains (d)."),
      parameter("packing", &P::packing, 0.3, 0.8, "1", "Share of the bed's volume that is grains."),
      parameter("gravity", &P::gravity, 0.01, 100, "m/s^2", "Gravity (g)."),
      parameter("threshold", &P::threshold, 0.01, 1, "1",
                "Threshold shear velocity over sqrt((rho_s/rho_a - 1) g d); 0.1 is the impact threshold."),
      parameter("saturation_length", &P::saturation_length, 0, 1000, "m",
                "Length over which the flux follows the wind; 0: 2.2 rho_s/rho_a d."),
      parameter("slope_friction", &P::slope_friction, 0.1, 10, "1",
                "Slope that doubles the threshold (mu), and by which sand is turned downhill."),
      parameter("plant_drag", &P::plant_drag, 0, 1000, "1",
                "Share of the stress that plants take: the ground gets 1/(1 + plant_drag v)."));
}
static_assert(table_is_complete<ContinuumParameters>());

namespace continuum {

/// L_sat [m].
double saturation_length(const ContinuumParameters& p);

/// The law with its constants; made on the host.
struct SaturatedFlux {
  float shields_per_wind_squared;              ///< Θ of a wind of 1 m/s at the height of the shear stress
  float threshold;                             ///< Θ_t of dry level sand
  float quadratic, bagnold, kawamura, lettau;  ///< factors of the laws [m²/s], of which one is not 0

  SaturatedFlux(const ContinuumParameters& p, double shear_velocity_per_wind);

  /// q [m²/s] for a Shields number and its threshold, both at least 0. All laws are computed, and those that
  /// do not hold count 0 times: compilers do not vectorise a choice that is the same for all cells.
  DESERT_HD float operator()(float shields, float at_threshold) const {
    const float root = sqrtf(shields), root_of_threshold = sqrtf(at_threshold);
    const float excess = root - root_of_threshold, sum = root + root_of_threshold;
    const float q = quadratic * (shields - at_threshold) + bagnold * shields * root +
                    (kawamura * excess * (sum * sum) + lettau * excess * shields);
    return shields > at_threshold ? q : 0.0f;
  }
};

}  // namespace continuum
}  // namespace desert_sim
