#pragma once
/// Memory that the processes of a step share. It is no state: each step computes it anew.

#include "kernels/backend/buffer.hpp"
#include "kernels/field/dice.hpp"
#include "kernels/field/surface.hpp"
#include "src/scenario/scenario.hpp"

namespace desert_sim {

struct SharedFields {
  /// Throws ConfigError if there is no memory.
  SharedFields(Exec& exec, const Grid& grid);
  /// What depends on parameters.
  void prepare(Exec& exec, const Grid& grid, const Scenario& scenario);
  /// The dice of the next step.
  void roll_dice(Exec& exec, std::uint64_t seed, std::uint64_t step);

  surface::Heights heights;   ///< of the ground's surface
  bool heights_stale = true;  ///< the ground has moved since they were measured
  Buffer<float> repose;  ///< tangent of each cell's angle of repose; before saltation sets it, scratch memory
  Buffer<float>
      impact_strength;         ///< of saltation, for reptation that moves sand and looseness [m]; else empty
  Buffer<Quanta> sand_before;  ///< depth before what looseness follows; empty without it
  Buffer<Quanta> landed;       ///< sand that comes down in saltation; before and after it, scratch memory
  Dice dice;                   ///< of the present step; its keys on the device are the next buffer
  Buffer<std::uint32_t> dice_keys;
};

}  // namespace desert_sim
