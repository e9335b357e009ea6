#include <vector>

#include "kernels/wind/wind_shadow.hpp"

namespace desert_sim::wind_shadow {

Workspace make_workspace(Exec& exec, const Grid& grid, const WindShadowParameters& p) {
  Workspace work;
  if (!p.enabled) return work;
  const int steps = march_steps(grid, p);
  std::vector<float> reciprocals(static_cast<std::size_t>(steps) + 1);
  for (int j = 1; j <= steps; ++j) reciprocals[static_cast<std::size_t>(j)] = 1.0f / static_cast<float>(j);
  work.reciprocals = Buffer<float>(exec, reciprocals.size());
  work.reciprocals.upload(reciprocals);
  if (p.curved) return work;
  const auto blocks = static_cast<std::size_t>(surface::blocks_of(grid).cells());
  work.march_directions = Buffer<MarchDirection>(exec, blocks);
  const bool fits =
      (!grid.periodic_x || grid.width % side == 0) && (!grid.periodic_y || grid.height % side == 0);
  if (fits && steps > 3 * piece_steps) work.highest_nearby = Buffer<float>(exec, blocks);
  return work;
}

}  // namespace desert_sim::wind_shadow
