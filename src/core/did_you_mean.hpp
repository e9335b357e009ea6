#pragma once
/// Help with names that are nearly right. It is all in this header, because the library of clients has no
/// other part of the core.

#include <algorithm>
#include <string>
#include <vector>

#include "src/core/lower_case.hpp"
#include "src/core/quoted.hpp"

namespace desert_sim {

/// Optimal string alignment: insertions, deletions, substitutions and exchanges of neighbours.
inline std::size_t typing_errors(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

/// "; did you mean 'width'?" where `given` is a typing error away from one of the names in `known`, which are
/// separated by ", "; else empty. A typing error is up to two letters that are wrong, missing, too many or
/// exchanged (one in short names), or letters in the other case.
inline std::string did_you_mean(const std::string& given, const std::string& known) {
  constexpr std::size_t longest = 64;
  if (given.empty() || given.size() > longest) return "";
  const std::string typed = lower_case(given);
  std::size_t least = given.size() > 4 ? 3 : (given.size() > 2 ? 2 : 1);  // nothing as far off as that
  std::string best;
  for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 2) {
    end = known.find(", ", begin);
    const std::string name = known.substr(begin, end == std::string::npos ? end : end - begin);
    if (name.size() > longest) continue;
    const std::size_t errors = typing_errors(typed, lower_case(name));
    if (errors < least) least = errors, best = name;
  }
  return best.empty() || best == given ? "" : "; did you mean '" + best + "'?";
}

/// "'widht' is not one of: width, height; did you mean 'width'?"
inline std::string not_one_of(const std::string& given, const std::string& known) {
  return in_quotes(given) + " is not one of: " + known + did_you_mean(given, known);
}

}  // namespace desert_sim
