#include "desert_sim/kernels/surface.hpp"

namespace desert_sim::surface {

Heights make_heights(Exec& exec, const Grid& grid) {
  const auto blocks = [](int cells) { return (cells + block_side - 1) / block_side; };
  const Grid coarse{blocks(grid.width), blocks(grid.height), grid.cell_size * block_side, grid.periodic_x,
                    grid.periodic_y};
  return {coarse, Buffer<float>(exec, static_cast<std::size_t>(grid.cells())),
          Buffer<float>(exec, static_cast<std::size_t>(coarse.cells()))};
}

}  // namespace desert_sim::surface
