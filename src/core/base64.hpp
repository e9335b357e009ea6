#pragma once
/// Bytes in text.

#include <string>
#include <vector>

namespace desert_sim {

/// The bytes of a text in base64. Throws ConfigError in the name of `what` for other text.
std::vector<unsigned char> decode_base64(const std::string& text, const std::string& what);

}  // namespace desert_sim
