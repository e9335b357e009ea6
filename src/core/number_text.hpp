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

/// A coordinate [m] to the millimetre: those of UTM have seven digits before the point.
inline std::string coordinate_text(double metres) {
  char text[400];
  std::snprintf(text, sizeof text, "%.3f", metres);
  std::string digits = text;
  if (digits.find('.') == std::string::npos) return digits;  // not finite
  digits.erase(digits.find_last_not_of('0') + 1);
  if (digits.back() == '.') digits.pop_back();
  return digits == "-0" ? "0" : digits;
}

/// "(346000.25, 4400000.1)".
inline std::string point_text(double x, double y) {
  return "(" + coordinate_text(x) + ", " + coordinate_text(y) + ")";
}

}  // namespace desert_sim
