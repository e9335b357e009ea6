#pragma once
/// Echo dunes: the eddy in front of a cliff keeps a lane free of sand, and sand piles up ahead of it. Tsoar
/// 1983, Taylor & Keyser 2023; physics.md A7.
///
///   cliff    (h(here) − h(one cell upwind))/l ≥ tan `cliff_deg`; its height H = min(rise over the cliff,
///   `highest`) erosion  a cliff of height H within `erosion_reach`·H downwind: r_e = −k_e sticky   within
///   `sticky_reach`·H: r_e = clamp(1.1 − (d − erosion_reach H)/((sticky_reach − erosion_reach) H), 0, 1)
///
/// The rise is taken over the whole cliff: from this cell upwind to where the ground stops being a cliff.
/// Erosion wins; else the stickiest cliff counts. Reads the heights, wind_x, wind_y; writes echo.

#include "kernels/field/layers.hpp"
#include "kernels/field/surface.hpp"
#include "src/core/parameters.hpp"

namespace desert_sim {

struct EchoDuneParameters {
  bool enabled = false;
  float cliff_deg = 55.0f;
  float highest = 30.0f;
  float erosion_reach = 0.4f;
  float sticky_reach = 2.0f;
  float erosion_rate = 1.0f;
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
      parameter("erosion_rate", &P::erosion_rate, 0, 10, "m", "Extra sand lifted in the lane a step (k_e)."));
}
static_assert(table_is_complete<EchoDuneParameters>());

namespace echo_dunes {

/// `cliff` is scratch memory of one float a cell.
template <class E>
void step(E& exec, const TerrainView& t, const EchoDuneParameters& p, const surface::Heights& heights,
          float* cliff);

}  // namespace echo_dunes
}  // namespace desert_sim
