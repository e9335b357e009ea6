#pragma once
/// Amounts are rounded to whole quanta by dice where they are small:
///
///   quanta = ⌊amount + u⌋            amount < 256 quanta, u uniform in [0, 1)
///   quanta = ⌊amount + ½⌋            else
///
/// Rounding to nearest would stop every process that moves less than half a quantum a step, and a least
/// amount of one quantum would speed it up; with dice the expected sum over steps and cells is that of the
/// amounts, however slow the process and however short the step. Whole numbers stay as they are, so that
/// nothing flickers. From 256 quanta on, where the nearest is off by less than 0.2 %, it is taken, so that
/// the motions of dunes stay exactly symmetric.
///
/// u depends on (seed, step, roll, cell) only: a key of (seed, step, roll) by Philox, mixed with the cell's
/// number by the finaliser of MurmurHash3. A GPU reads the keys of a step from its memory, because a recorded
/// step is replayed with the same arguments; a CPU has them by value, which lets it vectorise the loops.

#include <cstdint>

#include "kernels/base/macros.hpp"
#include "kernels/base/math.hpp"
#include "kernels/base/quanta.hpp"
#include "kernels/field/random.hpp"

namespace desert_sim {

/// What a cell rolls dice for. Rolls of the same cell and step are independent of each other.
enum class Roll : int {
  lift,
  hop,
  hop_share,
  influx,
  deposit,
  abrasion,
  reptation,
  reptation_second,
  reptation_east,
  reptation_north,
  reptation_north_east,
  reptation_north_west,
  evaporation,
  seepage,
  ground_evaporation,
  moisture_east,
  moisture_north,
  soil_drying,
  soil_forming,
  dissolving,
  settling,
  humus,
  water_uptake,
  plant_height,
  pipe_x,
  pipe_y,
  sediment_x,
  sediment_y,
  slab_polls,
  slab_hops,
  particle_lift,
  particle_flight,
  particle_splash,
  particle_hop,
  particle_creep,
  slab_erosion,
  creep_events,
  count
};

/// A bijection in which each bit of the word depends on each of the argument (MurmurHash3's finaliser).
DESERT_HD std::uint32_t scrambled(std::uint32_t h) {
  h = (h ^ (h >> 16)) * 0x85ebca6bu;
  h = (h ^ (h >> 13)) * 0xc2b2ae35u;
  return h ^ (h >> 16);
}

/// Random words one after the other, from the first one.
struct RandomSequence {
  std::uint32_t word;

  DESERT_HD std::uint32_t next() {
    word = scrambled(word + 0x9e3779b9u);
    return word;
  }
  DESERT_HD float unit() { return unit_from(next()); }  ///< uniform in [0, 1)
};

/// The die of one Roll in a step.
struct Die {
  static constexpr float small = 256.0f;  ///< amounts below are rounded by dice [quanta]

  std::uint32_t key;                ///< on a CPU, and outside of steps
  const std::uint32_t* device_key;  ///< on a GPU; null outside of steps
  std::uint32_t part = 0;           ///< of a process that has several sub-steps a step
  std::uint32_t turn = 0;           ///< added to the word; see regular_die()

  Die of_part(int n) const { return {key, device_key, static_cast<std::uint32_t>(n) * 0x9e3779b9u}; }

  DESERT_HD std::uint32_t word(int cell) const {
#if defined(__CUDA_ARCH__)
    // No kernel changes the keys that it reads, so that loops may read them once.
    const std::uint32_t own_key = device_key ? __ldg(device_key) : key;
    return scrambled((static_cast<std::uint32_t>(cell) + part) ^ own_key) + turn;
#else
    return scrambled((static_cast<std::uint32_t>(cell) + part) ^ key) + turn;
#endif
  }
  /// An amount [quanta] in whole quanta, not less than 0 and not more than `available`.
  DESERT_HD Quanta whole_at_most(float amount, Quanta available, int cell) const {
    return whole_at_most(amount, available, word(cell));
  }
  /// With a word() that was read before.
  DESERT_HD static Quanta whole_at_most(float amount, Quanta available, std::uint32_t word) {
    // Without branches, so that compilers vectorise the loops around. Small amounts are 8.22 fixed point.
    const float most = static_cast<float>(available), held = minimum(maximum(amount, 0.0f), most);
    const bool few = held < small;
    const auto fixed_point = static_cast<std::int32_t>((few ? held : 0.0f) * 4194304.0f);
    const Quanta by_die = (fixed_point + static_cast<std::int32_t>(word >> 10)) >> 22;
    const Quanta rounded = few ? by_die : static_cast<Quanta>(rintf(held));
    return amount >= most ? available : rounded;
  }
  /// An amount [quanta] in whole quanta, with its sign; |amount| < 2³⁰. Nothing is there that could bound it.
  DESERT_HD Quanta whole(float amount, int cell) const {
    const float size = fabsf(amount);
    const bool few = size < small;
    const auto fixed_point = static_cast<std::int32_t>((few ? size : 0.0f) * 4194304.0f);
    const Quanta by_die = (fixed_point + static_cast<std::int32_t>(word(cell) >> 10)) >> 22;
    const Quanta rounded = few ? by_die : static_cast<Quanta>(rintf(size));
    return amount < 0.0f ? -rounded : rounded;
  }
  /// A displacement [cells, 16.16 fixed point]; if `few`, in whole cells, by a die of 16 bits.
  DESERT_HD static int whole_cells_if(bool few, int displacement, std::uint32_t die) {
    const int fraction = few ? 65535 : 0;
    return (displacement + static_cast<int>(die & static_cast<std::uint32_t>(fraction))) & ~fraction;
  }
};

/// All dice of a step.
struct Dice {
  std::uint32_t keys[static_cast<int>(Roll::count)] = {};
  const std::uint32_t* device_keys = nullptr;

  Die operator[](Roll roll) const {
    const int n = static_cast<int>(roll);
    return {keys[n], device_keys ? device_keys + n : nullptr};
  }
};

namespace dice {

/// A die that turns on by the golden ratio instead of being rolled: over successive `turns` the u of a cell
/// are spread evenly, so that an amount that hardly changes adds up to its sum within a quantum or two, not
/// within the root of their number. What carries momentum needs this, because it would answer to the noise of
/// rolls.
inline Die regular(std::uint64_t seed, Roll roll, std::uint64_t turns) {
  const std::uint32_t key =
      random_words(seed, Purpose::rounding, static_cast<std::uint32_t>(roll), 0, 0).word[0];
  return {key, nullptr, 0, static_cast<std::uint32_t>(turns) * 0x9e3779b9u};
}

/// Rolls the dice of a step. `device_keys`: memory for the keys on the device.
template <class E>
Dice roll(E& exec, std::uint64_t seed, std::uint64_t step, std::uint32_t* device_keys);

}  // namespace dice
}  // namespace desert_sim
