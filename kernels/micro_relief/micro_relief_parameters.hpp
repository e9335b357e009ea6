#pragma once
/// Parameters of the micro-relief of the surface; the equations are in ripple_size.hpp, ripples.hpp and
/// bumps.hpp.

#include "src/core/parameter_table.hpp"

namespace desert_sim {

struct MicroReliefParameters {
  bool ripples = true;
  float threshold_speed = 1.0f;
  float shortest = 0.013f;
  float longest = 0.3f;
  float growth = 0.02f;
  float steepness = 0.0467f;
  float celerity = 1e-4f;
  float asymmetry = 0.5f;
  float response_time = 600.0f;
  float crest_length = 0.5f;
  bool bumps = true;
  float bump_height = 0.1f;
  float bump_radius = 0.4f;
  float bump_lee = 0.3f;
};

constexpr auto parameter_table(const MicroReliefParameters*) {
  using P = MicroReliefParameters;
  return std::make_tuple(
      parameter("ripples", &P::ripples, "Whether there are wind ripples."),
      parameter("threshold_speed", &P::threshold_speed, 0.1, 50, "m/s",
                "Speed of the wind at the surface above which ripples form."),
      parameter("shortest", &P::shortest, 0.005, 0.1, "m", "Wavelength of ripples at the threshold."),
      parameter("longest", &P::longest, 0.1, 1, "m", "Wavelength that they do not exceed."),
      parameter("growth", &P::growth, 0, 1, "s", "Wavelength per metre a second above the threshold."),
      parameter("steepness", &P::steepness, 0, 0.1, "1", "Height from trough to crest over wavelength."),
      parameter("celerity", &P::celerity, 0, 0.01, "1",
                "Speed of ripples over that of the wind above the threshold."),
      parameter("asymmetry", &P::asymmetry, 0, 0.9, "1",
                "How much steeper the lee side is in a wind of one direction; 0: a sine wave."),
      parameter("response_time", &P::response_time, 1, 1e9, "s",
                "Time in which ripples adapt to another wind: that of the running mean of the wind."),
      parameter("crest_length", &P::crest_length, 0.4, 10, "m",
                "Size of the patches in which crests are straight; they fork and end where patches meet."),
      parameter("bumps", &P::bumps,
                "Whether there are heaps of sand at plants and at the edges of obstacles."),
      parameter("bump_height", &P::bump_height, 0, 2, "m", "Height of the largest heap."),
      parameter("bump_radius", &P::bump_radius, 0.05, 5, "m",
                "Radius of a heap; on a square of 2.5 radii there is one at most."),
      parameter("bump_lee", &P::bump_lee, 0, 1, "1", "Height of the heap in the lee over the windward one."));
}
static_assert(table_is_complete<MicroReliefParameters>());

}  // namespace desert_sim
