/// Passes over all tiles (tile.hpp); compiled once for each backend.
#include "kernels/avalanching/tile.hpp"

#include "kernels/avalanching/tuned/tile.hpp"
#include "kernels/backend/loops.hpp"

namespace desert_sim::avalanching {

template <class E>
void relax_tiles_reference(E& exec, const RelaxTile& law) {
  for_each_tile(exec, law.tiles, law);
}

template <class E, class Then>
void relax_tiles(E& exec, const RelaxTile& law, const Then& then) {
  if constexpr (vectorises_rows<E>) {
    relax_tiles_reference(exec, law);
    if constexpr (!std::is_same_v<Then, NoFollowUp>) for_each_cell(exec, follow_up_grid(then), then);
  } else {
    relax_tiles_tuned(exec, law, then);
  }
}

template void relax_tiles_reference(Backend&, const RelaxTile&);
template void relax_tiles(Backend&, const RelaxTile&, const NoFollowUp&);
template void relax_tiles(Backend&, const RelaxTile&, const Restrict&);
template void relax_tiles(Backend&, const RelaxTile&, const surface::ComputeBlockHeights&);

}  // namespace desert_sim::avalanching
