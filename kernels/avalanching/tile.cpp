/// Passes over all tiles of tile.hpp; compiled once for each backend.
#include "kernels/avalanching/tile.hpp"

#include "kernels/avalanching/tuned/tile.hpp"
#include "kernels/backend/loops.hpp"

namespace desert_sim::avalanching {

template <class E>
void relax_by_law(E& exec, const RelaxTile& law) {
  for_each_tile(exec, law.tiles, law);
}

template <class E, class Then>
void relax_tiles(E& exec, const RelaxTile& law, const Then& then) {
  if constexpr (works_on_rows<E>) {
    relax_by_law(exec, law);
    if constexpr (!std::is_same_v<Then, NothingThen>) for_each_cell(exec, passed_over(then), then);
  } else {
    relax_tiles_tuned(exec, law, then);
  }
}

template void relax_by_law(Backend&, const RelaxTile&);
template void relax_tiles(Backend&, const RelaxTile&, const NothingThen&);
template void relax_tiles(Backend&, const RelaxTile&, const Restrict&);
template void relax_tiles(Backend&, const RelaxTile&, const surface::MeasureBlock&);

}  // namespace desert_sim::avalanching
