#include "desert_sim/kernels/wind_shadow.hpp"

namespace desert_sim::wind_shadow {

Workspace make_workspace(Exec& exec, const Grid& grid, const WindShadowParameters& p) {
  Workspace work;
  constexpr int side = Blocks::side;
  const bool fits =
      (!grid.periodic_x || grid.width % side == 0) && (!grid.periodic_y || grid.height % side == 0);
  if (!p.enabled || p.curved || !fits || march_steps(grid, p) <= Blocks::piece) return work;
  work.blocks = Grid{(grid.width + side - 1) / side, (grid.height + side - 1) / side, grid.cell_size * side,
                     grid.periodic_x, grid.periodic_y};
  const std::size_t count = static_cast<std::size_t>(work.blocks.cells());
  work.highest = Buffer<Quanta>(exec, count);
  work.around = Buffer<Quanta>(exec, count);
  return work;
}

}  // namespace desert_sim::wind_shadow
