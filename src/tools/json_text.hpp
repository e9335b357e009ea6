#pragma once
/// Numbers and strings in JSON.

#include <cmath>
#include <cstdio>
#include <string>

namespace desert_sim {

/// A double with 17 significant digits, which is read back exactly; null for those that JSON has no number
/// for.
inline std::string json_number(double value) {
  if (!std::isfinite(value)) return "null";
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

/// The text in double quotes, with special characters escaped.
inline std::string json_string(const std::string& text) {
  std::string out = "\"";
  for (char c : text) {
    char code[8];
    std::snprintf(code, sizeof code, "\\u%04x", static_cast<unsigned>(static_cast<unsigned char>(c)));
    if (static_cast<unsigned char>(c) < 0x20) {
      out += code;
      continue;
    }
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

}  // namespace desert_sim
