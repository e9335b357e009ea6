// Journals.
#include "src/simulation/journal.hpp"

#include "test/fuzz/fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace desert_sim;
  const fuzz::MemoryFile file(data, size);
  return fuzz::accept_or_refuse([&] { read_journal(file.path()); });
}
