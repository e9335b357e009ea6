#include <algorithm>

#include "kernels/backend/for_each.hpp"
#include "kernels/slabs/slab_laws.hpp"
#include "src/core/elementary.hpp"

namespace desert_sim::slabs {

float fresh_density(float temperature) {
  return static_cast<float>(67.92 + 51.25 * elementary::exp(static_cast<double>(temperature) / 2.59));
}

Workspace make_workspace(Exec& exec, const Grid& grid, bool resists) {
  // Lines lie along either axis, as the wind has it.
  const auto most = [&](auto words) {
    return std::max(words(grid.width, grid.height), words(grid.height, grid.width));
  };
  const std::size_t words = most(Lattice::words);
  const std::size_t taken = most([](int lines, int length) {
    return static_cast<std::size_t>(lines) * static_cast<std::size_t>(Taken::capacity_of(length));
  });
  const auto longest = static_cast<std::size_t>(std::max(grid.width, grid.height));
  Workspace work;
  for (Buffer<Quanta>* buffer : {&work.height, &work.base, &work.shade})
    *buffer = Buffer<Quanta>(exec, words);
  work.state = Buffer<std::uint8_t>(exec, words);
  work.pending = Buffer<std::uint32_t>(exec, words);
  work.taken_cells = Buffer<std::uint32_t>(exec, taken);
  work.taken_counts = Buffer<int>(exec, longest);
  work.cliffs = Buffer<Quanta>(exec, 1);
  if (resists) work.resistance = Buffer<float>(exec, words);
  return work;
}

}  // namespace desert_sim::slabs
