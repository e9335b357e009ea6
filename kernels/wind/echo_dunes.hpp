#pragma once
/// Echo dunes: the vortex in front of a cliff keeps a lane free of sand, and sand piles up upwind of that
/// lane. Tsoar 1983; Taylor & Keyser 2023; Nilles 2024 §3.5.
///
///   cliff     (h(here) − h(one cell upwind))/l ≥ tan `cliff_deg`,   H = min(rise, `highest`)
///   erosion   r_e = −k_e                                       where d ≤ d_e
///   sticky    r_e = clamp(r_0 − (d − d_e)/(d_s − d_e), 0, 1)   where d_e < d ≤ d_s
///             d_e = `erosion_reach` H,   d_s = `sticky_reach` H,   r_0 = `sticky_start`
///
/// H is the height of the cliff: its rise from where, upwind of the cell, the ground stops being a cliff. d
/// is the distance from a cell downwind to the cliff. Where several cliffs lie downwind, erosion has
/// precedence over sticky, and otherwise the largest r_e counts. Reads bedrock, soil and sand through
/// `heights`, wind_x, wind_y; writes echo.

#include "kernels/field/layers.hpp"
#include "kernels/field/surface.hpp"
#include "src/core/parameter_table.hpp"

namespace desert_sim {

struct EchoDuneParameters {
  bool enabled = false;
  float cliff_deg = 55.0f;
  float highest = 30.0f;
  float erosion_reach = 0.4f;
  float sticky_reach = 2.0f;
  float erosion_rate = 1.0f;
  float sticky_start = 1.1f;
  float sticky_lift = 0.5f;
};

constexpr auto parameter_table(const EchoDuneParameters*) {
  using P = EchoDuneParameters;
  return std::make_tuple(
      parameter("enabled", &P::enabled, "Whether cliffs hold sand off and pile it up ahead of them."),
      parameter("cliff_deg", &P::cliff_deg, 30, 89, "deg", "Windward slope from which ground is a cliff."),
      parameter("highest", &P::highest, 0.1, 500, "m", "Height at which a cliff's effect stops growing."),
      parameter("erosion_reach", &P::erosion_reach, 0, 10, "1",
                "Length of the sand-free lane, in heights of the cliff."),
      parameter("sticky_reach", &P::sticky_reach, 0, 20, "1",
                "How far ahead sand is held, in heights of the cliff."),
      parameter("erosion_rate", &P::erosion_rate, 0, 10, "m", "Extra sand lifted in the lane a step (k_e)."),
      parameter(
          "sticky_start", &P::sticky_start, 0, 10, "1",
          "Share of sand that is held at the lane; it falls by 1 to the end of sticky_reach, and above 1 "
          "all is held (Taylor & Keyser 2023)."),
      parameter("sticky_lift", &P::sticky_lift, 0, 1, "1",
                "Share of the lift that is left where sand is held (Taylor & Keyser 2023: 1/2)."));
}
static_assert(table_is_complete<EchoDuneParameters>());

namespace echo_dunes {

/// `cliff`: scratch, one float a cell.
template <class E>
void step(E& exec, const TerrainView& t, const EchoDuneParameters& p, const surface::Heights& heights,
          float* cliff);

}  // namespace echo_dunes
}  // namespace desert_sim
