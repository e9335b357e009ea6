#include "src/core/host_memory.hpp"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace desert_sim {

namespace {

std::size_t machine_memory_available() {
  std::ifstream info("/proc/meminfo");
  std::string key, unit;
  std::size_t kilobytes;
  while (info >> key >> kilobytes >> unit)
    if (key == "MemAvailable:") return kilobytes * 1024;
  return static_cast<std::size_t>(sysconf(_SC_AVPHYS_PAGES)) *
         static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

/// Memory left within the limit of a container (control groups, version 2). Cached files count as free,
/// because they can be dropped.
std::size_t group_memory_available() {
  constexpr std::size_t unlimited = std::numeric_limits<std::size_t>::max();
  const std::string folder = "/sys/fs/cgroup/memory.";
  std::size_t most = 0, used = 0, cached = 0;
  if (!(std::ifstream(folder + "max") >> most) || !(std::ifstream(folder + "current") >> used))
    return unlimited;  // the limit reads "max", or there is no control group
  std::ifstream parts(folder + "stat");
  std::string key;
  std::size_t bytes;
  while (parts >> key >> bytes)
    if (key == "inactive_file") cached = bytes;
  const std::size_t held = used - std::min(used, cached);
  return most - std::min(most, held);
}

}  // namespace

std::size_t host_memory_available() { return std::min(machine_memory_available(), group_memory_available()); }

}  // namespace desert_sim
