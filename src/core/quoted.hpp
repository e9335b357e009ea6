#pragma once
/// Quoting of untrusted text in messages.

#include <string>

namespace desert_sim {

/// The text cut to `longest` bytes, because a request can hold megabytes.
inline std::string shortened(const std::string& text, std::size_t longest = 200) {
  return text.size() <= longest ? text : text.substr(0, longest) + "...";
}

/// The shortened text in single quotes. (std::quoted() would take the place of a function of that name, where
/// a header brings it.)
inline std::string in_quotes(const std::string& text) { return "'" + shortened(text) + "'"; }

}  // namespace desert_sim
