#include "src/core/base64.hpp"

#include <yaml-cpp/binary.h>

#include <algorithm>

#include "src/core/error.hpp"

namespace desert_sim {

std::vector<unsigned char> decode_base64(const std::string& text, const std::string& what) {
  // For other characters yaml-cpp reads beyond its table.
  const bool is_ascii = std::all_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x80; });
  std::vector<unsigned char> bytes;
  if (is_ascii) bytes = YAML::DecodeBase64(text);
  if (bytes.empty() && !text.empty()) throw ConfigError(what + ": is not base64");
  return bytes;
}

}  // namespace desert_sim
