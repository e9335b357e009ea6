#pragma once
/// Parameters of the rover that `traversability` describes, and of the ground that its wheels stand in. The
/// laws are in traversability.hpp and wheel_ground.hpp. Classes of rovers are in config/rovers.

#include "src/core/parameter_table.hpp"

namespace desert_sim {

enum class WheelLaw : int { light, bekker };
constexpr const char* wheel_laws[] = {"light", "bekker"};

/// The defaults describe a wheeled rover about a metre long.
struct TraversabilityParameters {
  float slope_deg = 25.0f;
  float sand_slope_deg = 16.0f;
  float sand_depth = 0.3f;
  float sand_cost = 0.2f;
  float step_height = 0.3f;
  float roughness = 0.15f;
  float water_depth = 0.3f;
  float water_flow = 0.2f;
  float mud = 0.9f;
  float vegetation = 0.8f;
  float window = 0.5f;
  WheelLaw wheel_law = WheelLaw::bekker;
  float mass = 60.0f;
  float gravity = 9.81f;
  int wheels = 6;
  float wheel_radius = 0.15f;
  float wheel_width = 0.15f;
  float wheelbase = 0.9f;
  float drive_speed = 0.1f;
  float slip = 0.4f;
  float sinkage = 0.6f;
};

constexpr auto parameter_table(const TraversabilityParameters*) {
  using P = TraversabilityParameters;
  return std::make_tuple(
      parameter("slope_deg", &P::slope_deg, 0.1, 89, "deg",
                "Slope of firm ground that stops the rover; where looseness is known, on which it tips."),
      parameter("sand_slope_deg", &P::sand_slope_deg, 0.1, 89, "deg",
                "Slope of deep loose sand on which its wheels slip through; where looseness is known, `slip` "
                "decides instead."),
      parameter("sand_depth", &P::sand_depth, 1e-3, 1000, "m", "Depth from which sand is deep."),
      parameter("sand_cost", &P::sand_cost, 0, 1, "1",
                "What deep sand takes off the traversability of 1; where looseness is known, `slip` and "
                "`sinkage` decide instead."),
      parameter("step_height", &P::step_height, 1e-3, 1000, "m", "Step that stops the rover."),
      parameter("roughness", &P::roughness, 1e-3, 1000, "m", "Roughness that stops the rover."),
      parameter("water_depth", &P::water_depth, 1e-3, 1000, "m", "Depth of water that stops the rover."),
      parameter("water_flow", &P::water_flow, 1e-3, 1000, "m^2/s",
                "Depth x speed of water that sweeps the rover away; 0.3 for small cars."),
      parameter("mud", &P::mud, 0.501, 1000, "1",
                "Relative moisture of deep sand or soil that stops the rover; half-wet ground is firm, above "
                "1 none does."),
      parameter("vegetation", &P::vegetation, 1e-3, 1000, "1",
                "Density of plants that stops the rover; above 1 none does."),
      parameter("window", &P::window, 0, 1000, "m",
                "How far around a cell roughness and steps are looked for; at least one cell, at most 16."),
      parameter(
          "wheel_law", &P::wheel_law, wheel_laws,
          "bekker: slip and sinkage from the strength of the ground and the rover's weight; light: those "
          "measured on a small rover in dry sand."),
      parameter("mass", &P::mass, 0.1, 1e5, "kg", "Mass of the rover."),
      parameter("gravity", &P::gravity, 0.01, 100, "m/s^2", "Gravity where it drives."),
      parameter("wheels", &P::wheels, 1, 64, "1", "Number of driven wheels, which share its weight."),
      parameter("wheel_radius", &P::wheel_radius, 0.01, 10, "m", "Radius of a wheel."),
      parameter("wheel_width", &P::wheel_width, 0.005, 10, "m", "Width of a wheel."),
      parameter("wheelbase", &P::wheelbase, 0.01, 100, "m", "Distance from its first axle to its last one."),
      parameter("drive_speed", &P::drive_speed, 0, 10, "m/s", "Speed for which slip is computed."),
      parameter("slip", &P::slip, 0.01, 1, "1", "Slip that stops the rover."),
      parameter("sinkage", &P::sinkage, 0.01, 10, "1",
                "Sinkage that stops the rover, as a share of the wheel's radius."));
}
static_assert(table_is_complete<TraversabilityParameters>());

/// Soil constants at both ends of looseness, the same for all rovers.
///
///   loose    c, φ, k_c, k_φ, n: one measured set of soft sand; K of loose sand, 0.025 m: Wong, Theory of
///            Ground Vehicles
///   packed   c, φ of crusty to cloddy ground, 1.1 kPa and 34.5°: Moore et al. 1987 (Viking landing sites);
///            k_c, k_φ, n of dry sand and K of firm sand, 0.01 m: Wong
struct WheelGroundParameters {
  float assumed_looseness = 0.3f;
  float loose_cohesion = 762.0f;
  float loose_friction_deg = 22.3f;
  float loose_k_c = 1000.0f;
  float loose_k_phi = 5e5f;
  float loose_exponent = 1.1f;
  float loose_shear = 0.025f;
  float packed_cohesion = 1100.0f;
  float packed_friction_deg = 34.5f;
  float packed_k_c = 990.0f;
  float packed_k_phi = 1.528e6f;
  float packed_exponent = 1.1f;
  float packed_shear = 0.01f;
  float light_packed = 0.3f;
};

constexpr auto parameter_table(const WheelGroundParameters*) {
  using P = WheelGroundParameters;
  return std::make_tuple(
      parameter(
          "assumed_looseness", &P::assumed_looseness, 0, 1, "1",
          "Looseness of sand where the layer looseness is not in use, for the layers of slip and sinkage."),
      parameter("loose_cohesion", &P::loose_cohesion, 0, 1e6, "Pa", "Cohesion of loose sand (c)."),
      parameter("loose_friction_deg", &P::loose_friction_deg, 1, 60, "deg",
                "Angle of internal friction of loose sand (phi)."),
      parameter("loose_k_c", &P::loose_k_c, 0, 1e8, "N/m^(n+1)",
                "Cohesive modulus of loose sand under pressure (k_c)."),
      parameter("loose_k_phi", &P::loose_k_phi, 1, 1e9, "N/m^(n+2)",
                "Frictional modulus of loose sand under pressure (k_phi)."),
      parameter("loose_exponent", &P::loose_exponent, 0.3, 2, "1", "Exponent of sinkage in loose sand (n)."),
      parameter("loose_shear", &P::loose_shear, 1e-4, 1, "m", "Shear deformation modulus of loose sand (K)."),
      parameter("packed_cohesion", &P::packed_cohesion, 0, 1e6, "Pa", "Cohesion of packed ground."),
      parameter("packed_friction_deg", &P::packed_friction_deg, 1, 60, "deg",
                "Angle of internal friction of packed ground."),
      parameter("packed_k_c", &P::packed_k_c, 0, 1e8, "N/m^(n+1)", "Cohesive modulus of packed ground."),
      parameter("packed_k_phi", &P::packed_k_phi, 1, 1e9, "N/m^(n+2)",
                "Frictional modulus of packed ground."),
      parameter("packed_exponent", &P::packed_exponent, 0.3, 2, "1", "Exponent of sinkage in packed ground."),
      parameter("packed_shear", &P::packed_shear, 1e-4, 1, "m",
                "Shear deformation modulus of packed ground."),
      parameter("light_packed", &P::light_packed, 0, 1, "1",
                "Share of the slip and sinkage of the law `light` that is left on packed ground."));
}
static_assert(table_is_complete<WheelGroundParameters>());

}  // namespace desert_sim
