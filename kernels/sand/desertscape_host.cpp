#include <limits>

#include "kernels/backend/for_each.hpp"
#include "kernels/sand/desertscape.hpp"

namespace desert_sim::desertscape {

Workspace make_workspace(Exec& exec, const Grid& grid) {
  const auto cells = static_cast<std::size_t>(grid.cells());
  return {Buffer<Quanta>(exec, cells), Buffer<Quanta>(exec, cells)};
}

float longest_step(const DesertscapeParameters& p, const SaltationParameters& saltation) {
  if (!(saltation.lift > 0.0f)) return std::numeric_limits<float>::infinity();
  return 0.25f * p.slab / saltation.lift;
}

}  // namespace desert_sim::desertscape
