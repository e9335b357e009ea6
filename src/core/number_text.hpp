#pragma once
/// Numbers in messages.

#include <cstdio>
#include <string>

namespace desert_sim {

/// A number with at most so many digits that count.
inline std::string number_text(double number, int digits = 3) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, number);
  return text;
}

}  // namespace desert_sim
