#pragma once
/// Text without regard to case.

#include <algorithm>
#include <string>

namespace desert_sim {

/// The text with A…Z as a…z, whatever the locale.
inline std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

}  // namespace desert_sim
