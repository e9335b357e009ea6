#pragma once
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <string>

namespace desert_sim {

/// A hash of a state as 16 hexadecimal digits, as in summary.json.
inline std::string hash_text(std::uint64_t hash) {
  char text[20];
  std::snprintf(text, sizeof text, "%016" PRIx64, hash);
  return text;
}

}  // namespace desert_sim
