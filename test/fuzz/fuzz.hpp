#pragma once
/// What the fuzzers share. Each is a libFuzzer target that scripts/test --fuzz builds and runs: input that is
/// refused throws ConfigError; any other exception, and whatever a sanitizer finds, is a failure.

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "src/core/error.hpp"

namespace desert_sim::fuzz {

/// A file in memory with these bytes, for what only reads paths.
class MemoryFile {
 public:
  MemoryFile(const void* bytes, std::size_t size) : file_(memfd_create("fuzz", MFD_CLOEXEC)) {
    if (file_ < 0 || write(file_, bytes, size) != static_cast<ssize_t>(size)) std::abort();
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() { close(file_); }
  std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

 private:
  const int file_;
};

/// Calls `read`; what it refuses is no failure.
template <class Read>
int accept_or_refuse(const Read& read) {
  try {
    read();
  } catch (const ConfigError&) {
    return 0;
  }
  return 0;
}

}  // namespace desert_sim::fuzz
