#pragma once
/// Numbers and strings in JSON.

#include <cmath>
#include <cstddef>
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

/// The length in bytes of the character of UTF-8 that begins at `at`; 0 if none does.
inline std::size_t utf8_length(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t n) -> unsigned {
    return at + n < text.size() ? static_cast<unsigned char>(text[at + n]) : 0u;
  };
  const unsigned first = byte(0), second = byte(1);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xf0 ? 4 : (first >= 0xe0 ? 3 : 2);
  if (first < 0xc2 || first > 0xf4) return 0;  // the middle of a character, or one that is too long
  for (std::size_t n = 1; n < length; ++n)
    if ((byte(n) & 0xc0) != 0x80) return 0;
  const bool longer_than_needed = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
  const bool surrogate = first == 0xed && second >= 0xa0, beyond = first == 0xf4 && second >= 0x90;
  return longer_than_needed || surrogate || beyond ? 0 : length;
}

/// The text in double quotes, with special characters escaped. Bytes that are no UTF-8, as names of files may
/// have, become U+FFFD.
inline std::string json_string(const std::string& text) {
  std::string out = "\"";
  for (std::size_t n = 0; n < text.size();) {
    const std::size_t length = utf8_length(text, n);
    const auto c = static_cast<unsigned char>(text[n]);
    char code[8];
    std::snprintf(code, sizeof code, "\\u%04x", length == 0 ? 0xfffdu : static_cast<unsigned>(c));
    if (length == 0 || c < 0x20) {
      out += code;
    } else {
      if (c == '"' || c == '\\') out += '\\';
      out += text.substr(n, length);
    }
    n += length == 0 ? 1 : length;
  }
  return out + "\"";
}

}  // namespace desert_sim
