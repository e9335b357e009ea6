/// The keys of dice.hpp; compiled once for each backend.
#include "kernels/field/dice.hpp"

#include "kernels/backend/loops.hpp"
#include "kernels/field/random.hpp"

namespace desert_sim::dice {

struct StoreKey {
  Dice dice;
  std::uint32_t* device_keys;
  DESERT_HD void operator()(int roll) const { device_keys[roll] = dice.keys[roll]; }
};

inline std::uint32_t key_of(std::uint64_t seed, int roll, std::uint64_t step) {
  return random_words(seed, Purpose::rounding, static_cast<std::uint32_t>(roll),
                      static_cast<std::uint32_t>(step), static_cast<std::uint32_t>(step >> 32))
      .word[0];
}

template <class E>
Dice roll(E& exec, std::uint64_t seed, std::uint64_t step, std::uint32_t* device_keys) {
  Dice dice;
  constexpr int count = static_cast<int>(Roll::count);
  for (int n = 0; n < count; ++n) dice.keys[n] = key_of(seed, n, step);
  dice.device_keys = device_keys;
  for_each_item(exec, count, StoreKey{dice, device_keys});
  return dice;
}

template Dice roll(Backend&, std::uint64_t, std::uint64_t, std::uint32_t*);

}  // namespace desert_sim::dice
