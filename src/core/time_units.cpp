#include "src/core/time_units.hpp"

#include <cmath>
#include <locale>
#include <sstream>
#include <utility>

#include "src/core/error.hpp"
#include "src/core/number_text.hpp"

namespace desert_sim {

namespace {

constexpr std::pair<const char*, double> units[] = {{"ms", 1e-3}, {"s", 1},     {"min", 60},
                                                    {"h", 3600},  {"d", 86400}, {"a", seconds_per_year}};

/// Whether `text` is a number and one more word, or a number alone, for which `word` is empty.
bool read_number_and_word(const std::string& text, double& number, std::string& word) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  std::string more;
  word.clear();
  if (!(in >> number)) return false;
  in >> word;
  return !(in >> more);
}

}  // namespace

bool read_time_with_unit(const std::string& text, double& seconds) {
  double number = 0;
  std::string word;
  if (!read_number_and_word(text, number, word)) return false;
  for (const auto& [unit, length] : units)
    if (word == unit) {
      seconds = number * length;
      return true;
    }
  return false;
}

double read_time(const std::string& text, const std::string& what, double lowest, double highest) {
  double seconds = 0;
  std::string word;
  const bool plain = read_number_and_word(text, seconds, word) && word.empty();
  const std::string range = "[" + number_text(lowest) + ", " + number_text(highest) + "] s";
  if (!plain && !read_time_with_unit(text, seconds))
    throw ConfigError(what + " " + text + ": is not a time (allowed: " + range +
                      ", or with a unit: " + time_units + ")");
  if (!(seconds >= lowest && seconds <= highest))
    throw ConfigError(what + " " + text + ": is not in " + range);
  return seconds;
}

}  // namespace desert_sim
