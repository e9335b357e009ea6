#pragma once
/// A part of the memory that a simulation holds on its backend's device.

#include <cstddef>
#include <string>

namespace desert_sim {

struct MemoryPart {
  std::string name;  ///< a layer's, a process's, or of what they share
  std::size_t bytes = 0;
};

}  // namespace desert_sim
