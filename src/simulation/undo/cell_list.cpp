#include "src/simulation/undo/cell_list.hpp"

#include "kernels/edit/cell_words.hpp"

namespace desert_sim {

CellList::CellList(Exec& exec, const std::vector<int>& cells)
    : exec_(exec), count_(static_cast<int>(cells.size())) {
  if (count_ == 0) return;
  cells_ = Buffer<int>(exec, cells.size());
  words_ = Buffer<std::uint32_t>(exec, cells.size());
  cells_.upload(cells);
}

std::vector<std::uint32_t> CellList::read(const std::uint32_t* layer) const {
  if (count_ == 0) return {};
  with_backend(exec_, [&](auto& e) { brush::gather(e, layer, cells_.data(), count_, words_.data()); });
  return words_.download();
}

void CellList::write(std::uint32_t* layer, const std::vector<std::uint32_t>& words) const {
  if (count_ == 0) return;
  exec_.upload(words_.data(), words.data(), words.size() * sizeof(std::uint32_t));
  with_backend(exec_, [&](auto& e) { brush::scatter(e, layer, cells_.data(), count_, words_.data()); });
}

}  // namespace desert_sim
