// Checkpoints whose checksum is right: one that is accepted is saved again as the same bytes.
#include "src/simulation/checkpoint.hpp"

#include <xxhash.h>

#include <cstring>

#include "test/fuzz/fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace desert_sim;
  static const std::unique_ptr<Exec> exec = make_exec("cpu", 1);
  std::string bytes(reinterpret_cast<const char*>(data), size);
  if (size > sizeof(XXH64_hash_t)) {
    const std::size_t body = size - sizeof(XXH64_hash_t);
    const XXH64_hash_t checksum = XXH3_64bits(bytes.data(), body);
    std::memcpy(&bytes[body], &checksum, sizeof checksum);
  }
  const fuzz::MemoryFile file(bytes.data(), bytes.size());
  return fuzz::accept_or_refuse([&] {
    const std::string saved = checkpoint_bytes(*load_checkpoint(file.path(), *exec));
    const fuzz::MemoryFile again(saved.data(), saved.size());
    try {
      if (checkpoint_bytes(*load_checkpoint(again.path(), *exec)) != saved) std::abort();
    } catch (const ConfigError&) {
      std::abort();  // what is accepted must be accepted again
    }
  });
}
