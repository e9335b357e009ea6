#pragma once
/// The key `seed` of a scenario as a table of its own.

#include "src/core/parameter_table.hpp"

namespace desert_sim {

struct SeedParameter {
  std::uint64_t seed = 1;
};
constexpr auto parameter_table(const SeedParameter*) {
  return std::make_tuple(
      parameter("seed", &SeedParameter::seed, 0, highest_uint64, "1", "Seed of all random numbers."));
}
static_assert(table_is_complete<SeedParameter>());

}  // namespace desert_sim
