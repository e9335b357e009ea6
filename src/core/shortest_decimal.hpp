#pragma once
/// Single-precision numbers as people write them.

#include <cstdio>
#include <cstdlib>

namespace desert_sim {

/// The shortest decimal number that is this float: 0.3, not 0.300000012.
inline double shortest_decimal(float value) {
  char text[32];
  for (int digits = 6; digits <= 9; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, static_cast<double>(value));
    if (std::strtof(text, nullptr) == value) break;
  }
  return std::strtod(text, nullptr);
}

}  // namespace desert_sim
