#pragma once
/// The light on wind ripples as a picture that can be laid side by side over any sand: drawn on ground
/// whose cells are far larger than ripples.

#include <desert_sim/MicroReliefState.h>

#include <cstdint>
#include <vector>

namespace desert_sim {

struct RippleTile {
  static constexpr int pixels = 512;  ///< on a side
  float side = 1;                     ///< length of a side [m]
  std::vector<std::uint8_t>
      brightness;  ///< row-major from the south-west: 128 times the light over that on level ground
};

/// Whether ripples of these two states look different: by more than 3 degrees in direction, or a twentieth
/// in size.
bool ripples_differ(const MicroReliefState& a, const MicroReliefState& b);

/// Ripples of this state's wind, by the law of kernels/micro_relief/ripples.hpp on level ground with a
/// lattice that repeats, in the light of src/render/sunlight.hpp. Without ripples all is 128.
RippleTile ripple_tile(const MicroReliefState& state);

}  // namespace desert_sim
