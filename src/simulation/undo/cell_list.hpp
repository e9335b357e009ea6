#pragma once
/// A list of cells on the device, whose words are read and written layer by layer.

#include <cstdint>
#include <vector>

#include "kernels/backend/buffer.hpp"

namespace desert_sim {

class CellList {
 public:
  /// `cells`: indices of cells, each once. Throws ConfigError if there is no memory.
  CellList(Exec& exec, const std::vector<int>& cells);

  /// The words that a layer (on the device) has in these cells, in their order.
  std::vector<std::uint32_t> read(const std::uint32_t* layer) const;
  void write(std::uint32_t* layer, const std::vector<std::uint32_t>& words) const;

 private:
  Exec& exec_;
  int count_;
  Buffer<int> cells_;
  Buffer<std::uint32_t> words_;
};

}  // namespace desert_sim
