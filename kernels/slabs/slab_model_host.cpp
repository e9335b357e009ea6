#include <algorithm>

#include "kernels/backend/for_each.hpp"
#include "kernels/slabs/blocks.hpp"
#include "kernels/slabs/slab_model.hpp"

namespace desert_sim::slabs {

Workspace make_workspace(Exec& exec, const Grid& grid) {
  const auto cells = static_cast<std::size_t>(grid.cells());
  Workspace work;
  for (Buffer<Quanta>* buffer : {&work.height, &work.sand, &work.shade})
    *buffer = Buffer<Quanta>(exec, cells);
  work.arriving = Buffer<std::uint32_t>(exec, cells);
  const BlockAxis x(grid.width, grid.periodic_x), y(grid.height, grid.periodic_y);
  const auto at_once = static_cast<std::size_t>(x.most_of_a_colour()) * y.most_of_a_colour();
  const int polls = most_polls(x.most_cells() * y.most_cells(), (1u << 20) / rounds_a_poll);
  work.taken = Buffer<int>(exec, at_once * static_cast<std::size_t>(polls));
  work.lines = Buffer<Quanta>(exec, words_for_lines(1, 0, std::max(grid.width, grid.height)));
  work.cliffs = Buffer<Quanta>(exec, 1);
  return work;
}

}  // namespace desert_sim::slabs
