/// The hash by which two states are compared.
#include <xxhash.h>

#include <memory>

#include "src/core/error.hpp"
#include "src/simulation/state/state.hpp"

namespace desert_sim {

std::uint64_t SimulationState::hash() const {
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> owned(XXH3_createState(), XXH3_freeState);
  XXH3_state_t* const sum = owned.get();
  if (!sum) throw Error("the memory for the state hash cannot be allocated");
  XXH3_64bits_reset(sum);
  for (const LayerInfo& row : layer_table) {
    if (!is_part(row.layer)) continue;
    const std::vector<std::uint32_t> words = terrain.raw_words(row.layer);
    XXH3_64bits_update(sum, row.name, std::char_traits<char>::length(row.name));
    XXH3_64bits_update(sum, words.data(), words.size() * sizeof(std::uint32_t));
  }
  if (plants) {
    const std::vector<std::uint32_t> words = plants::words(plants);
    XXH3_64bits_update(sum, "plants", 6);
    XXH3_64bits_update(sum, words.data(), words.size() * sizeof(std::uint32_t));
  }
  const std::vector<long long> accounts = read_ledger();
  XXH3_64bits_update(sum, accounts.data(), accounts.size() * sizeof(long long));
  XXH3_64bits_update(sum, &steps, sizeof steps);
  if (const double now = time(); clock_origin.step > 0)  // where steps alone do not tell the time
    XXH3_64bits_update(sum, &now, sizeof now);
  return XXH3_64bits_digest(sum);
}

}  // namespace desert_sim
