/// The laws and the sort of plant_order.hpp; compiled once for each backend.
#include "kernels/plants/plant_order.hpp"

#include "kernels/backend/loops.hpp"

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
  DESERT_HD void operator()(int n) const { to.copy_from(n, from, static_cast<int>(words[n] & 0xffffffffu)); }
};

/// Finds the spans of sorted plants of each cell of the look-up, and of each of its levels.
struct MarkSpans {
  Lookup lookup;
  const std::uint64_t* words;
  int count;
  Span* spans;
  DESERT_HD int key(int n) const { return static_cast<int>(words[n] >> 32); }
  DESERT_HD int level(int n) const { return lookup.cells + lookup.level_of_cell(key(n)); }
  DESERT_HD void operator()(int n) const {
    const bool first = n == 0, last = n == count - 1;
    if (first || key(n - 1) != key(n)) spans[key(n)].begin = n;
    if (last || key(n + 1) != key(n)) spans[key(n)].end = n + 1;
    if (first || level(n - 1) != level(n)) spans[level(n)].begin = n;
    if (last || level(n + 1) != level(n)) spans[level(n)].end = n + 1;
  }
};

template <class E>
void sort_plants(E& exec, int all, int dead, Workspace& work) {
  for_each_item(exec, all, Key{work.lookup, work.next_state(), work.sort_workspace.sort_keys.data()});
  sort_by_key(exec, work.sort_workspace, all, bit_width_of(static_cast<std::uint32_t>(work.lookup.cells)));
  work.count = all - dead;
  const std::uint64_t* words = work.sort_workspace.sort_keys.data();
  for_each_item(exec, work.count, Gather{words, work.next_state(), work.plants()});
  work.spans.set_zero();
  for_each_item(exec, work.count, MarkSpans{work.lookup, words, work.count, work.spans.data()});
}

template void sort_plants(Backend&, int, int, Workspace&);

}  // namespace desert_sim::plants
