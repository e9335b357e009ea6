#pragma once
/// Text of strangers in messages.

#include <string>

namespace desert_sim {

/// In single quotes, and not longer than what a person reads: requests can hold megabytes.
inline std::string quoted(const std::string& text) {
  constexpr std::size_t longest = 60;
  return "'" + (text.size() <= longest ? text : text.substr(0, longest) + "...") + "'";
}

}  // namespace desert_sim
