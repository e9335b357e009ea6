/// Functions of cell_words.hpp; compiled once for each backend.
#include "kernels/edit/cell_words.hpp"

#include "kernels/backend/for_each.hpp"
#include "kernels/backend/loops.hpp"

namespace desert_sim::brush {

struct GatherWords {
  const std::uint32_t* layer;
  const int* cells;
  std::uint32_t* words;
  DESERT_HD void operator()(int n) const { words[n] = layer[cells[n]]; }
};

struct ScatterWords {
  std::uint32_t* layer;
  const int* cells;
  const std::uint32_t* words;
  DESERT_HD void operator()(int n) const { layer[cells[n]] = words[n]; }
};

template <class E>
void gather(E& exec, const std::uint32_t* layer, const int* cells, int count, std::uint32_t* words) {
  for_each_item(exec, count, GatherWords{layer, cells, words});
}

template <class E>
void scatter(E& exec, std::uint32_t* layer, const int* cells, int count, const std::uint32_t* words) {
  for_each_item(exec, count, ScatterWords{layer, cells, words});
}

template void gather(Backend&, const std::uint32_t*, const int*, int, std::uint32_t*);
template void scatter(Backend&, std::uint32_t*, const int*, int, const std::uint32_t*);

}  // namespace desert_sim::brush
