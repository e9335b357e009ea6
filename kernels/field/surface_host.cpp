#include "kernels/field/surface.hpp"

namespace desert_sim::surface {

Grid blocks_of(const Grid& grid) {
  const auto blocks = [](int cells) { return (cells + block_side - 1) / block_side; };
  return {blocks(grid.width), blocks(grid.height), grid.cell_size * block_side, grid.periodic_x,
          grid.periodic_y};
}

Heights make_heights(Exec& exec, const Grid& grid) {
  const Grid blocks = blocks_of(grid);
  return {blocks, Buffer<float>(exec, static_cast<std::size_t>(grid.cells())),
          Buffer<float>(exec, static_cast<std::size_t>(blocks.cells()))};
}

}  // namespace desert_sim::surface
