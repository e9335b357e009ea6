// Bags with a GridMap.
#include "fuzz/fuzz.hpp"
#include "src/grid_map/grid_map_bag.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace desert_sim;
  const fuzz::MemoryFile file(data, size);
  return fuzz::accept_or_refuse([&] { read_grid_map(file.path()); });
}
