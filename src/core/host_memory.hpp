#pragma once
/// Memory of this machine.

#include <cstddef>

namespace desert_sim {

/// Memory that the host can still allocate [bytes], within the limit of its control group.
std::size_t host_memory_available();

}  // namespace desert_sim
