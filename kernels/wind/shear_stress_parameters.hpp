#pragma once
/// Parameters of the shear stress; the equations are in shear_stress.hpp.

#include "src/core/parameter_table.hpp"

namespace desert_sim {

struct ShearStressParameters {
  float wind_height = 10.0f;
  float roughness_length = 0.001f;
  float in_phase = 3.5f;
  float in_quadrature = 2.0f;
  float separation_deg = 14.0f;
  float stress_cell = 0.0f;
  float lee_slope = 1.0f / 6.0f;
  float bend_length = 4.0f;
  float longest_bubble = 120.0f;
};

constexpr auto parameter_table(const ShearStressParameters*) {
  using P = ShearStressParameters;
  return std::make_tuple(
      parameter("wind_height", &P::wind_height, 0.1, 1000, "m", "Height above ground of the given wind (z)."),
      parameter("roughness_length", &P::roughness_length, 1e-6, 0.05, "m",
                "Aerodynamic roughness of the ground (z_0)."),
      parameter("in_phase", &P::in_phase, 0, 10, "1",
                "Response of the stress that is in phase with the surface (A); 0 with the next: none."),
      parameter("in_quadrature", &P::in_quadrature, 0, 10, "1",
                "Response of the stress that leads the surface by a quarter wave (B)."),
      parameter("separation_deg", &P::separation_deg, 5, 60, "deg",
                "Slope of the lee from which on the flow separates, and of the bubble's end (beta)."),
      parameter(
          "stress_cell", &P::stress_cell, 0, 1000, "m",
          "Width of the cells on which the response is computed, if more than that of the terrain's; wider "
          "ones are faster, but from about half the saturation length on dunes become wider, too."),
      parameter("lee_slope", &P::lee_slope, 0.01, 1, "1",
                "Ground that falls less steeply from a brink on is not in its lee."),
      parameter(
          "bend_length", &P::bend_length, 0.1, 100, "1",
          "Length over which the separated flow bends down to its steepest, over the height of the brink "
          "above its lee, of which three quarters are seen behind a slip face."),
      parameter(
          "longest_bubble", &P::longest_bubble, 1, 1e5, "m",
          "Longest bubble behind a brink that lies across a periodic edge; longer ones are cut there."));
}
static_assert(table_is_complete<ShearStressParameters>());

}  // namespace desert_sim
