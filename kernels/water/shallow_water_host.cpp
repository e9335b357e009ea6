/// The workspace of shallow_water.hpp.
#include "kernels/water/shallow_water.hpp"

namespace desert_sim::shallow_water {

Workspace::Workspace(Exec& exec, const Grid& grid) {
  const auto cells = static_cast<std::size_t>(grid.cells());
  for (Buffer<float>* b :
       {&supply_share, &velocity_x[0], &velocity_x[1], &velocity_y[0], &velocity_y[1], &flux_x, &flux_y})
    *b = Buffer<float>(exec, cells);
}

std::size_t Workspace::bytes() const { return 7 * supply_share.bytes(); }

}  // namespace desert_sim::shallow_water
