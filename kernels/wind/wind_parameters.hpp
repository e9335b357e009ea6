#pragma once
/// Parameters of the wind; the equations are in wind.hpp.

#include "src/core/parameter_table.hpp"

namespace desert_sim {

/// How the terrain speeds up the wind.
enum class SpeedUpLaw : int { jackson_hunt, venturi };
constexpr const char* speedup_law_names[] = {"jackson_hunt", "venturi"};

struct WindParameters {
  SpeedUpLaw speedup_law = SpeedUpLaw::jackson_hunt;
  float speedup_response = 2.13f;
  float response_lowest = 1.0f;
  float response_highest = 1.25f;
  float speedup = 0.005f;
  float speedup_lowest = 0.5f;
  float speedup_highest = 3.0f;
  bool warping = true;
  ShortList radii{{200, 50, 0, 0}, 2};
  ShortList weights{{0.8f, 0.2f, 0, 0}, 2};
  ShortList deflections{{30, 5, 0, 0}, 2};
  float gradient_scale = 1.0f;
  bool projection = true;
  int coarsening = 0;
};

constexpr auto parameter_table(const WindParameters*) {
  using P = WindParameters;
  return std::make_tuple(
      parameter(
          "speedup_law", &P::speedup_law, speedup_law_names,
          "jackson_hunt: crests are faster by 2 H/L; venturi, and always without projection: by height."),
      parameter("speedup_response", &P::speedup_response, 0, 4, "1",
                "Speed-up of jackson_hunt over that of potential flow; 2.13 gives 2 H/L at a ridge's crest."),
      parameter("response_lowest", &P::response_lowest, 0.05, 1, "1",
                "Factor that jackson_hunt approaches in hollows; 1 leaves slow air to the wind shadow."),
      parameter("response_highest", &P::response_highest, 1, 10, "1",
                "Factor that jackson_hunt approaches over steep crests; 2 H/L is a law for small slopes."),
      parameter("speedup", &P::speedup, 0, 1, "1/m",
                "Speed-up of venturi per metre above the low ground (the 1st percentile at load)."),
      parameter("speedup_lowest", &P::speedup_lowest, 0, 1, "1", "Least factor of venturi."),
      parameter("speedup_highest", &P::speedup_highest, 1, 10, "1", "Greatest factor of venturi."),
      parameter("warping", &P::warping, "Whether the terrain deflects the wind."),
      parameter("radii", &P::radii, 1, 5000, "m",
                "Radii of the smoothed terrains that deflect the wind; sigma is half of each."),
      parameter("weights", &P::weights, 0, 100, "1", "Weight of each radius."),
      parameter("deflections", &P::deflections, 0, 1000, "1", "Strength of deflection of each radius."),
      parameter("gradient_scale", &P::gradient_scale, 0, 10, "1",
                "Scale of the smoothed terrains' gradients; small values let wind reach obstacles."),
      parameter("projection", &P::projection,
                "Whether the flux of air over the ground is made free of divergence."),
      parameter("coarsening", &P::coarsening, 0, 64, "cells",
                "Cells of the terrain per cell of the FFT grid; 0 chooses a quarter of the smallest sigma."));
}
static_assert(table_is_complete<WindParameters>());

}  // namespace desert_sim
