#pragma once
/// Memory that the processes of a step share. It is no state: each step computes it anew.

#include <cstdint>
#include <set>

#include "kernels/backend/buffer.hpp"
#include "kernels/field/dice.hpp"
#include "kernels/field/surface.hpp"

namespace desert_sim {

/// Fields that are there only where an active process needs them (Process::needs).
enum class SharedField { impact_strength, sand_before };

struct SharedFields {
  /// Throws ConfigError if there is no memory.
  SharedFields(Exec& exec, const Grid& grid);
  /// Allocates what the processes of a scenario need, and nothing else. Throws ConfigError.
  void prepare(Exec& exec, const Grid& grid, const std::set<SharedField>& needed);
  /// The dice of the next step.
  void roll_dice(Exec& exec, std::uint64_t seed, std::uint64_t step);

  surface::Heights heights;       ///< of the ground's surface
  bool heights_stale = true;      ///< the ground has moved since they were measured
  Buffer<float> repose;           ///< tangent of each cell's angle of repose, once its process has set it
  Buffer<float> impact_strength;  ///< of the grains that fall, as a depth of sand [m]
  Buffer<Quanta> sand_before;     ///< depth at the beginning of the step
  Dice dice;                      ///< of the present step; its keys on the device are the next buffer
  Buffer<std::uint32_t> dice_keys;

  /// A value a cell that a process needs within its step only: two fields, of any type of four bytes. The
  /// first is the memory of `repose`, which the processes before it may use.
  template <class T>
  T* scratch(int field) {
    static_assert(sizeof(T) == sizeof(std::uint32_t));
    return field == 0 ? reinterpret_cast<T*>(repose.data()) : reinterpret_cast<T*>(second_scratch.data());
  }
  Buffer<std::uint32_t> second_scratch;
};

}  // namespace desert_sim
