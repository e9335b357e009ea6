#pragma once
/// Text of strangers in messages.

#include <string>

namespace desert_sim {

/// Not longer than what a person reads: requests can hold megabytes.
inline std::string shortened(const std::string& text, std::size_t longest = 200) {
  return text.size() <= longest ? text : text.substr(0, longest) + "...";
}

/// In single quotes, shortened.
inline std::string quoted(const std::string& text) { return "'" + shortened(text) + "'"; }

}  // namespace desert_sim
