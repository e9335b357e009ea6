#pragma once
/// Parameters of the wind shadow; the equations are in wind_shadow.hpp.

#include "src/core/parameter_table.hpp"

namespace desert_sim {

struct WindShadowParameters {
  bool enabled = true;
  float distance = 10.0f;
  float start_deg = 10.0f;
  float full_deg = 15.0f;
  bool curved = false;
};

constexpr auto parameter_table(const WindShadowParameters*) {
  using P = WindShadowParameters;
  return std::make_tuple(
      parameter("enabled", &P::enabled, "Whether terrain shelters the ground behind it."),
      parameter("distance", &P::distance, 0, 1000, "m",
                "How far upwind shelter is looked for; at least one cell."),
      parameter("start_deg", &P::start_deg, 0, 89, "deg", "Angle to the shelter at which shadow begins."),
      parameter("full_deg", &P::full_deg, 0, 89, "deg", "Angle to the shelter from which shadow is full."),
      parameter("curved", &P::curved, "Whether the march follows the wind as it turns."));
}
static_assert(table_is_complete<WindShadowParameters>());

}  // namespace desert_sim
