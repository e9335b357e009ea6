/// The laws and the sort of plant_order.hpp; compiled once for each backend.
#include "kernels/plants/plant_order.hpp"

#include "kernels/backend/loops.hpp"
#include "kernels/base/partition_point.hpp"

namespace desert_sim::plants {

struct Key {
  Lookup lookup;
  View plants;
  std::uint64_t* words;
  DESERT_HD void operator()(int n) const {
    const int key = plants.health[n] > 0.0f ? lookup.key(plants.x[n], plants.y[n], plants.radius[n])
                                            : lookup.cells;  // the dead come last
    words[n] =
        static_cast<std::uint64_t>(static_cast<std::uint32_t>(key)) << 32 | static_cast<std::uint32_t>(n);
  }
};

struct Gather {
  const std::uint64_t* words;
  View from, to;
  Neighbour* neighbours;
  DESERT_HD void operator()(int i) const {
    const int n = static_cast<int>(words[i] & 0xffffffffu);
    to.copy_from(i, from, n);
    neighbours[i] = {from.x[n], from.y[n], from.radius[n], from.z[n]};
  }
};

/// Finds the first of the sorted plants that belong to a cell of the look-up or to a later one.
struct FindBegins {
  const std::uint64_t* words;
  int count;
  std::int32_t* begins;
  DESERT_HD void operator()(int cell) const {
    begins[cell] = partition_point(count, [&](int n) { return static_cast<int>(words[n] >> 32) < cell; });
  }
};

template <class E>
void sort_plants(E& exec, int all, int dead, Workspace& work) {
  for_each_item(exec, all, Key{work.lookup, work.next_state(), work.sort_workspace.sort_keys.data()});
  sort_by_key(exec, work.sort_workspace, all, bit_width_of(static_cast<std::uint32_t>(work.lookup.cells)));
  work.count = all - dead;
  const std::uint64_t* words = work.sort_workspace.sort_keys.data();
  for_each_item(exec, work.count, Gather{words, work.next_state(), work.plants(), work.neighbours.data()});
  for_each_item(exec, work.lookup.cells + 1, FindBegins{words, work.count, work.begins.data()});
}

template void sort_plants(Backend&, int, int, Workspace&);

}  // namespace desert_sim::plants
